#pragma once
#include "shares.h"

#include <gtest/gtest.h>

namespace amontons::test
{
inline void expect_as_on_one(const Surface &target, const std::vector<double> &target_x, const Pairing &expected,
                             const Piece &impactor, const MetPairing &met)
{
  ASSERT_EQ(met.pairs.size(), static_cast<std::size_t>(impactor.n_own));
  std::string first;
  EXPECT_EQ(count_wrong(target, target_x, expected, impactor, met, first), 0) << first;
}
} // namespace amontons::test

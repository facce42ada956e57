#include "amontons/algebra/session.h"

#include <gtest/gtest.h>

#include <memory>

namespace
{
/// MPI and the algebra engine live as long as the tests run.
class SessionEnvironment : public testing::Environment
{
public:
  void SetUp() override { session_ = std::make_unique<amontons::AlgebraSession>(); }
  void TearDown() override { session_.reset(); }

private:
  std::unique_ptr<amontons::AlgebraSession> session_;
};

const auto *const environment = testing::AddGlobalTestEnvironment(new SessionEnvironment); // GoogleTest owns it
} // namespace

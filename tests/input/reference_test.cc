#include "amontons/base/suggestion.h"
#include "amontons/input/deck.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

namespace amontons::test
{
/// With AMONTONS_UPDATE_REFERENCE=1 in the environment the page is written anew instead.
TEST(DeckReference, PageIsThatOfTheTable)
{
  const auto page = std::filesystem::path(__FILE__).parent_path() / "../../docs/reference/deck.md";
  if (const char *update = std::getenv("AMONTONS_UPDATE_REFERENCE"); update && std::string(update) == "1")
    std::ofstream(page, std::ios::binary) << deck_reference();
  std::ostringstream written;
  written << std::ifstream(page, std::ios::binary).rdbuf();
  EXPECT_TRUE(written.str() == deck_reference())
      << "docs/reference/deck.md is not what the table of keys says; write it anew with\n"
      << "  AMONTONS_UPDATE_REFERENCE=1 ctest -R DeckReference";
}

TEST(DeckReference, GivesUnitDefaultAndRange)
{
  EXPECT_THAT(deck_reference(), testing::HasSubstr("| `bodies[].material.poisson` | number | 1 | required unless rigid "
                                                   "| greater than -1 and less than 0.5 | Poisson's ratio |"));
  EXPECT_THAT(deck_reference(), testing::HasSubstr("| `solver.tolerance` | number | 1 | 1e-08 |"));
}

TEST(Suggestion, CountsEdits)
{
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("yuong", "young"), 1);
  EXPECT_EQ(edit_distance("Min_Increment", "min-increment"), 0);
}

TEST(Suggestion, NamesOnlyWhatIsNear)
{
  EXPECT_EQ(nearest_word("tolerence", {"linear", "tolerance"}), "tolerance");
  EXPECT_EQ(nearest_word("colour", {"title", "mesh"}), "");
  EXPECT_EQ(nearest_word("k", {"n"}), "");
  EXPECT_EQ(nearest_word("N", {"n"}), "n");
  EXPECT_EQ(did_you_mean("poison", {"poisson"}), " (did you mean 'poisson'?)");
}
} // namespace amontons::test

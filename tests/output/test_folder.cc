#include "fixture.h"

#include "amontons/base/error.h"
#include "amontons/output/folder.h"

#include <gtest/gtest.h>

namespace amontons
{
namespace
{
namespace fs = std::filesystem;

TEST(ResultFolder, MakesNestedFoldersAndWrites)
{
  const TemporaryFolder temporary;
  const ResultFolder folder(temporary.path() / "a" / "b", Communicator::alone());
  folder.write("record.json", "{}\n");
  EXPECT_EQ(content_of(temporary.path() / "a/b/record.json"), "{}\n");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

TEST(ResultFolder, RemovesEarlierResultsAndNothingElse)
{
  const TemporaryFolder temporary;
  const auto touch = [&](const char *name) { std::ofstream(temporary.path() / name) << "old"; };
  for (const char *name : {"record.json", "solution.pvd", "solution_00001.vtu", "contact_a.csv", "contact_a_00001.vtu",
                           "contact_a.pvd", "solution_00001.pvtu", "solution_00001_3.vtu", "record.json.part"})
    touch(name);
  for (const char *name : {"notes.txt", "contact_angles.txt", "mesh.vtu", "deck.yml"})
    touch(name);
  const ResultFolder folder(temporary.path(), Communicator::alone());
  std::vector<std::string> left;
  for (const auto &entry : fs::directory_iterator(temporary.path()))
    left.push_back(entry.path().filename());
  std::sort(left.begin(), left.end());
  EXPECT_EQ(left, (std::vector<std::string>{"contact_angles.txt", "deck.yml", "mesh.vtu", "notes.txt"}));
}

TEST(ResultFolder, RefusesAFileAndAFolderInsideAFile)
{
  const TemporaryFolder temporary;
  std::ofstream(temporary.path() / "file") << "x";
  EXPECT_THROW(ResultFolder(temporary.path() / "file", Communicator::alone()), UserError);
  EXPECT_THROW(ResultFolder(temporary.path() / "file" / "inside", Communicator::alone()), UserError);
}

TEST(ResultFolder, SaysWhatCannotBeWritten)
{
  const TemporaryFolder temporary;
  const ResultFolder folder(temporary.path() / "gone", Communicator::alone());
  fs::remove(folder.path());
  EXPECT_THROW(folder.write("record.json", "{}"), UserError);
}

TEST(ResultFolder, RemovesPicturesOfLaterIncrements)
{
  const TemporaryFolder temporary;
  const std::vector<std::string> stay{"contact_a.csv",       "contact_a.pvd", "contact_a_00004.vtu",
                                      "contact_a_00009.txt", "record.json",   "solution_00004.vtu"};
  for (const std::string &name : stay)
    std::ofstream(temporary.path() / name) << "old";
  const ResultFolder folder(temporary.path(), Communicator::alone(), true);
  for (const char *name : {"solution_00005.vtu", "solution_00006.pvtu", "solution_00006_0.vtu", "solution_00006_12.vtu",
                           "contact_a_00004_00005.vtu"})
    folder.write(name, "new");
  folder.remove_pictures_after(4);
  std::vector<std::string> left;
  for (const auto &entry : fs::directory_iterator(temporary.path()))
    left.push_back(entry.path().filename());
  std::sort(left.begin(), left.end());
  EXPECT_EQ(left, stay);
}

TEST(ContactFileStem, KeepsOnlyWhatSuitsAFile)
{
  EXPECT_EQ(contact_file_stem("punch-1.top_2"), "contact_punch-1.top_2");
  EXPECT_EQ(contact_file_stem("../a b/\xc3\xa9"), "contact_.._a_b___");
}
} // namespace
} // namespace amontons

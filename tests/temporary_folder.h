#pragma once
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace amontons::test
{
/// A folder of its own, gone with the object.
class TemporaryFolder
{
public:
  TemporaryFolder()
  {
    std::random_device random;
    do
      path_ = std::filesystem::temp_directory_path() / ("amontons-test-" + std::to_string(random()));
    while (!std::filesystem::create_directory(path_));
  }
  TemporaryFolder(const TemporaryFolder &) = delete;
  TemporaryFolder &operator=(const TemporaryFolder &) = delete;
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }

  std::filesystem::path write(const std::string &name, const std::string &text) const
  {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }
  [[nodiscard]] const std::filesystem::path &path() const { return path_; }

private:
  std::filesystem::path path_;
};
} // namespace amontons::test

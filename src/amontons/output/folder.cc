#include "amontons/output/folder.h"

#include "amontons/base/error.h"

#include <algorithm>
#include <fstream>
#include <vector>

namespace amontons
{
namespace fs = std::filesystem;

namespace
{
bool is_result(const fs::path &file)
{
  const std::string name = file.filename().string();
  const std::string extension = file.extension().string();
  const bool of_contact =
      name.starts_with("contact_") && (extension == ".csv" || extension == ".pvd" || extension == ".vtu");
  const bool of_bodies = name == "solution.pvd" || (name.starts_with("solution_") && extension == ".vtu");
  return name == "record.json" || of_contact || of_bodies || name.ends_with(".part");
}

void remove_results(const fs::path &folder)
{
  std::vector<fs::path> stale;
  for (const fs::directory_entry &entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_result(entry.path()))
      stale.push_back(entry.path());
  for (const fs::path &file : stale)
    fs::remove(file);
}
} // namespace

ResultFolder::ResultFolder(fs::path path, bool keep)
  : path_(std::move(path))
{
  if (fs::exists(path_) && !fs::is_directory(path_))
    throw UserError("the output folder '" + path_.string() + "' is a file");
  try
  {
    fs::create_directories(path_);
    if (!keep)
      remove_results(path_);
  }
  catch (const fs::filesystem_error &error)
  {
    throw UserError("cannot use the output folder '" + path_.string() + "': " + error.code().message());
  }
}

void ResultFolder::write(const std::string &name, const std::string &content) const
{
  const fs::path target = path_ / name;
  fs::path part = target;
  part += ".part";
  std::ofstream file(part, std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  std::error_code error;
  if (file)
    fs::rename(part, target, error);
  if (!file || error)
    throw UserError("cannot write '" + target.string() + "'");
}

std::string contact_file_stem(const std::string &contact_name)
{
  std::string stem = "contact_" + contact_name;
  const auto suits = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '.'; };
  std::replace_if(
      stem.begin(), stem.end(), [&](unsigned char c) { return !suits(c); }, '_');
  return stem;
}
} // namespace amontons

#include "amontons/output/folder.h"

#include "amontons/base/error.h"
#include "amontons/parallel/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <regex>

namespace amontons
{
namespace fs = std::filesystem;

namespace
{
bool is_result(const fs::path &file)
{
  const std::string name = file.filename().string();
  const std::string extension = file.extension().string();
  const bool of_contact = name.starts_with("contact_") &&
                          (extension == ".csv" || extension == ".pvd" || extension == ".vtu" || extension == ".pvtu");
  const bool of_bodies =
      name == "solution.pvd" || (name.starts_with("solution_") && (extension == ".vtu" || extension == ".pvtu"));
  return name == "record.json" || of_contact || of_bodies || name.ends_with(".part");
}

/// Increment of a picture by the name of its file, or of one of its pieces; -1 for other files.
int increment_of(const fs::path &file)
{
  static const std::regex picture(R"((?:solution|contact_.*)_(\d{5,9})(?:_\d+)?\.p?vtu)");
  std::smatch match;
  const std::string name = file.filename().string();
  return std::regex_match(name, match, picture) ? std::stoi(match[1]) : -1;
}

/// @throws UserError if the folder does not let it
void use(const fs::path &folder, const std::function<void()> &work)
{
  try
  {
    work();
  }
  catch (const fs::filesystem_error &error)
  {
    throw UserError("cannot use the output folder '" + folder.string() + "': " + error.code().message());
  }
}

void remove_files(const fs::path &folder, const std::function<bool(const fs::path &)> &is_stale)
{
  std::vector<fs::path> stale;
  for (const fs::directory_entry &entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_stale(entry.path()))
      stale.push_back(entry.path());
  for (const fs::path &file : stale)
    fs::remove(file);
}

void make(const fs::path &folder, bool keep)
{
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw UserError("the output folder '" + folder.string() + "' is a file");
  use(folder,
      [&]
      {
        fs::create_directories(folder);
        if (!keep)
          remove_files(folder, is_result);
      });
}
} // namespace

ResultFolder::ResultFolder(fs::path path, const Communicator &communicator, bool keep)
  : path_(std::move(path))
  , communicator_(communicator)
{
  agree_on_errors(communicator_,
                  [&]
                  {
                    if (communicator_.is_root())
                      make(path_, keep);
                  });
}

void ResultFolder::remove_pictures_after(int increment) const
{
  use(path_,
      [&] { remove_files(path_, [increment](const fs::path &file) { return increment_of(file) > increment; }); });
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

std::string picture_name(const std::string &stem, int increment)
{
  return fmt::format("{}_{:05d}", stem, increment);
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

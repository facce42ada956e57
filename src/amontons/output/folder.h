#pragma once
#include <filesystem>
#include <string>

namespace amontons
{
/// The folder a run writes into. Local: one process writes.
class ResultFolder
{
public:
  /// Makes the folder, or removes from it the files that an earlier run wrote; anything else stays.
  /// @param keep leaves them there, for a run that goes on
  /// @throws UserError if it cannot be made or written into
  explicit ResultFolder(std::filesystem::path path, bool keep = false);

  [[nodiscard]] const std::filesystem::path &path() const { return path_; }

  /// Writes a file whole or not at all: under another name first, then renamed.
  /// @throws UserError if it cannot be written
  void write(const std::string &name, const std::string &content) const;

private:
  std::filesystem::path path_;
};

/// The file that a run can go on from.
inline constexpr const char *checkpoint_file = "checkpoint.cbor";

/// "contact_<name>", with '_' for characters that do not suit a file's name.
std::string contact_file_stem(const std::string &contact_name);
} // namespace amontons

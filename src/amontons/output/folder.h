#pragma once
#include "amontons/parallel/communicator.h"

#include <filesystem>
#include <string>

namespace amontons
{
/// The folder a run writes into, seen by all its processes.
class ResultFolder
{
public:
  /// Process 0 makes the folder, or removes from it the files that an earlier run wrote; anything else stays.
  /// Collective.
  /// @param keep leaves them there, for a run that goes on
  /// @throws UserError, on all processes, if it cannot be made or written into
  explicit ResultFolder(std::filesystem::path path, const Communicator &communicator, bool keep = false);

  [[nodiscard]] const std::filesystem::path &path() const { return path_; }
  /// The processes that write into it; process 0 what is written once.
  [[nodiscard]] const Communicator &communicator() const { return communicator_; }

  /// Removes the pictures of increments after the given one. Local.
  void remove_pictures_after(int increment) const;

  /// Writes a file whole or not at all: under another name first, then renamed. Local.
  /// @throws UserError if it cannot be written
  void write(const std::string &name, const std::string &content) const;

private:
  std::filesystem::path path_;
  Communicator communicator_;
};

/// The file that a run can go on from.
inline constexpr const char *checkpoint_file = "checkpoint.cbor";

/// "<stem>_<increment>", of a picture.
std::string picture_name(const std::string &stem, int increment);

/// "contact_<name>", with '_' for characters that do not suit a file's name.
std::string contact_file_stem(const std::string &contact_name);
} // namespace amontons

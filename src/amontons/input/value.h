#pragma once
#include "amontons/base/error.h"

#include <filesystem>
#include <string>
#include <vector>

namespace amontons
{
/// A node of the deck as written, before anyone asks what it means: YAML with each thing's place.
struct Value
{
  enum class Kind
  {
    null,
    scalar,
    list,
    map
  };

  Kind kind = Kind::null;
  std::string text;         ///< of a scalar
  bool quoted = false;      ///< the scalar stood in quotes: text, even if it looks like a number
  std::vector<Value> items; ///< of a list or map, in the order of the file
  std::string key;          ///< of an item of a map
  SourceLocation key_where;
  SourceLocation where;
  std::string path; ///< "bodies.0.material.young"; empty for the whole deck

  /// The item of that key, or nullptr.
  [[nodiscard]] const Value *find(const std::string &name) const;
  /// What stands there, for a message: "'abc'", "a list", "nothing".
  [[nodiscard]] std::string described() const;
  /// @throws UserError "place: path: message"
  [[noreturn]] void fail(const std::string &message) const;
};

/// Reads a YAML file of one document whose top is a map, and sets the overrides "key.path=value" in it, in their order.
/// Items of a list are named by position; what lies on the way to a key and is absent is made.
/// @throws UserError: unreadable file, YAML that does not parse, a key twice in one map, an override without '=', into
///         a scalar, or past the end of a list. Places of overridden values are "--set key.path=value".
Value read_values(const std::filesystem::path &file, const std::vector<std::string> &overrides);
} // namespace amontons

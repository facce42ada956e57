#pragma once
#include <stdexcept>
#include <string>
#include <utility>

namespace amontons
{
/// Where in a file of the user's something stands. `line` and `column` count from 1; 0 means unknown.
struct SourceLocation
{
  std::string file;
  int line = 0;
  int column = 0;

  /// "file:line:column", shortened to what is known.
  [[nodiscard]] std::string text() const;
};

/// The deck, the mesh or the command line is wrong: exit code 2.
class UserError : public std::runtime_error
{
public:
  explicit UserError(const std::string &message)
    : std::runtime_error(message)
  {
  }
  /// @param where prefixed to the message as "file:line:column: ".
  UserError(const SourceLocation &where, const std::string &message);
};

/// The equations could not be solved: exit code 3. What converged before stays on disk.
class NumericalFailure : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// A broken promise of the program itself: exit code 4.
class InternalError : public std::logic_error
{
public:
  using std::logic_error::logic_error;
};

[[noreturn]] void fail_assertion(const char *condition, const char *file, int line);
} // namespace amontons

/// Stays on in every build: use it where the test costs next to nothing.
#define AMONTONS_ASSERT(condition)                                                                                     \
  do                                                                                                                   \
  {                                                                                                                    \
    if (!(condition))                                                                                                  \
      ::amontons::fail_assertion(#condition, __FILE__, __LINE__);                                                      \
  } while (false)

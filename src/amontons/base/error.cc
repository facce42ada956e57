#include "amontons/base/error.h"

namespace amontons
{
std::string SourceLocation::text() const
{
  std::string out = file;
  if (line > 0)
    out.append(":").append(std::to_string(line));
  if (line > 0 && column > 0)
    out.append(":").append(std::to_string(column));
  return out;
}

UserError::UserError(const SourceLocation &where, const std::string &message)
  : std::runtime_error(where.file.empty() ? message : where.text() + ": " + message)
{
}

void fail_assertion(const char *condition, const char *file, int line)
{
  throw InternalError(std::string(file) + ":" + std::to_string(line) + ": assertion failed: " + condition);
}
} // namespace amontons

#include "amontons/output/version.h"

namespace amontons
{
std::string_view version()
{
  return AMONTONS_VERSION;
}
} // namespace amontons

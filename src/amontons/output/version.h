#pragma once
#include <string_view>

namespace amontons
{
/// Version of the library, "major.minor.patch".
std::string_view version();
} // namespace amontons

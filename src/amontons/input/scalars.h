#pragma once
#include "amontons/input/value.h"

#include <limits>
#include <string>
#include <vector>

namespace amontons
{
/// Interval of admissible numbers.
struct Range
{
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_included = false;
  bool high_included = false;

  [[nodiscard]] bool contains(double value) const;
  /// "> 0", "from 0", "between -1 and 0.5 (both excluded)"; empty without bounds
  [[nodiscard]] std::string text() const;
};

inline constexpr Range any_number{};
inline constexpr Range positive{0};
inline constexpr Range not_negative{0, std::numeric_limits<double>::infinity(), true};

/// A number as short as it reads back.
std::string number_text(double value);

/// All of these @throw UserError with place and path where the value is of another type or out of range.
double to_number(const Value &value, const Range &range, const std::string &wanted = "a number");
int to_integer(const Value &value, const Range &range);
bool to_boolean(const Value &value);
/// Text that is not empty.
std::string to_text(const Value &value);
/// Position of the word among the choices.
std::size_t to_choice(const Value &value, const std::vector<std::string> &choices);
/// @throws UserError unless the value is a list with items
void require_list(const Value &value, const std::string &of_what);
/// @throws UserError unless the value is a map with keys
void require_map(const Value &value, const std::string &of_what);
} // namespace amontons

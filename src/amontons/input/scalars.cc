#include "amontons/input/scalars.h"

#include "amontons/base/suggestion.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace amontons
{
namespace
{
/// @return whether the whole text is one number
template<typename Number>
bool parse(std::string text, Number &number)
{
  if (text.starts_with('+'))
    text.erase(0, 1);
  const char *end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end;
}

[[noreturn]] void fail_type(const Value &value, const std::string &wanted)
{
  value.fail("must be " + wanted + ", not " + value.described());
}

void check_range(const Value &value, double number, const Range &range)
{
  if (!range.contains(number))
    value.fail("must be " + range.text() + ", not " + value.text);
}
} // namespace

bool Range::contains(double value) const
{
  return (value > low || (low_included && value == low)) && (value < high || (high_included && value == high));
}

std::string Range::text() const
{
  const std::string below = number_text(low), above = number_text(high);
  if (std::isfinite(low) && std::isfinite(high))
    return std::string(low_included ? "at least " : "greater than ") + below +
           (high_included ? " and at most " : " and less than ") + above;
  if (std::isfinite(low))
    return (low_included ? "at least " : "greater than ") + below;
  if (std::isfinite(high))
    return (high_included ? "at most " : "less than ") + above;
  return "";
}

std::string number_text(double value)
{
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, result.ptr};
}

double to_number(const Value &value, const Range &range, const std::string &wanted)
{
  double number = 0;
  if (value.kind != Value::Kind::scalar || value.quoted || !parse(value.text, number) || !std::isfinite(number))
    fail_type(value, wanted);
  check_range(value, number, range);
  return number;
}

int to_integer(const Value &value, const Range &range)
{
  int number = 0;
  if (value.kind != Value::Kind::scalar || value.quoted || !parse(value.text, number))
    fail_type(value, "a whole number");
  check_range(value, number, range);
  return number;
}

bool to_boolean(const Value &value)
{
  if (value.kind != Value::Kind::scalar || value.quoted || (value.text != "true" && value.text != "false"))
    fail_type(value, "true or false");
  return value.text == "true";
}

std::string to_text(const Value &value)
{
  if (value.kind != Value::Kind::scalar || value.text.empty())
    fail_type(value, "text");
  return value.text;
}

std::size_t to_choice(const Value &value, const std::vector<std::string> &choices)
{
  if (value.kind != Value::Kind::scalar)
    fail_type(value, "one of " + joined(choices));
  const auto found = std::find(choices.begin(), choices.end(), value.text);
  if (found == choices.end())
    value.fail("must be one of " + joined(choices) + ", not " + value.described() + did_you_mean(value.text, choices));
  return static_cast<std::size_t>(found - choices.begin());
}

void require_list(const Value &value, const std::string &of_what)
{
  if (value.kind != Value::Kind::list)
    fail_type(value, "a list of " + of_what);
  if (value.items.empty())
    value.fail("must be a list of " + of_what + ", not an empty one");
}

void require_map(const Value &value, const std::string &of_what)
{
  if (value.kind != Value::Kind::map)
    fail_type(value, "a map of " + of_what);
  if (value.items.empty())
    value.fail("must be a map of " + of_what + ", not an empty one");
}
} // namespace amontons

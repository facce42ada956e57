#include "amontons/bulk/expression.h"

#include <gmock/gmock.h>

#include <numbers>

namespace amontons
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;

Function parse(const std::string &text)
{
  return Function({text, {"deck.yaml", 12, 20}});
}

double value(const std::string &text, double t = 0, const std::array<double, 3> &x = {0, 0, 0})
{
  return parse(text)(t, x);
}

std::string message(const std::string &text)
{
  try
  {
    parse(text);
  }
  catch (const UserError &error)
  {
    return error.what();
  }
  return "no error";
}

TEST(Expressions, Values)
{
  EXPECT_DOUBLE_EQ(value("-1e-3"), -1e-3);
  EXPECT_DOUBLE_EQ(value("-0.01*t", 3), -0.03);
  EXPECT_DOUBLE_EQ(value("x + 10*y + 100*z", 0, {1, 2, 3}), 321);
  EXPECT_DOUBLE_EQ(value("sin(pi*t)^2", 0.25), 0.5);
  EXPECT_DOUBLE_EQ(value("t < 1 ? 2 : 3", 0.5), 2);
  EXPECT_DOUBLE_EQ(value("t <= 1 && x == 0 ? 2 : 3", 2), 3);
  EXPECT_DOUBLE_EQ(value("max(min(t, 1), 0) + exp(0) + sqrt(4) + abs(-1)", 7), 5);
  EXPECT_DOUBLE_EQ(value("atan2(1, 1)"), std::numbers::pi / 4);
}

TEST(Expressions, KnowWhetherTheyDependOnTime)
{
  EXPECT_TRUE(parse("2*t").depends_on_time());
  EXPECT_FALSE(parse("2*sqrt(x)").depends_on_time());
}

TEST(Expressions, EachIsIndependentOfTheOthers)
{
  const Function a = parse("t"), b = parse("2*t");
  EXPECT_EQ(a(1, {}), 1);
  EXPECT_EQ(b(5, {}), 10);
  EXPECT_EQ(a(2, {}), 2);
}

TEST(Expressions, ErrorsTellPlaceAndWhatIsNotUnderstood)
{
  EXPECT_THAT(message("2*tim + 1"),
              AllOf(HasSubstr("deck.yaml:12:20: "), HasSubstr("'tim' at position 3"), HasSubstr("t, x, y, z")));
  EXPECT_THAT(message("sine(x)"), HasSubstr("'sine' at position 1"));
  EXPECT_THAT(message("2*(t+1"), HasSubstr("parenthesis"));
  EXPECT_THAT(message("2*"), HasSubstr("ends"));
  EXPECT_THAT(message(""), HasSubstr("empty"));
  EXPECT_THAT(message("0,5"), HasSubstr("decimal"));
  EXPECT_THAT(message("t = 2"), AllOf(HasSubstr("position 3"), HasSubstr("==")));
  EXPECT_THAT(message("2 3"), HasSubstr("position"));
}

TEST(Expressions, ValuesThatAreNotFiniteAreRefusedWhereTheyOccur)
{
  const Function f = parse("1/x");
  EXPECT_EQ(f(0, {2, 0, 0}), 0.5);
  EXPECT_THROW(
      {
        try
        {
          (void)f(3, {0, 0, 0});
        }
        catch (const UserError &error)
        {
          EXPECT_THAT(error.what(), AllOf(HasSubstr("deck.yaml:12:20"), HasSubstr("not finite at t = 3")));
          throw;
        }
      },
      UserError);
}
} // namespace
} // namespace amontons

#include "amontons/bulk/expression.h"

#include <muParser.h>

#include <cmath>
#include <numbers>

namespace amontons
{
struct Function::Impl
{
  Expression expression;
  mu::Parser parser;
  double time = 0;
  std::array<double, 3> point{};
  bool uses_time = false;
};

namespace
{
[[noreturn]] void refuse(const Expression &expression, const std::string &reason)
{
  throw UserError(expression.where, "expression \"" + expression.text + "\": " + reason);
}

/// muParser counts positions from 0, or gives -1; people count from 1.
std::string explain(const mu::Parser::exception_type &error)
{
  const std::string token = error.GetToken().empty() ? "" : "'" + error.GetToken() + "' ";
  const std::string place =
      error.GetPos() >= 0 ? "at position " + std::to_string(static_cast<long>(error.GetPos()) + 1) + " " : "";
  switch (error.GetCode())
  {
  case mu::ecUNASSIGNABLE_TOKEN:
    return token + place +
           "is not understood: known are t, x, y, z, pi, the operators + - * / ^ < > == && || ?: and functions such as "
           "sin, exp, sqrt, abs, min, max";
  case mu::ecUNEXPECTED_EOF:
    return "it ends where a value is still expected";
  case mu::ecMISSING_PARENS:
    return "a parenthesis is missing";
  default:
    return token + place + "is wrong here: " + error.GetMsg();
  }
}

/// An assignment would change t, x, y, z under the hands of the next term.
void refuse_assignment(const Expression &expression)
{
  const std::string &text = expression.text;
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    if (text[i] != '=')
      continue;
    const bool comparison = i > 0 && std::string("<>!=").find(text[i - 1]) != std::string::npos;
    if (!comparison && (i + 1 == text.size() || text[i + 1] != '='))
      refuse(expression, "'=' at position " + std::to_string(i + 1) + " assigns; to compare, write '=='");
  }
}
} // namespace

Function::Function(const Expression &expression)
  : impl_(std::make_unique<Impl>())
{
  impl_->expression = expression;
  if (expression.text.find_first_not_of(" \t\n") == std::string::npos)
    refuse(expression, "it is empty; write a number or an expression of t, x, y, z");
  refuse_assignment(expression);
  try
  {
    mu::Parser &parser = impl_->parser;
    parser.DefineVar("t", &impl_->time);
    parser.DefineVar("x", &impl_->point[0]);
    parser.DefineVar("y", &impl_->point[1]);
    parser.DefineVar("z", &impl_->point[2]);
    parser.DefineConst("pi", std::numbers::pi);
    parser.SetExpr(expression.text);
    parser.Eval();
    if (parser.GetNumResults() != 1)
      refuse(expression, "it has " + std::to_string(parser.GetNumResults()) +
                             " values separated by commas; one is wanted (the decimal sign is a point)");
    impl_->uses_time = parser.GetUsedVar().contains("t");
  }
  catch (const mu::Parser::exception_type &error)
  {
    refuse(expression, explain(error));
  }
}

Function::~Function() = default;
Function::Function(Function &&) noexcept = default;
Function &Function::operator=(Function &&) noexcept = default;

bool Function::depends_on_time() const
{
  return impl_->uses_time;
}

double Function::operator()(double time, const std::array<double, 3> &point) const
{
  impl_->time = time;
  impl_->point = point;
  try
  {
    const double value = impl_->parser.Eval();
    if (std::isfinite(value))
      return value;
  }
  catch (const mu::Parser::exception_type &error)
  {
    refuse(impl_->expression, explain(error));
  }
  refuse(impl_->expression, "it is not finite at t = " + std::to_string(time) + ", (x, y, z) = (" +
                                std::to_string(point[0]) + ", " + std::to_string(point[1]) + ", " +
                                std::to_string(point[2]) + ")");
}
} // namespace amontons

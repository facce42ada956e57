#pragma once

namespace amontons
{
/// Who passes what to whom when contact is detected over many processes.
enum class ExchangeMode
{
  distributed, ///< straight from the giver of a surface to the process that detects there, and back
  gathered     ///< through process 0 (Yastrebov, Cailletaud, Feyel 2011; THEORY.md section 5)
};

struct ExchangeOptions
{
  ExchangeMode mode = ExchangeMode::distributed;
  /// Distributed: how much farther than w surfaces are sent, in units of w. For as long as they have moved less than
  /// that against each other, who sends what to whom stays as it is. >= 0
  double skin = 0.3;
};
} // namespace amontons

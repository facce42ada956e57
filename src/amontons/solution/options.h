#pragma once
#include "amontons/bulk/options.h"
#include "amontons/contact/options.h"
#include "amontons/detection/options.h"
#include "amontons/exchange/options.h"

#include <optional>
#include <string>
#include <vector>

namespace amontons
{
struct LoadingOptions
{
  double end = 1;                      ///< t runs from 0 to here
  int increments = 1;                  ///< of equal length, cut and grown where needed
  bool fixed = false;                  ///< true: never cut, never grow
  std::optional<double> min_increment; ///< in t; default: 1e-4 of the first
  std::optional<double> max_increment; ///< in t; default: the first
};

enum class LinearSolverType
{
  automatic,
  direct,
  amg,
  feti
};

enum class MultiplierForm
{
  automatic, ///< condensed, but where rows of neighbours hang together: mortar in finite strain
  condensed,
  coupled
};

struct SolverOptions
{
  LinearSolverType linear = LinearSolverType::automatic;
  MultiplierForm multipliers = MultiplierForm::automatic;
  double tolerance = 1e-8; ///< residual force over the forces present
  int max_iterations = 25; ///< of Newton, per increment
};

/// A problem whole, as the deck states it.
struct ProblemOptions
{
  MeshOptions mesh;
  std::vector<BodyOptions> bodies;
  std::vector<ContactOptions> contact;
  std::vector<BoundaryOptions> boundary;
  LoadingOptions loading;
  Strain strain = Strain::small;
  DetectionOptions detection;
  ExchangeOptions exchange; ///< over several processes
  SolverOptions solver;
};
} // namespace amontons

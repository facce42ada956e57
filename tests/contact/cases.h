#pragma once
#include "amontons/contact/linearisation.h"
#include "jet.h"

#include <functional>
#include <random>
#include <string>
#include <vector>

namespace amontons::test
{
/// Gap, slip and virtual slip found independently of the library, at complex positions.
struct Measured
{
  Complex gap;
  Jet::Gradient gap_gradient;
  std::array<Complex, 2> slip{};
  std::array<Jet::Gradient, 2> slip_gradient{Jet::Gradient::Zero(), Jet::Gradient::Zero()};
  std::array<Jet::Gradient, 2> slip_direction{Jet::Gradient::Zero(), Jet::Gradient::Zero()};
};

/// One random contact element: the library's linearisation and the independent measure of the same.
struct Case
{
  int dim = 2;
  Eigen::VectorXd x; ///< the dofs' values (positions; displacements in small strain)
  std::function<ContactLinearisation(const Eigen::VectorXd &)> linearise;
  std::function<Measured(const Eigen::VectorXcd &)> measure;

  [[nodiscard]] int n_dofs() const { return static_cast<int>(x.size()); }
};

/// Every kind of element there is.
const std::vector<std::string> &case_kinds();
/// Those that can be made without slip: all but the quadrilateral met far outside.
std::vector<std::string> slipless_case_kinds();

/// @param with_slip whether something slipped since the increment's beginning
Case make_case(const std::string &kind, unsigned seed, bool with_slip);

using Random = std::mt19937;
double uniform(Random &random, double low, double high);
Eigen::VectorXd random_vector(Random &random, int size, double low = -1, double high = 1);
/// A rotation about a random axis.
Eigen::Matrix3d random_rotation(Random &random, int dim);
} // namespace amontons::test

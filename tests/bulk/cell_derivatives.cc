// The force of a cell is the derivative of its energy, and its tangent the derivative of its force. The energy is
// written a second time here, with shape functions and quadrature of its own; derivatives are complex steps.
#include "amontons/bulk/cell_finite.h"
#include "amontons/bulk/cell_small.h"
#include "random_cell.h"

#include <gmock/gmock.h>

namespace amontons
{
namespace
{
struct Rule
{
  std::vector<Eigen::Vector3d> points;
  std::vector<double> weights;
};

Rule gauss_rule(int dim)
{
  Rule rule;
  for (int q = 0; q < 1 << dim; ++q)
  {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (int d = 0; d < dim; ++d)
      x[d] = 0.5 + ((q >> d) % 2 ? 0.5 : -0.5) / std::sqrt(3.0);
    rule.points.push_back(x);
    rule.weights.push_back(1.0 / (1 << dim));
  }
  return rule;
}

/// Gauss's rule along one side times Gauss-Jacobi's across, on the unit triangle (Stroud 1971, conical product).
Rule conical_rule()
{
  Rule rule;
  for (const double sign : {-1.0, 1.0})
    for (const double side : {-1.0, 1.0})
    {
      const double s = (4 + sign * std::sqrt(6.0)) / 10;
      const double weight = 0.25 - sign * std::sqrt(6.0) / 36; // of int_0^1 f(s) (1 - s) ds
      rule.points.emplace_back((1 - s) * (0.5 + side * 0.5 / std::sqrt(3.0)), s, 0);
      rule.weights.push_back(weight / 2);
    }
  return rule;
}

template<class Cell>
Rule rule_of()
{
  if constexpr (!Cell::simplex)
    return gauss_rule(Cell::dim);
  else if constexpr (Cell::axisymmetric)
    return conical_rule();
  else
    return {{Eigen::Vector3d::Constant(1.0 / (Cell::dim + 1))}, {Cell::dim == 2 ? 0.5 : 1.0 / 6}};
}

template<class Cell, typename Scalar>
Scalar shape_function(int a, const Eigen::Matrix<Scalar, 3, 1> &x)
{
  if constexpr (Cell::simplex)
    return a == 0 ? Scalar(1) - x.head(Cell::dim).sum() : x[a - 1];
  Scalar value = 1;
  for (int d = 0; d < Cell::dim; ++d)
    value *= corners[a][d] == 1 ? x[d] : Scalar(1) - x[d];
  return value;
}

/// Derivatives of the shape functions by complex steps: a column per node.
template<class Cell>
typename Cell::template NodalValues<double> shape_gradients(const Eigen::Vector3d &x)
{
  typename Cell::template NodalValues<double> out;
  for (int d = 0; d < Cell::dim; ++d)
  {
    Eigen::Matrix<Complex, 3, 1> step = x.cast<Complex>();
    step[d] += Complex(0, 1e-40);
    for (int a = 0; a < Cell::nodes; ++a)
      out(d, a) = shape_function<Cell, Complex>(a, step).imag() / 1e-40;
  }
  return out;
}

/// F as a full tensor at the points of a cell, and the weights of the points.
template<class Cell>
struct Points
{
  std::vector<Eigen::Matrix<Complex, 3, 3>> F;
  std::vector<double> weights;

  Points(const typename Cell::template NodalValues<double> &X, const typename Cell::template NodalValues<Complex> &u)
  {
    const Rule rule = rule_of<Cell>();
    for (std::size_t q = 0; q < rule.points.size(); ++q)
    {
      const auto dN = shape_gradients<Cell>(rule.points[q]);
      const Eigen::MatrixXd J = X * dN.transpose();
      Eigen::Matrix<Complex, 3, 3> deformation = Eigen::Matrix<Complex, 3, 3>::Identity();
      deformation.topLeftCorner(Cell::dim, Cell::dim) += u * dN.transpose() * J.inverse();
      double weight = rule.weights[q] * J.determinant();
      if (Cell::axisymmetric)
      {
        double R = 0;
        Complex displacement = 0;
        for (int a = 0; a < Cell::nodes; ++a)
        {
          const double N = shape_function<Cell, double>(a, rule.points[q]);
          R += N * X(0, a);
          displacement += N * u(0, a);
        }
        deformation(2, 2) += displacement / R;
        weight *= 2 * std::numbers::pi * R;
      }
      F.push_back(deformation);
      weights.push_back(weight);
    }
  }
};

Complex volumetric(double bulk, Complex J)
{
  return bulk / 2 * ((J * J - 1.0) / 2.0 - std::log(J));
}

Complex isochoric(double shear, const Eigen::Matrix<Complex, 3, 3> &F)
{
  const Eigen::Matrix<Complex, 3, 3> C = F.transpose() * F;
  return shear / 2 * (std::pow(F.determinant(), -2.0 / 3) * C.trace() - 3.0);
}

/// W at the F33 where it is least, found by bisection on a difference quotient of W.
Complex plane_stress_energy(const ElasticModuli &moduli, Eigen::Matrix<Complex, 3, 3> F)
{
  const auto energy = [&](Complex stretch)
  {
    F(2, 2) = stretch;
    return isochoric(moduli.shear, F) + volumetric(moduli.bulk, F.determinant());
  };
  const auto slope = [&](Complex s)
  {
    const double h = 1e-2;
    return (45.0 * (energy(s + h) - energy(s - h)) - 9.0 * (energy(s + 2 * h) - energy(s - 2 * h)) +
            (energy(s + 3 * h) - energy(s - 3 * h))) /
           (60 * h);
  };
  double low = 0.2, high = 5;
  for (int i = 0; i < 60; ++i)
  {
    const double middle = (low + high) / 2;
    (slope(middle).real() < 0 ? low : high) = middle;
  }
  // W is stationary there, so an error e of the stretch changes W by e^2 and dW/du by e only times zero.
  return energy((low + high) / 2);
}

template<class Cell>
Complex energy(const Points<Cell> &points, const ElasticModuli &moduli, bool mean_dilatation)
{
  Complex sum = 0, current_volume = 0;
  double volume = 0;
  for (std::size_t q = 0; q < points.F.size(); ++q)
  {
    const auto &F = points.F[q];
    const double w = points.weights[q];
    volume += w;
    current_volume += w * F.determinant();
    if (Cell::plane_stress)
      sum += w * plane_stress_energy(moduli, F);
    else
      sum += w * (isochoric(moduli.shear, F) + (mean_dilatation ? 0 : volumetric(moduli.bulk, F.determinant())));
  }
  return mean_dilatation ? sum + volume * volumetric(moduli.bulk, current_volume / volume) : sum;
}

template<class Cell>
class CellDerivatives : public testing::Test, protected RandomCell<Cell>
{
protected:
  const ElasticModuli moduli_{1.3, 4.1};
  const CellTables<Cell> tables_;
};

TYPED_TEST_SUITE(CellDerivatives, AllCells);

TYPED_TEST(CellDerivatives, ForceIsTheDerivativeOfTheEnergy)
{
  using Cell = TypeParam;
  for (const bool mean : this->mean_dilatation())
    for (unsigned seed = 1; seed <= 5; ++seed)
    {
      const auto X = this->reference(seed);
      const auto u = this->values(seed + 100, 0.1);
      const auto points = this->tables_.at(X);
      const FiniteStrainCell<Cell, double> cell(points, this->moduli_, mean, u);
      ASSERT_TRUE(cell.valid());
      const auto force = cell.force();
      // In plane stress the stretch comes from a difference quotient, good to 1e-10.
      const double tolerance = (Cell::plane_stress ? 1e-8 : 1e-12) * force.norm();
      for (int i = 0; i < Cell::unknowns; ++i)
        EXPECT_NEAR(force[i], energy(Points<Cell>(X, this->step(u, i)), this->moduli_, mean).imag() / 1e-40, tolerance);
    }
}

TYPED_TEST(CellDerivatives, TangentIsTheDerivativeOfTheForce)
{
  using Cell = TypeParam;
  for (const bool mean : this->mean_dilatation())
    for (unsigned seed = 1; seed <= 5; ++seed)
    {
      const auto u = this->values(seed + 100, 0.1);
      const auto points = this->tables_.at(this->reference(seed));
      const FiniteStrainCell<Cell, double> cell(points, this->moduli_, mean, u);
      ASSERT_TRUE(cell.valid());
      const auto tangent = cell.tangent();
      EXPECT_LT((tangent - tangent.transpose()).norm(), 1e-14 * tangent.norm());
      for (int i = 0; i < Cell::unknowns; ++i)
      {
        const FiniteStrainCell<Cell, Complex> stepped(points, this->moduli_, mean, this->step(u, i));
        EXPECT_LT((tangent.col(i) - stepped.force().imag() / 1e-40).norm(), 1e-13 * tangent.norm()) << "column " << i;
      }
    }
}

TYPED_TEST(CellDerivatives, SmallStrainIsTheLimitOfFiniteStrain)
{
  using Cell = TypeParam;
  for (const bool mean : this->mean_dilatation())
  {
    const auto points = this->tables_.at(this->reference(3));
    const typename Cell::template NodalValues<double> zero = Cell::template NodalValues<double>::Zero();
    const auto linear = small_strain_stiffness<Cell>(points, this->moduli_, mean);
    const FiniteStrainCell<Cell, double> cell(points, this->moduli_, mean, zero);
    EXPECT_LT((linear - cell.tangent()).norm(), 1e-14 * linear.norm());

    const auto u = this->values(9, 1.0);
    const FiniteStrainCell<Cell, Complex> stepped(points, this->moduli_, mean,
                                                  u.template cast<Complex>() * Complex(0, 1e-40));
    const auto stress = small_strain_stress<Cell>(points, this->moduli_, u);
    EXPECT_LT((stress - stepped.stress().imag() / 1e-40).norm(), 1e-13 * stress.norm());
  }
}

/// The virtual work of the mean Cauchy stress in a uniform velocity gradient is that of the cell's force.
TYPED_TEST(CellDerivatives, StressDoesTheWorkOfTheForce)
{
  using Cell = TypeParam;
  for (const bool mean : this->mean_dilatation())
  {
    const auto X = this->reference(4);
    const auto u = this->values(104, 0.1);
    const auto points = this->tables_.at(X);
    const FiniteStrainCell<Cell, double> cell(points, this->moduli_, mean, u);
    const auto s = cell.stress();
    const auto force = cell.force();
    double current_volume = 0;
    Points<Cell> own(X, u.template cast<Complex>());
    for (std::size_t q = 0; q < own.F.size(); ++q)
      current_volume += own.weights[q] * own.F[q].determinant().real();
    if (Cell::plane_stress) // the thickness changes from point to point: only the direction can be compared
      continue;
    const typename Cell::template NodalValues<double> x = X + u;
    const auto work = [&](int i, int j)
    {
      double sum = 0;
      for (int a = 0; a < Cell::nodes; ++a)
        sum += force[a * Cell::dim + i] * x(j, a);
      return sum;
    };
    if (!Cell::axisymmetric) // a radial velocity y stretches the hoop by y/r
      EXPECT_NEAR(work(0, 1), s[3] * current_volume, 1e-12);
    EXPECT_NEAR(work(1, 0), s[3] * current_volume, 1e-12);
    EXPECT_NEAR(work(1, 1), s[1] * current_volume, 1e-12);
    const double hoop = Cell::axisymmetric ? s[2] : 0; // radial velocity r stretches the hoop too
    EXPECT_NEAR(work(0, 0), (s[0] + hoop) * current_volume, 1e-12);
  }
}
} // namespace
} // namespace amontons

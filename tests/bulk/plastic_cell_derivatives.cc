// The law of von Mises: its tangents against complex steps, its stress against the rate equations.
#include "amontons/bulk/cell_plastic.h"
#include "amontons/bulk/cell_small.h"
#include "random_cell.h"

#include <gmock/gmock.h>

#include <vector>

namespace amontons
{
namespace
{
using Tensor = SymmetricTensor<double>;

constexpr double yield = 0.02;

/// None, linear of both kinds, and Voce's with all others.
std::vector<Hardening> all_hardenings()
{
  return {{yield, 0, 0, 0, 0}, {yield, 0.3, 0, 0, 0}, {yield, 0, 0, 0, 0.4}, {yield, 0.2, 0.03, 40, 0.1}};
}

Tensor random_tensor(std::mt19937 &random, double size)
{
  std::uniform_real_distribution<double> value(-size, size);
  return Tensor::NullaryExpr([&] { return value(random); });
}

Tensor deviator(Tensor t)
{
  t.head<3>().array() -= t.head<3>().sum() / 3;
  return t;
}

PlasticHistory<double> random_history(std::mt19937 &random)
{
  return {deviator(random_tensor(random, 0.01)), std::uniform_real_distribution<double>(0.0, 0.05)(random)};
}

/// A : de, A in the form of PointTangent with the yield surface's normal in the place of F.
Tensor apply(const VonMises<double> &law, const Tensor &de)
{
  Tensor out = (law.tangent.id + law.tangent.swap) * de + law.tangent.ff * contract(law.normal, de) * law.normal;
  out.head<3>().array() += law.tangent.hh * de.head<3>().sum();
  return out;
}

TEST(VonMisesLaw, TangentIsTheDerivativeOfTheStress)
{
  std::mt19937 random(5);
  int n_plastic = 0;
  for (const Hardening &hardening : all_hardenings())
    for (int sample = 0; sample < 50; ++sample)
    {
      const PlasticHistory<double> start = random_history(random);
      const Tensor strain = random_tensor(random, 0.05);
      const VonMises<double> law(0.4, hardening, start, strain);
      n_plastic += law.history.equivalent > start.equivalent;
      for (int component = 0; component < 6; ++component)
      {
        SymmetricTensor<Complex> step = strain.cast<Complex>();
        step[component] += Complex(0, 1e-40);
        const Tensor slope = VonMises<Complex>(0.4, hardening, start, step).stress.imag() / 1e-40;
        EXPECT_LT((slope - apply(law, Tensor::Unit(component))).norm(), 1e-13);
      }
    }
  EXPECT_GT(n_plastic, 100);
  EXPECT_LT(n_plastic, 200); // some stay elastic
}

TEST(VonMisesLaw, FlowEndsOnTheYieldSurfaceAlongItsNormal)
{
  std::mt19937 random(6);
  for (const Hardening &hardening : all_hardenings())
    for (int sample = 0; sample < 50; ++sample)
    {
      const PlasticHistory<double> start = random_history(random);
      const VonMises<double> law(0.4, hardening, start, random_tensor(random, 0.05));
      const Tensor relative = law.stress - 2.0 / 3 * hardening.kinematic * law.history.strain;
      const double equivalent = std::sqrt(1.5 * contract(relative, relative));
      const double p = law.history.equivalent;
      const double limit =
          hardening.yield + hardening.isotropic * p + hardening.gain * (1 - std::exp(-hardening.rate * p));
      const Tensor flow = law.history.strain - start.strain;
      EXPECT_NEAR(std::sqrt(2.0 / 3 * contract(flow, flow)), p - start.equivalent, 1e-15);
      EXPECT_NEAR(law.stress.head<3>().sum(), 0, 1e-15);
      if (p == start.equivalent)
      {
        EXPECT_LE(equivalent, limit * (1 + 1e-11));
        continue;
      }
      EXPECT_NEAR(equivalent, limit, 1e-14);
      EXPECT_LT((flow / flow.norm() - relative / relative.norm()).norm(), 1e-12);
    }
}

/// Prandtl-Reuss's equations by explicit steps of the rates along a path that turns: strain s -> (first + s second) s.
TEST(VonMisesLaw, ManySmallIncrementsFollowTheRateEquations)
{
  const double shear = 0.4;
  std::mt19937 random(7);
  for (const Hardening &h : all_hardenings())
  {
    const Tensor first = deviator(random_tensor(random, 0.2)), second = deviator(random_tensor(random, 0.2));
    const auto path = [&](double s) -> Tensor { return s * first + s * s * second; };
    PlasticHistory<double> implicit;
    const int n = 4000;
    for (int k = 1; k <= n; ++k)
      implicit = VonMises<double>(shear, h, implicit, path(double(k) / n)).history;

    Tensor stress = Tensor::Zero(), back = Tensor::Zero();
    double p = 0;
    for (int k = 0; k < n; ++k)
    {
      const Tensor de = path((k + 1.0) / n) - path(double(k) / n);
      const Tensor relative = stress - back;
      const double equivalent = std::sqrt(1.5 * contract(relative, relative));
      const Tensor normal = 1.5 * relative / std::max(equivalent, 1e-300); // de_p = dp normal
      const double radius = h.yield + h.isotropic * p + h.gain * (1 - std::exp(-h.rate * p));
      const double slope = h.isotropic + h.gain * h.rate * std::exp(-h.rate * p) + h.kinematic;
      const double dp = equivalent < radius ? 0 : std::max(0.0, 2 * shear * contract(normal, de) / (3 * shear + slope));
      stress += 2 * shear * (de - dp * normal);
      back += 2.0 / 3 * h.kinematic * dp * normal;
      p += dp;
    }
    EXPECT_NEAR(implicit.equivalent, p, 2e-3 * p);
    EXPECT_LT((VonMises<double>(shear, h, implicit, path(1)).stress - stress).norm(), 2e-3 * stress.norm());
  }
}

template<class Cell>
class PlasticCells : public testing::Test, protected RandomCell<Cell>
{
protected:
  static std::vector<PlasticHistory<double>> history(unsigned seed)
  {
    std::mt19937 random(seed);
    std::vector<PlasticHistory<double>> out;
    for (int q = 0; q < Cell::points; ++q)
      out.push_back(random_history(random));
    return out;
  }
  const ElasticModuli moduli_{0.4, 0.9};
  const CellTables<Cell> tables_;
};

TYPED_TEST_SUITE(PlasticCells, AllCells);

TYPED_TEST(PlasticCells, TangentIsTheDerivativeOfTheForce)
{
  using Cell = TypeParam;
  int n_plastic = 0, n_points = 0;
  for (const Hardening &hardening : all_hardenings())
    for (const bool mean : this->mean_dilatation())
      for (unsigned seed = 1; seed <= 5; ++seed)
      {
        const auto u = this->values(seed + 100, 0.06);
        const auto points = this->tables_.at(this->reference(seed));
        const auto start = this->history(seed);
        const PlasticCell<Cell, double> cell(points, this->moduli_, hardening, mean, start.data(), u);
        const auto tangent = cell.tangent();
        EXPECT_LT((tangent - tangent.transpose()).norm(), 1e-14 * tangent.norm());
        for (int q = 0; q < Cell::points; ++q, ++n_points)
          n_plastic += cell.history(q).equivalent > start[q].equivalent;
        for (int i = 0; i < Cell::unknowns; ++i)
        {
          const PlasticCell<Cell, Complex> stepped(points, this->moduli_, hardening, mean, start.data(),
                                                   this->step(u, i));
          EXPECT_LT((tangent.col(i) - stepped.force().imag() / 1e-40).norm(), 1e-12 * tangent.norm()) << "column " << i;
        }
      }
  EXPECT_GT(2 * n_plastic, n_points);
}

TYPED_TEST(PlasticCells, BelowYieldTheyAreElastic)
{
  using Cell = TypeParam;
  const Hardening strong{1e6, 0, 0, 0, 0};
  const std::vector<PlasticHistory<double>> virgin(Cell::points);
  for (const bool mean : this->mean_dilatation())
  {
    const auto u = this->values(9, 1.0);
    const auto points = this->tables_.at(this->reference(3));
    const PlasticCell<Cell, double> cell(points, this->moduli_, strong, mean, virgin.data(), u);
    const auto elastic = small_strain_stiffness<Cell>(points, this->moduli_, mean);
    EXPECT_LT((cell.tangent() - elastic).norm(), 1e-14 * elastic.norm());
    const typename Cell::template Vector<double> force =
        elastic * Eigen::Map<const typename Cell::template Vector<double>>(u.data());
    EXPECT_LT((cell.force() - force).norm(), 1e-13 * force.norm());
    const auto stress = small_strain_stress<Cell>(points, this->moduli_, u);
    EXPECT_LT((cell.stress() - stress).norm(), 1e-13 * stress.norm());
  }
}
} // namespace
} // namespace amontons

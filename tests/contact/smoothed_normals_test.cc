#include "amontons/contact/kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace amontons
{
namespace
{
/// A face of random shape, an impactor node over it, and normals tilted from the face's by up to about 20 degrees.
struct Case
{
  int dim;
  std::vector<double> x; ///< impactor, then the face's nodes
  std::vector<double> start;
  std::vector<double> normals;

  Case(int dim_, int n_nodes, unsigned seed)
    : dim(dim_)
  {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> noise(-0.1, 0.1);
    const std::vector<double> face = n_nodes == 2   ? std::vector<double>{1, 0, 0, 0}
                                     : n_nodes == 3 ? std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0}
                                                    : std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    x = dim == 2 ? std::vector<double>{0.4, -0.05} : std::vector<double>{0.3, 0.4, 0.05};
    x.insert(x.end(), face.begin(), face.end());
    start = face;
    for (double &value : x)
      value += noise(generator);
    for (double &value : start)
      value += noise(generator);
    for (int i = 0; i < n_nodes; ++i)
    {
      std::vector<double> normal(static_cast<std::size_t>(dim), 0.0);
      normal.back() = 1; // the segment (1, 0) -> (0, 0) has its outward side up, as the faces in space
      double length = 0;
      for (double &value : normal)
      {
        value += 2 * noise(generator);
        length += value * value;
      }
      for (const double value : normal)
        normals.push_back(value / std::sqrt(length));
    }
  }

  [[nodiscard]] ContactLinearisation linearise(const std::vector<double> &at) const
  {
    const auto d = static_cast<std::size_t>(dim);
    const std::span<const double> all(at);
    return linearise_finite(dim, all.first(d), all.subspan(d), std::span(x).first(d), start, {0.3, 0.3}, normals);
  }
};

double largest_difference(const ContactMatrix &gradient, const Case &c,
                          const std::function<ContactVector(const ContactLinearisation &)> &what)
{
  // Fourth-order central differences: error about 1e-11 at this step.
  constexpr double h = 1e-3;
  double worst = 0;
  for (std::size_t j = 0; j < c.x.size(); ++j)
  {
    const auto at = [&](double shift)
    {
      std::vector<double> x = c.x;
      x[j] += shift;
      return what(c.linearise(x));
    };
    const ContactVector difference = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    worst = std::max(worst, (difference - gradient.col(static_cast<Eigen::Index>(j))).cwiseAbs().maxCoeff());
  }
  return worst;
}

class SmoothedNormals : public testing::TestWithParam<std::pair<int, int>>
{
};

TEST_P(SmoothedNormals, DirectionsHaveTheirDerivatives)
{
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    const Case c(GetParam().first, GetParam().second, seed);
    const ContactLinearisation now = c.linearise(c.x);
    EXPECT_GT((now.gap_direction - now.gap_gradient).norm(), 1e-3) << "the normals are not the face's own";
    EXPECT_LT(largest_difference(now.gap_direction_gradient, c, [](const auto &l) { return l.gap_direction; }), 1e-9);
    for (int a = 0; a < now.n_tangents(); ++a)
      EXPECT_LT(
          largest_difference(now.slip_direction_gradient[a], c, [a](const auto &l) { return l.slip_direction[a]; }),
          1e-9);
  }
}

TEST_P(SmoothedNormals, DirectionsAreOrthonormalAndInEquilibrium)
{
  const Case c(GetParam().first, GetParam().second, 3);
  const ContactLinearisation now = c.linearise(c.x);
  std::vector<ContactVector> rows{now.gap_direction};
  for (int a = 0; a < now.n_tangents(); ++a)
    rows.push_back(now.slip_direction[a]);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    for (std::size_t j = 0; j < rows.size(); ++j)
      EXPECT_NEAR(rows[i].head(c.dim).dot(rows[j].head(c.dim)), i == j ? 1 : 0, 1e-13);
    for (int k = 0; k < c.dim; ++k)
    {
      double sum = 0;
      for (Eigen::Index node = 0; node < rows[i].size() / c.dim; ++node)
        sum += rows[i][node * c.dim + k];
      EXPECT_NEAR(sum, 0, 1e-14);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Faces, SmoothedNormals, testing::Values(std::pair{2, 2}, std::pair{3, 3}, std::pair{3, 4}));

TEST(SmoothedNormalsTest, WithoutNormalsTheFacesOwn)
{
  const Case c(3, 4, 1);
  const ContactLinearisation now = linearise_finite(3, std::span(c.x).first(3), std::span(c.x).subspan(3),
                                                    std::span(c.x).first(3), c.start, {0.3, 0.3});
  EXPECT_EQ((now.gap_direction - now.gap_gradient).norm(), 0);
}
} // namespace
} // namespace amontons

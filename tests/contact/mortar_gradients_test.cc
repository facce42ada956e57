#include "mortar_scenes.h"

#include <gtest/gtest.h>

namespace amontons::test
{
namespace
{
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

MortarScene plane_scene(bool axisymmetric, int n, int m, double from, double to)
{
  return {curve(n,
                [](double s) {
                  return std::array{1 + s, 0.2 * std::sin(2 * s)};
                }),
          curve(m,
                [=](double s)
                {
                  const double t = to + (from - to) * s;
                  return std::array{1 + t, 0.2 * std::sin(2 * t) - 0.03 + 0.02 * std::cos(7 * t)};
                }),
          axisymmetric};
}

MortarScene space_scene(bool own_triangles, bool triangles, double low, double high)
{
  const auto height = [](double s, double t) { return 0.3 * std::sin(2 * s + 0.3) * std::cos(1.5 * t); };
  return {sheet(3, 3, own_triangles,
                [&](double s, double t) {
                  return Point{s + 0.05 * std::sin(5 * t), t * (1 + 0.1 * s), height(s, t)};
                }),
          sheet(4, 3, triangles,
                [&](double s, double t)
                {
                  const double a = low + (high - low) * t, b = low + (high - low) * s;
                  return Point{a, 1.1 * b + 0.04 * std::sin(6 * a), height(a, 1.1 * b) + 0.02 * std::cos(3 * a) + 0.03};
                })};
}

struct NamedScene
{
  std::string name;
  MortarScene scene;
};

std::vector<NamedScene> curved_scenes()
{
  std::vector<NamedScene> out{{"plane, covered wholly", plane_scene(false, 5, 7, -0.1, 1.2)},
                              {"plane, covered in part", plane_scene(false, 5, 7, 0.13, 0.77)},
                              {"ring", plane_scene(true, 6, 4, 0.13, 1.1)}};
  for (const bool own : {false, true})
    for (const bool other : {false, true})
    {
      const std::string kinds =
          std::string(own ? "triangles" : "quadrilaterals") + (other ? " on triangles" : " on quadrilaterals");
      out.push_back({kinds + ", covered wholly", space_scene(own, other, -0.2, 1.2)});
      out.push_back({kinds + ", covered in part", space_scene(own, other, 0.1, 0.83)});
    }
  return out;
}

double greatest(const MatrixXd &a)
{
  return a.cwiseAbs().maxCoeff();
}

// Differences of the coupling without gradients: their error falls with the square of the step, down to round-off.
TEST(MortarGradients, MatchDifferences)
{
  for (const auto &[name, scene] : curved_scenes())
  {
    Random random(3);
    const VectorXd x = scene.positions();
    const MortarCoupling coupling = scene.couple(x, {{}, true});
    const DenseCoupling values(scene, coupling), plain(scene, scene.couple(x));
    EXPECT_LT(greatest(values.weight - plain.weight), 1e-14) << name;
    EXPECT_LT(greatest(values.normal - plain.normal), 1e-15) << name;
    for (int trial = 0; trial < 3; ++trial)
    {
      const VectorXd direction = random_vector(random, static_cast<int>(x.size()));
      const DenseCoupling change = change_along(scene, coupling, direction);
      const auto error = [&](double h)
      {
        const DenseCoupling expected = difference_along(scene, x, direction, h);
        return std::array{greatest(change.normal - expected.normal), greatest(change.weight - expected.weight)};
      };
      const auto coarse = error(1e-4), fine = error(1e-5);
      for (const std::size_t of : {0, 1})
      {
        EXPECT_NEAR(std::log10(coarse[of] / fine[of]), 2, 0.15) << name;
        EXPECT_LT(fine[of], 1e-6) << name;
        EXPECT_LT(error(1e-6)[of], 2e-8) << name;
      }
    }
  }
}
} // namespace
} // namespace amontons::test

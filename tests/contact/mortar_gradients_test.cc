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

// A flat or bent patch, turned somehow, whose target has the same nodes and, where `beyond`, further ones all round.
struct MatchingScene
{
  MortarScene scene;
  std::vector<Index> partners; ///< [n impactor nodes], target nodes

  MatchingScene(bool triangles, bool beyond, double bend, double noise)
  {
    constexpr int n = 3;
    const int extra = beyond ? 1 : 0, m = n + 2 * extra;
    Random random(5);
    const Eigen::Matrix3d turn = random_rotation(random, 3);
    const auto map = [&](double s, double t)
    {
      const Vector3d x = turn * Vector3d(s + 0.1 * t, t * (1 + 0.15 * s), bend * (std::sin(2 * s) + std::cos(3 * t)));
      return Point{x[0], x[1], x[2]};
    };
    const auto place = [&](double s) { return (s * m - extra) / n; };
    scene.impactor = sheet(n, n, triangles, map);
    scene.target = sheet(m, m, triangles, [&](double s, double t) { return map(place(t), place(s)); });
    for (double &x : scene.target.reference)
      x += noise * uniform(random, -1, 1);
    for (Index j = 0; j <= n; ++j)
      for (Index i = 0; i <= n; ++i)
        partners.push_back((i + extra) * (m + 1) + j + extra);
  }
};

// Partners that move alike stay matched, and each node keeps the weight 1 of its partner whatever the motion.
TEST(MortarGradients, MatchingNodesStayMatched)
{
  Random random(9);
  for (const bool triangles : {false, true})
    for (const bool beyond : {false, true})
      for (const double bend : {0.0, 0.1})
        for (const double noise : {0.0, 1e-15, 1e-12, 1e-8})
        {
          const auto [scene, partners] = MatchingScene(triangles, beyond, bend, noise);
          VectorXd motion = random_vector(random, static_cast<int>(scene.positions().size()));
          for (std::size_t j = 0; j < partners.size(); ++j)
            motion.segment<3>(scene.n_own() + 3 * partners[j]) = motion.segment<3>(3 * static_cast<Eigen::Index>(j));
          const MortarCoupling coupling = scene.couple(scene.positions(), {{}, true});
          const DenseCoupling values(scene, coupling);
          for (std::size_t j = 0; j < partners.size(); ++j)
            EXPECT_NEAR(values.weight(static_cast<Eigen::Index>(j), partners[j]), 1, 1e-13 + 10 * noise);
          EXPECT_LT(greatest(change_along(scene, coupling, motion).weight),
                    std::max(1e-13, noise < 1e-10 ? 100 * noise : 1e-5))
              << triangles << beyond << bend << ' ' << noise;
        }
}

// Where edges coincide the weights' second derivatives jump, the first do not: differences err by the step itself.
TEST(MortarGradients, CoincidentEdgesHaveOneDerivative)
{
  Random random(7);
  std::vector<MortarScene> scenes;
  for (const bool triangles : {false, true})
    for (const double bend : {0.0, 0.1})
      scenes.push_back(MatchingScene(triangles, true, bend, 0).scene);
  // In the plane too, with target nodes on the impactor's, between them and beyond.
  scenes.push_back({chain({{0, 0}, {0.5, 0}, {1, 0}, {1.5, 0}}),
                    chain({{2, -0.1}, {1.5, -0.1}, {1.25, -0.1}, {1, -0.1}, {0.5, -0.1}, {-0.5, -0.1}})});
  for (const MortarScene &scene : scenes)
  {
    const VectorXd x = scene.positions(), direction = random_vector(random, static_cast<int>(x.size()));
    const DenseCoupling change = change_along(scene, scene.couple(x, {{}, true}), direction);
    const auto error = [&](double h)
    { return greatest(change.weight - difference_along(scene, x, direction, h).weight); };
    EXPECT_NEAR(std::log10(error(1e-4) / error(1e-5)), 1, 0.1);
    EXPECT_LT(error(1e-5), 1e-3);
  }
}

// A sharp edge of the impactor, and a target that covers but a sliver of a face, which another node stands in for.
TEST(MortarGradients, SharpEdgesAndSlivers)
{
  Random random(8);
  const MortarScene sharp{chain({{0, 0}, {0.5, 0.05}, {1, 0}, {1.4, 0.4}, {1.7, 0.8}}),
                          chain({{2.1, 0.7}, {1.6, 0.1}, {1.1, -0.3}, {0.3, -0.2}, {-0.4, -0.2}})};
  const MortarScene roof{sheet(2, 2, false,
                               [](double s, double t) {
                                 return Point{s, t, 0.8 * std::abs(s - 0.5) + 0.1 * t * t};
                               }),
                         sheet(3, 2, true,
                               [](double s, double t) {
                                 return Point{1.4 * t - 0.2, 1.4 * s - 0.2, 0.7 * std::abs(1.4 * t - 0.7) - 0.1};
                               })};
  const MortarScene sliver{chain({{0, 0}, {0.5, 0}, {1, 0}, {1.5, 0}}),
                           chain({{1 + 2e-7, -0.1}, {0.7, -0.1}, {0.4, -0.1}, {-0.2, -0.1}})};
  for (const MortarScene *scene : {&sharp, &roof, &sliver})
  {
    const VectorXd x = scene->positions();
    const VectorXd direction = (scene == &sliver ? 1e-3 : 1) * random_vector(random, static_cast<int>(x.size()));
    const MortarCoupling coupling = scene->couple(x, {{}, true});
    const DenseCoupling change = change_along(*scene, coupling, direction),
                        expected = difference_along(*scene, x, direction, 1e-6);
    EXPECT_LT(greatest(change.normal - expected.normal), 1e-8);
    EXPECT_LT(greatest(change.weight - expected.weight), 1e-7);
    EXPECT_FALSE(scene == &sliver && coupling.sees_target(3));
  }
}

// Rotated and shifted, a coupling keeps its weights, its normals turn, and its gradients turn with them.
TEST(MortarGradients, AreFrameIndifferent)
{
  Random random(6);
  for (const auto &[name, scene] : curved_scenes())
  {
    if (scene.axisymmetric)
      continue;
    const int dim = scene.dim();
    const MatrixXd turn = random_rotation(random, dim).topLeftCorner(dim, dim);
    const VectorXd shift = random_vector(random, dim), x = scene.positions();
    const VectorXd direction = random_vector(random, static_cast<int>(x.size()));
    VectorXd moved = x, turned = direction, rigid = x;
    MatrixXd spin = MatrixXd::Zero(dim, dim);
    spin(0, 1) = 0.8;
    spin(1, 0) = -0.8;
    for (Eigen::Index i = 0; i < x.size(); i += dim)
    {
      moved.segment(i, dim) = turn * x.segment(i, dim) + shift;
      turned.segment(i, dim) = turn * direction.segment(i, dim);
      rigid.segment(i, dim) = spin * x.segment(i, dim) + shift;
    }
    const MortarCoupling here = scene.couple(x, {{}, true}), there = scene.couple(moved, {{}, true});
    const DenseCoupling a(scene, here), b(scene, there);
    EXPECT_LT(greatest(a.weight - b.weight), 1e-12) << name;
    EXPECT_LT(greatest(a.normal * turn.transpose() - b.normal), 1e-13) << name;
    const DenseCoupling da = change_along(scene, here, direction), db = change_along(scene, there, turned);
    EXPECT_LT(greatest(da.weight - db.weight), 1e-11) << name;
    EXPECT_LT(greatest(da.normal * turn.transpose() - db.normal), 1e-12) << name;
    const DenseCoupling dr = change_along(scene, here, rigid);
    EXPECT_LT(greatest(dr.weight), 1e-12) << name;
    EXPECT_LT(greatest(dr.normal - a.normal * spin.transpose()), 1e-12) << name;
  }
}

TEST(MortarGradients, OfSomeNodesOnly)
{
  for (const auto &[name, scene] : curved_scenes())
  {
    std::vector<char> wanted(static_cast<std::size_t>(scene.impactor.n_nodes()), 0);
    wanted[2] = wanted[5] = 1;
    const VectorXd x = scene.positions();
    const MortarCoupling all = scene.couple(x, {{}, true}), some = scene.couple(x, {wanted, true});
    EXPECT_LT(some.n_overlaps, all.n_overlaps);
    for (Index j = 0; j < scene.impactor.n_nodes(); ++j)
    {
      if (wanted[j] == 0)
      {
        EXPECT_FALSE(some.sees_target(j));
        EXPECT_TRUE(some.targets_of(j).empty() && some.gradients.impactors_of(j).empty());
        continue;
      }
      const auto equal = [](const auto &a, const auto &b)
      { return std::equal(a.begin(), a.end(), b.begin(), b.end()); };
      EXPECT_EQ(some.area[j], all.area[j]);
      EXPECT_EQ(some.normal[j], all.normal[j]);
      EXPECT_TRUE(equal(some.targets_of(j), all.targets_of(j)) && equal(some.weights_of(j), all.weights_of(j)));
      EXPECT_TRUE(equal(some.gradients.impactors_of(j), all.gradients.impactors_of(j)));
      EXPECT_EQ(all.sees_target(j) ? all.gradients.impactors_of(j)[0] : j, j);
      EXPECT_TRUE(some.gradients.normal[j] == all.gradients.normal[j]);
      EXPECT_TRUE(some.gradients.weight[j] == all.gradients.weight[j]);
    }
  }
}
} // namespace
} // namespace amontons::test

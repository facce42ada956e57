// Gap and slip of mortar contact in finite sliding, with couplings made anew wherever the nodes go.
#include "amontons/contact/kinematics.h"
#include "measures.h"
#include "mortar_scenes.h"

#include <gtest/gtest.h>

namespace amontons::test
{
namespace
{
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// One node's linearisation and where its dofs stand among all positions.
struct Element
{
  ContactLinearisation lin;
  std::vector<Eigen::Index> dofs;

  [[nodiscard]] VectorXd of_dofs(const VectorXd &all) const { return all(dofs); }
  [[nodiscard]] VectorXd slip_vector() const
  {
    Vector3d out = Vector3d::Zero();
    for (int c = 0; c < lin.n_tangents(); ++c)
      out += lin.slip[c] * lin.tangent[c];
    return out.head(lin.dim);
  }
};

/// @param origin weights where the slip started, [n impactor nodes x n target nodes]: targets that have no weight any
/// more come after those of the coupling
Element linearise(const MortarScene &scene, const VectorXd &x, Index j, const MatrixXd &origin)
{
  const int dim = scene.dim();
  const MortarCoupling coupling = scene.couple(x, {{}, true});
  const auto impactors = coupling.gradients.impactors_of(j);
  std::vector<Index> targets(coupling.targets_of(j).begin(), coupling.targets_of(j).end());
  std::vector<double> weights(coupling.weights_of(j).begin(), coupling.weights_of(j).end());
  const auto n_now = static_cast<Eigen::Index>(targets.size());
  for (Index k = 0; k < scene.target.n_nodes(); ++k)
    if (origin(j, k) != 0 && std::find(targets.begin(), targets.begin() + n_now, k) == targets.begin() + n_now)
    {
      targets.push_back(k);
      weights.push_back(0);
    }
  Element out;
  std::vector<double> origin_weights;
  const auto add_dofs = [&](Eigen::Index first)
  {
    for (int c = 0; c < dim; ++c)
      out.dofs.push_back(first + c);
  };
  for (const Index node : impactors)
    add_dofs(static_cast<Eigen::Index>(dim) * node);
  for (const Index node : targets)
  {
    add_dofs(scene.n_own() + dim * node);
    origin_weights.push_back(origin(j, node));
  }
  const VectorXd places = x(out.dofs);
  const auto n_own = static_cast<Eigen::Index>(dim * impactors.size());
  MatrixXd by = MatrixXd::Zero(static_cast<Eigen::Index>(targets.size()), places.size());
  by.topLeftCorner(n_now, n_own + dim * n_now) = coupling.gradients.weight[j];
  const VectorXd own = places.head(n_own), others = places.tail(places.size() - n_own);
  out.lin = linearise_mortar(dim, coupling.normal[j], coupling.gradients.normal[j], span(own), span(others), weights,
                             by, origin_weights, {0, 1});
  return out;
}

MortarScene curved_in_plane()
{
  return {curve(5,
                [](double s) {
                  return std::array{s, 0.2 * std::sin(2 * s)};
                }),
          curve(7,
                [](double s) {
                  return std::array{1.2 - 1.4 * s, 0.2 * std::sin(2.4 - 2.8 * s) - 0.02};
                })};
}

MortarScene curved_in_space(bool own_triangles, bool triangles)
{
  const auto height = [](double s, double t) { return 0.2 * std::sin(2 * s) * std::cos(1.5 * t); };
  return {sheet(3, 3, own_triangles,
                [&](double s, double t) {
                  return Point{s + 0.05 * t * t, t, height(s, t)};
                }),
          sheet(4, 4, triangles,
                [&](double s, double t)
                {
                  const double a = 1.5 * t - 0.2, b = 1.4 * s - 0.2;
                  return Point{a, b, height(a, b) + 0.03 * a - 0.02};
                })};
}

std::vector<MortarScene> scenes()
{
  return {curved_in_plane(), curved_in_space(false, false), curved_in_space(true, false), curved_in_space(false, true)};
}

/// A node in the middle.
Index middle(const MortarScene &scene)
{
  return scene.dim() == 2 ? 3 : 5;
}

/// The target shifted along itself.
VectorXd slid(const MortarScene &scene, double by)
{
  VectorXd out = scene.positions();
  for (Eigen::Index i = scene.n_own(); i < out.size(); i += scene.dim())
    out[i] += by;
  return out;
}

TEST(MortarSliding, GradientsMatchDifferences)
{
  Random random(4);
  constexpr double h = 1e-6;
  for (const MortarScene &scene : scenes())
  {
    const Index j = middle(scene);
    const VectorXd x = scene.positions(), direction = random_vector(random, static_cast<int>(x.size()));
    const MatrixXd origin = DenseCoupling(scene, scene.couple(slid(scene, 0.2))).weight;
    const Element at = linearise(scene, x, j, origin), up = linearise(scene, x + h * direction, j, origin),
                  down = linearise(scene, x - h * direction, j, origin);
    ASSERT_EQ(at.dofs, up.dofs);
    const VectorXd moves = at.of_dofs(direction);
    EXPECT_NEAR(at.lin.gap_gradient.dot(moves), (up.lin.gap - down.lin.gap) / (2 * h), 1e-8);
    const auto expect_near = [&](const VectorXd &found, const VectorXd &above, const VectorXd &below)
    { EXPECT_LT((found - (above - below) / (2 * h)).cwiseAbs().maxCoeff(), 1e-7); };
    expect_near(at.lin.gap_direction_gradient * moves, up.lin.gap_direction, down.lin.gap_direction);
    for (int c = 0; c < scene.dim() - 1; ++c)
    {
      EXPECT_GT(std::abs(at.lin.slip[0]), 0.1);
      EXPECT_NEAR(at.lin.slip_gradient[c].dot(moves), (up.lin.slip[c] - down.lin.slip[c]) / (2 * h), 1e-8);
      expect_near(at.lin.slip_direction_gradient[c] * moves, up.lin.slip_direction[c], down.lin.slip_direction[c]);
    }
  }
}

// What a rigid motion of both sides does to a node, from the increment's beginning and in the rates: nothing.
TEST(MortarSliding, RigidMotionsChangeNothing)
{
  Random random(5);
  for (const MortarScene &scene : scenes())
  {
    const int dim = scene.dim();
    const Index j = middle(scene);
    const VectorXd x = scene.positions(), shift = random_vector(random, dim);
    const MatrixXd turn = random_rotation(random, dim).topLeftCorner(dim, dim);
    MatrixXd spin = random_rotation(random, dim).topLeftCorner(dim, dim);
    spin = (spin - spin.transpose()).eval();
    VectorXd moved = x, rate = x;
    for (Eigen::Index i = 0; i < x.size(); i += dim)
    {
      moved.segment(i, dim) = turn * x.segment(i, dim) + shift;
      rate.segment(i, dim) = spin * x.segment(i, dim) + shift;
    }
    const MatrixXd now = DenseCoupling(scene, scene.couple(x)).weight;
    EXPECT_LT(linearise(scene, moved, j, now).slip_vector().norm(), 1e-13);
    const MatrixXd origin = DenseCoupling(scene, scene.couple(slid(scene, 0.2))).weight;
    const Element here = linearise(scene, x, j, origin), there = linearise(scene, moved, j, origin);
    EXPECT_NEAR(there.lin.gap, here.lin.gap, 1e-13);
    EXPECT_LT((there.slip_vector() - turn * here.slip_vector()).norm(), 1e-12);
    EXPECT_NEAR(here.lin.gap_gradient.dot(here.of_dofs(rate)), 0, 1e-12);
    for (int c = 0; c < dim - 1; ++c)
    {
      EXPECT_NEAR(there.lin.slip[c], here.lin.slip[c], 1e-12);
      EXPECT_NEAR(here.lin.slip_gradient[c].dot(here.of_dofs(rate)), 0, 1e-12);
    }
  }
}

// Over a flat target of irregular faces, with however many of them crossed, slip is the way gone; and its rate works
// against forces that are in equilibrium.
TEST(MortarSliding, SlipIsTheWayGoneOnAFlat)
{
  for (const bool triangles : {false, true})
  {
    const MortarScene scene{sheet(3, 3, triangles,
                                  [](double s, double t) {
                                    return Point{0.4 * s, 0.3 * t, 0};
                                  }),
                            sheet(7, 6, !triangles,
                                  [](double s, double t) {
                                    return Point{2 * t - 0.5 + 0.05 * std::sin(9 * s), 1.6 * s - 0.5, 0};
                                  })};
    VectorXd x = scene.positions();
    const MatrixXd origin = DenseCoupling(scene, scene.couple(x)).weight;
    const Vector3d way(0.7, 0.45, 0);
    for (Eigen::Index i = 0; i < scene.n_own(); i += 3)
      x.segment<3>(i) += way;
    for (Index j = 0; j < scene.impactor.n_nodes(); ++j)
    {
      const Element element = linearise(scene, x, j, origin);
      EXPECT_LT((element.slip_vector() - way).norm(), 1e-10) << j;
      EXPECT_NEAR(element.lin.gap, 0, 1e-13);
      Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
      for (std::size_t d = 0; d < element.dofs.size(); d += 3)
      {
        const Vector3d f = element.lin.slip_direction[0].segment<3>(static_cast<Eigen::Index>(d));
        force += f;
        moment += Vector3d(x.segment<3>(element.dofs[d])).cross(f);
      }
      EXPECT_LT(force.norm(), 1e-12);
      EXPECT_LT(moment.norm(), 1e-10);
      VectorXd motion = VectorXd::Zero(x.size());
      for (Eigen::Index i = 0; i < scene.n_own(); i += 3)
        motion.segment<3>(i) = way;
      EXPECT_NEAR(element.lin.slip_gradient[0].dot(element.of_dofs(motion)), element.lin.tangent[0].dot(way), 1e-8);
      EXPECT_NEAR(element.lin.slip_direction[0].dot(element.of_dofs(motion)), element.lin.tangent[0].dot(way), 1e-12);
    }
  }
}
} // namespace
} // namespace amontons::test

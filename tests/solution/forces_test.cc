#include "problem.h"

#include <gtest/gtest.h>

/// Nodes, contacts and supports tell of one and the same force.
namespace amontons::test
{
namespace
{
enum class Target
{
  deformable,
  rigid,
  analytic
};

class Forces : public testing::TestWithParam<std::tuple<Kinematics, Strain, Target>>
{
protected:
  static Problem make(Kinematics kinematics, Strain strain, Target target)
  {
    const bool space = kinematics == Kinematics::three_dimensional;
    const int dim = space ? 3 : 2;
    Blocks blocks(dim);
    if (space)
      blocks.add("body", {-0.5, -0.4, 0.01}, {0.93, 0.83, 0.8}, {3, 3, 2});
    else
      blocks.add("body", {kinematics == Kinematics::axisymmetric ? 0. : -0.5, 0.01, 0}, {0.93, 0.8, 0}, {6, 4, 0});
    if (target == Target::deformable && space)
      blocks.add("base", {-1, -1, -1}, {2, 2, 1}, {4, 4, 1});
    else if (target == Target::deformable)
      blocks.add("base", {kinematics == Kinematics::axisymmetric ? 0. : -1., -1, 0}, {2, 1, 0}, {8, 3, 0});
    else if (target == Target::rigid && space)
      blocks.add_sheet("base", {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, {3, 3});
    else if (target == Target::rigid)
      blocks.add_line("base", {{2, 0, 0}, {0, 0, 0}, {-1, 0.1, 0}}, 3);
    if (target == Target::rigid && kinematics == Kinematics::axisymmetric)
    {
      blocks = Blocks(2);
      blocks.add("body", {0, 0.01, 0}, {0.93, 0.8, 0}, {6, 4, 0});
      blocks.add_line("base", {{2, 0, 0}, {0, 0, 0}}, 3);
    }
    Problem problem(blocks, kinematics, strain);
    problem.elastic("body");
    if (target == Target::deformable)
      problem.elastic("base", 2);
    else if (target == Target::rigid)
      problem.rigid("base");
    else
      problem.rigid("base", ground(dim));
    problem.contact("body_bottom", target == Target::deformable ? "base_top" : "base", 0.2);
    if (target == Target::deformable)
      problem.on("base_bottom").fix = space ? std::vector{0, 1, 2} : std::vector{0, 1};
    BoundaryOptions &top = problem.on("body_top");
    top.displacement = {{dim - 1, expression("-0.06*t")}};
    if (kinematics != Kinematics::axisymmetric)
      top.displacement[0] = expression("0.03*t");
    if (space)
      top.displacement[1] = expression("-0.02*t");
    problem.options.loading.increments = 2;
    problem.options.solver.tolerance = 1e-12;
    return problem;
  }
};

TEST_P(Forces, OfNodesContactAndSupportsAgree)
{
  const auto [kinematics, strain, target] = GetParam();
  const Record run = make(kinematics, strain, target).converge();
  const ContactResult &contact = run.contact();
  const Point force = total_force(contact);
  ASSERT_GT(force[contact.dim - 1], 0.01);
  const double close = 1e-10 * force.norm();
  EXPECT_NEAR((sum_of_nodes(contact) - force).norm(), 0, close);
  const std::string base = target == Target::deformable ? "base_bottom" : "base";
  for (int c = 0; c < contact.dim; ++c)
  {
    if (kinematics == Kinematics::axisymmetric && c == 0)
      continue; // radial forces over a ring have no sum
    EXPECT_NEAR(run.reaction("body_top")[c], -force[c], close);
    EXPECT_NEAR(run.reaction(base)[c], force[c], close);
  }
  double normal = 0, area = 0, peak = 0;
  for (std::size_t i = 0; i < contact.pressure.size(); ++i)
  {
    normal += contact.pressure[i] * contact.area[i];
    peak = std::max(peak, contact.pressure[i]);
    if (contact.status[i] != ContactStatus::open)
      area += contact.area[i];
  }
  EXPECT_EQ(contact.n_active, contact.n_stick + contact.n_slip);
  EXPECT_NEAR(contact.contact_area, area, 1e-14);
  EXPECT_EQ(contact.max_pressure, peak);
  if (strain == Strain::small && (target != Target::rigid || kinematics == Kinematics::three_dimensional))
    EXPECT_NEAR(normal, contact.normal_force[contact.dim - 1], close) << "on a flat target";
}

const auto all_targets = testing::Values(Target::deformable, Target::rigid, Target::analytic);
INSTANTIATE_TEST_SUITE_P(All, Forces,
                         testing::Combine(testing::Values(Kinematics::plane_strain, Kinematics::plane_stress,
                                                          Kinematics::three_dimensional),
                                          testing::Values(Strain::small, Strain::finite), all_targets));
INSTANTIATE_TEST_SUITE_P(Rings, Forces,
                         testing::Combine(testing::Values(Kinematics::axisymmetric), testing::Values(Strain::small),
                                          all_targets));
INSTANTIATE_TEST_SUITE_P(RingsInFiniteStrain, Forces,
                         testing::Combine(testing::Values(Kinematics::axisymmetric), testing::Values(Strain::finite),
                                          testing::Values(Target::rigid, Target::analytic)));
// Rows of the node on the axis depend on each other all but exactly, and the matrix is singular.
INSTANTIATE_TEST_SUITE_P(RingsOnADeformableBase, Forces,
                         testing::Combine(testing::Values(Kinematics::axisymmetric), testing::Values(Strain::finite),
                                          testing::Values(Target::deformable)));
} // namespace
} // namespace amontons::test

#include "block_mesh.h"

#include <gmock/gmock.h>

namespace amontons
{
namespace
{
struct PatchCase
{
  CellShape shape;
  Kinematics kinematics;
  bool mean_dilatation;
};

std::string name(const testing::TestParamInfo<PatchCase> &info)
{
  const std::array<std::string, 5> shapes{"Segment", "Triangle", "Quadrilateral", "Tetrahedron", "Hexahedron"};
  const std::array<std::string, 4> kinematics{"PlaneStrain", "PlaneStress", "Axisymmetric", "Solid"};
  return shapes[static_cast<int>(info.param.shape)] + kinematics[static_cast<int>(info.param.kinematics)] +
         (info.param.mean_dilatation ? "MeanDilatation" : "");
}

std::vector<PatchCase> all_cases()
{
  std::vector<PatchCase> cases;
  for (const CellShape shape : {CellShape::triangle, CellShape::quadrilateral})
    for (const Kinematics k : {Kinematics::plane_strain, Kinematics::plane_stress, Kinematics::axisymmetric})
      for (const bool mean : {false, true})
        if (!(mean && k == Kinematics::plane_stress))
          cases.push_back({shape, k, mean});
  for (const CellShape shape : {CellShape::tetrahedron, CellShape::hexahedron})
    for (const bool mean : {false, true})
      cases.push_back({shape, Kinematics::three_dimensional, mean});
  return cases;
}

/// A body all of whose nodes, inner ones too, lie askew; away from the axis.
Mesh distorted(CellShape shape)
{
  BlockMesh block{shape, {3, 3, 3}, 0.25};
  block.map = [](const Eigen::Vector3d &x)
  { return Eigen::Vector3d(1 + 2 * x[0] + 0.3 * x[1] * x[0], x[1] + 0.4 * x[0] * x[0], x[2] + 0.2 * x[0] * x[1]); };
  return block.make();
}

class PatchTest : public testing::TestWithParam<PatchCase>
{
protected:
  /// Homogeneous deformation; in axisymmetry one that keeps the hoop strain constant.
  [[nodiscard]] Eigen::Matrix3d gradient(double size) const
  {
    Eigen::Matrix3d G;
    G << 0.3, -0.2, 0.1, 0.15, -0.25, 0.05, -0.1, 0.2, 0.35;
    if (GetParam().kinematics == Kinematics::axisymmetric)
      G(0, 1) = 0, G(1, 0) = 0;
    return size * G;
  }

  /// Boundary nodes follow the field; inner ones are to be found from a start far off it.
  void check(Strain strain, double size, double start_error)
  {
    const PatchCase &param = GetParam();
    const Mesh mesh = distorted(param.shape);
    BodyAssembly assembly(mesh, param.kinematics, strain,
                          {elastic_body(MaterialLaw::neo_hookean, 3.0, 0.3, param.mean_dilatation)}, {});
    const Eigen::Matrix3d G = gradient(size);
    const std::vector<double> exact = nodal_field(mesh, [&](const Eigen::Vector3d &X) { return G * X; });
    const std::vector<bool> held = boundary_nodes(mesh);
    ASSERT_GT(std::count(held.begin(), held.end(), false), 0);
    std::vector<double> u = exact;
    for (std::size_t i = 0; i < u.size(); ++i)
      if (!held[i])
        u[i] += start_error * std::sin(37.0 * static_cast<double>(i));
    ASSERT_GT(solve(mesh, assembly, held, 0, u), 0);
    for (std::size_t i = 0; i < u.size(); ++i)
      EXPECT_NEAR(u[i], exact[i], 1e-12) << i;
    check_stress(assembly.stress(u));
  }

  static void check_stress(const std::vector<double> &stress)
  {
    for (std::size_t i = 6; i < stress.size(); ++i)
      EXPECT_NEAR(stress[i], stress[i % 6], 1e-11) << "the stress is not uniform: cell " << i / 6;
  }
};

TEST_P(PatchTest, SmallStrain)
{
  check(Strain::small, 1, 0.1);
}

TEST_P(PatchTest, FiniteStrain)
{
  check(Strain::finite, 0.7, 0.01);
}

TEST_P(PatchTest, RigidMotionGivesNoForce)
{
  const PatchCase &param = GetParam();
  const Mesh mesh = distorted(param.shape);
  const BodyAssembly assembly(mesh, param.kinematics, Strain::finite,
                              {elastic_body(MaterialLaw::neo_hookean, 3.0, 0.3, param.mean_dilatation)}, {});
  Eigen::Matrix3d R = Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  if (param.kinematics == Kinematics::three_dimensional)
    R = R * Eigen::AngleAxisd(-1.3, Eigen::Vector3d(1, 2, 3).normalized());
  Eigen::Vector3d shift(0.7, -0.4, 0.2);
  if (param.kinematics == Kinematics::axisymmetric)
    R.setIdentity(), shift[0] = 0;
  const std::vector<double> u =
      nodal_field(mesh, [&](const Eigen::Vector3d &X) { return Eigen::Vector3d(R * X - X + shift); });
  std::vector<double> internal(u.size()), external(u.size());
  ASSERT_TRUE(assembly.forces(u, 0, internal, external));
  for (const double f : internal)
    EXPECT_NEAR(f, 0, 1e-12);
}

TEST_P(PatchTest, ACellTurnedInsideOutIsReported)
{
  const PatchCase &param = GetParam();
  const Mesh mesh = distorted(param.shape);
  BodyAssembly assembly(mesh, param.kinematics, Strain::finite,
                        {elastic_body(MaterialLaw::neo_hookean, 3.0, 0.3, param.mean_dilatation)}, {});
  std::vector<double> internal(mesh.points.size()), external(mesh.points.size());
  const std::vector<double> mirrored =
      nodal_field(mesh, [](const Eigen::Vector3d &X) { return Eigen::Vector3d(0, -2 * X[1], 0); });
  EXPECT_FALSE(assembly.forces(mirrored, 0, internal, external));
  EXPECT_FALSE(assembly.assemble_tangent(mirrored, 0));
}

INSTANTIATE_TEST_SUITE_P(AllCells, PatchTest, testing::ValuesIn(all_cases()), name);
} // namespace
} // namespace amontons

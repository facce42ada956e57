#pragma once
#include "amontons/bulk/expression.h"
#include "amontons/bulk/mesh.h"
#include "amontons/bulk/options.h"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace amontons
{
/// One component of a rigid body's motion: held at zero unless a condition names it.
struct RigidComponent
{
  enum class Kind
  {
    held,
    prescribed, ///< `function` is the displacement (length) or the rotation (radians)
    free        ///< `function` is the force or the moment (about the body's point)
  };
  Kind kind = Kind::held;
  std::optional<Function> function;
  Index unknown = -1; ///< position among the rigid unknowns, for free components
};

/// A rigid body: nodes of the mesh, or one extra node that stands for an analytic shape's point.
struct RigidBody
{
  std::string name;
  int option = 0;           ///< position in the deck's bodies
  std::vector<Index> nodes; ///< nodal positions; an extra node is numbered from n_mesh_nodes on
  std::optional<Shape> shape;
  Eigen::Vector3d point{0, 0, 0}; ///< reference place of its point: mean of its nodes, or the shape's
  std::array<RigidComponent, 3> translation, rotation; ///< in the plane rotation only about z
};

/// Where the rigid bodies are: translation of the point, and rotation (a vector theta in small strain and where it is
/// prescribed; a matrix follows from it or from the free spins).
struct RigidState
{
  Eigen::Vector3d translation{0, 0, 0};
  Eigen::Vector3d rotation_vector{0, 0, 0};
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
};

/// The rigid bodies of a problem and their motion.
class RigidBodies
{
public:
  /// @throws UserError: a rotation of an analytic shape, a condition that axisymmetry forbids, free and prescribed
  ///         rotations mixed in finite strain
  RigidBodies(const Mesh &mesh, Kinematics kinematics, Strain strain, const std::vector<BodyOptions> &bodies,
              const std::vector<BoundaryOptions> &boundary);

  [[nodiscard]] std::span<const RigidBody> bodies() const { return bodies_; }
  [[nodiscard]] Index n_extra_nodes() const { return n_extra_nodes_; }
  [[nodiscard]] Index n_unknowns() const { return n_unknowns_; }
  /// The rigid body of a deck's body, or -1.
  [[nodiscard]] int of_option(int option) const;
  /// Is this boundary entry about a rigid body (named by body or by the body's region)?
  [[nodiscard]] bool concerns(const BoundaryOptions &entry) const { return find(entry.region) >= 0; }

  [[nodiscard]] std::vector<RigidState> initial_state() const { return std::vector<RigidState>(bodies_.size()); }
  /// State with prescribed and held components moved to their values at `time` by the fraction `share` of the way.
  [[nodiscard]] std::vector<RigidState> prescribe(std::vector<RigidState> state, double time, double share = 1) const;
  /// State after the free components moved by `increment` [n_unknowns] (rotations: spins).
  [[nodiscard]] std::vector<RigidState> advance(std::vector<RigidState> state, std::span<const double> increment) const;
  /// Displacement of a node of body b whose reference place is X.
  [[nodiscard]] Eigen::Vector3d displacement(int b, const RigidState &state, const Eigen::Vector3d &reference) const;
  /// d(displacement of X)/d(spin about axis).
  [[nodiscard]] Eigen::Vector3d spin_velocity(int b, const RigidState &state, const Eigen::Vector3d &reference,
                                              int axis) const;
  /// forces[unknown] += force or moment at `time`.
  void add_forces(double time, std::span<double> forces) const;

private:
  [[nodiscard]] int find(const std::string &region) const;
  void read_conditions(const BoundaryOptions &entry, RigidBody &body);
  void number_unknowns();

  int dim_;
  Kinematics kinematics_;
  Strain strain_;
  std::vector<RigidBody> bodies_;
  std::vector<std::string> regions_; ///< region of each rigid body
  Index n_extra_nodes_ = 0;
  Index n_unknowns_ = 0;
};
} // namespace amontons

#pragma once
#include "amontons/bulk/expression.h"
#include "amontons/bulk/mesh.h"
#include "amontons/bulk/options.h"
#include "amontons/bulk/rigid_bodies.h"

#include <span>
#include <vector>

namespace amontons
{
/// A nodal component whose displacement is given.
struct HeldComponent
{
  Index nodal;  ///< node * dim + component
  int function; ///< position among the functions; -1 for zero
  int entry;    ///< position in the deck's `boundary`; -1 for the axis of revolution
};

/// Supports and prescribed displacements of deformable bodies. Nodes on the axis of revolution have no radial motion.
class Supports
{
public:
  /// @param end time up to which two conditions on one component must agree
  /// @throws UserError: conditions that conflict, a support on nodes of a rigid body
  Supports(const Mesh &mesh, Kinematics kinematics, const std::vector<BodyOptions> &bodies,
           const std::vector<BoundaryOptions> &boundary, const RigidBodies &rigid, double end);

  /// Sorted by nodal component, each once.
  [[nodiscard]] std::span<const HeldComponent> held() const { return held_; }
  /// Displacement of a held component at a time.
  [[nodiscard]] double value(const HeldComponent &held, double time) const;

private:
  void add_entry(int entry, const BoundaryOptions &options, const Group &group, const std::vector<char> &is_rigid);
  void merge(const std::vector<BoundaryOptions> &boundary, double end);

  const Mesh &mesh_;
  std::vector<Function> functions_;
  std::vector<HeldComponent> held_;
};

/// The group a boundary entry means: a physical group of that name, else the region of the body of that name.
const Group &boundary_group(const Mesh &mesh, const std::vector<BodyOptions> &bodies, const BoundaryOptions &entry);
} // namespace amontons

#pragma once
#include "amontons/base/error.h"

#include <optional>
#include <string>

namespace amontons
{
/// What to do with impactor nodes that lie inside the target before anything moves.
enum class InitialOverlap
{
  resolve, ///< a press-fit: the gap is closed within the first increment, stresses and all
  adjust   ///< the gap is measured from its initial value: no stress comes of it
};

/// Along which normals contact forces act on a meshed target in finite strain.
enum class TargetNormals
{
  faceted, ///< of the face: they jump where a node slides from one face to the next
  smoothed ///< averaged at the target's nodes and interpolated; edges sharper than 30 degrees stay sharp
};

/// Where the gap between two meshed surfaces is measured.
enum class Discretization
{
  node_to_face, ///< at the impactor's nodes
  mortar        ///< in the mean over the impactor's faces (contact/mortar.h): surface-to-surface
};

struct ContactOptions
{
  std::string name;
  std::string impactor; ///< physical group of faces
  std::string target;   ///< physical group of faces, or the name of an analytic rigid body; the impactor's
                        ///< again: self-contact, that surface is both sides
  std::optional<double> self_distance; ///< self-contact: length along the surface within which it does not touch
                                       ///< itself; absent: twice the local edges
  double friction_coefficient = 0;     ///< Coulomb's mu, >= 0
  bool tied = false;                   ///< the sides are held together as they are at the start, whatever the forces
  InitialOverlap initial_overlap = InitialOverlap::resolve;
  TargetNormals normals = TargetNormals::faceted;
  Discretization discretization = Discretization::node_to_face;
  double augmentation = 1; ///< factor on the automatic r, > 0; the converged result does not depend on it
  SourceLocation where;

  [[nodiscard]] bool is_self_contact() const { return impactor == target; }
};
} // namespace amontons

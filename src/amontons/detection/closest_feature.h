#pragma once
#include "amontons/detection/self_contact_exclusions.h"
#include "amontons/detection/target.h"
#include "amontons/surface/pairing.h"

namespace amontons
{
/// How far past the target's ends it extends where the user does not say, in units of the last face's extent in that
/// direction.
constexpr double default_extension = 0.1;

/// A closest point of the target: a face and the local point on it, the border included.
struct Candidate
{
  Index face = -1;
  LocalPoint xi{0, 0};
  double squared_distance = 0;
  double gap = 0; ///< of the node over this face at xi, along its outward normal
};

/// Whether the candidate lies inside its face, clear of edges and vertices: then it is all that there is to see there.
bool is_inside_face(const Target &target, const Candidate &candidate);

/// What the target is at a candidate: which face gives the normal, on which side the impactor node lies.
struct Feature
{
  Pair pair;                ///< kind `extension` where the node is past the target's end
  double overhang = 0;      ///< how far past the end, along the face; 0 if not
  double extent = 0;        ///< of the face, in that direction
  LocalPoint closest{0, 0}; ///< the closest point on pair.face, of which its normal is
  bool inside = false;      ///< the node is seen from inside the body
  bool is_minimum = true;   ///< no attached face comes closer, to first order
};

/// Looks at a candidate with all faces that meet at it (THEORY.md section 4, step 4):
///
/// | closest point | face that gives n, xi and gap | kind |
/// | --- | --- | --- |
/// | inside a face | that face | face |
/// | on an edge or vertex, the node above an attached face | the face | face |
/// | convex edge or vertex, the node in the dead angle | attached face of greatest signed distance | edge, vertex |
/// | concave edge or vertex, the node inside the body | the same: the least penetration | edge, vertex |
/// | end of the target, the node past it | attached face of greatest signed distance | extension |
///
/// Signed distances are taken to the faces' tangent planes at the closest point; faces that tie within round-off go to
/// the smaller id. The side is that of the pseudonormal, the sum of the attached faces' normals weighted by their
/// angles, which is right at every vertex of a closed surface (Baerentzen, Aanaes 2005); only faces that agree with it
/// are chosen.
/// @param only_minima give up, with only `is_minimum` set, where the candidate is not one
/// In self-contact the target ends at sharp edges beyond which it is turned away from the node: a corner flush with
/// another comes through the face it sees, though it is nearer to the side.
/// @param sight faces that are hidden from the node are not chosen (the candidate's own is seen)
Feature look_at(const Target &target, const Candidate &candidate, const Eigen::Vector3d &x, bool only_minima = false,
                Sight sight = {});
} // namespace amontons

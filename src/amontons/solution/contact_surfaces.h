#pragma once
#include "amontons/bulk/mesh.h"
#include "amontons/bulk/options.h"
#include "amontons/contact/options.h"
#include "amontons/parallel/sharing.h"
#include "amontons/surface/surface.h"

#include <memory>
#include <optional>
#include <vector>

namespace amontons
{
/// The meshed sides of a contact: the impactor, then the target, if that is another surface of the mesh.
/// @throws UserError as extract_surface() and check_not_welded()
std::vector<Surface> contact_sides(const Mesh &mesh, const ContactOptions &options,
                                   const std::vector<BodyOptions> &bodies);

/// Whether every process needs the whole target: smoothed normals at its corners are means over the faces round them.
bool wants_whole_target(const ContactOptions &contact, Strain strain);

/// The nodes that are the process's own, then those of its faces that are not; others are left out.
/// @param is_own [n_nodes]
Surface own_first(const Surface &surface, const std::vector<char> &is_own);

/// What one process has of a contact's surfaces; all of them on one process. Ids are positions in the whole mesh.
struct ContactSurfaces
{
  Surface impactor;                ///< the nodes that the process owns first, then those of its faces that others own
  Index n_own = 0;                 ///< nodes of the impactor that are its own
  std::vector<Index> nodes;        ///< [n_nodes] of the impactor: positions on the process
  std::optional<Surface> target;   ///< none in self-contact and where it is analytic
  std::vector<Index> target_nodes; ///< its positions on the process
  Sharing sharing;                 ///< of the impactor's nodes
  /// The same whole, of which every process has all: both for mortar, the target for smoothed normals; else none.
  std::shared_ptr<const Surface> whole_impactor, whole_target;
};
} // namespace amontons

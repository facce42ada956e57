#include "amontons/solution/contact_surfaces.h"

#include "amontons/bulk/surface_extraction.h"

#include <algorithm>
#include <numeric>

namespace amontons
{
std::vector<Surface> contact_sides(const Mesh &mesh, const ContactOptions &options,
                                   const std::vector<BodyOptions> &bodies)
{
  std::vector<Surface> sides{extract_surface(mesh, options.impactor, options.where)};
  if (options.is_self_contact())
    sides[0].face_bodies = bodies_of_faces(mesh, sides[0]);
  else if (std::none_of(bodies.begin(), bodies.end(),
                        [&](const BodyOptions &body) { return body.shape && body.name == options.target; }))
  {
    sides.push_back(extract_surface(mesh, options.target, options.where));
    check_not_welded(mesh, sides[0], sides[1], options.impactor, options.target, options.where);
  }
  return sides;
}

bool wants_whole_target(const ContactOptions &contact, Strain strain)
{
  return strain == Strain::finite && contact.normals == TargetNormals::smoothed &&
         contact.discretization == Discretization::node_to_face;
}

Surface own_first(const Surface &surface, const std::vector<char> &is_own)
{
  std::vector<Index> order;
  for (Index i = 0; i < surface.n_nodes(); ++i)
    if (is_own[i] != 0)
      order.push_back(i);
  for (Index i = 0; i < surface.n_nodes(); ++i)
    if (is_own[i] == 0 && !surface.faces_of_node(i).empty())
      order.push_back(i);
  std::vector<Index> faces(static_cast<std::size_t>(surface.n_faces()));
  std::iota(faces.begin(), faces.end(), 0);
  Surface out = share_of_surface(surface, order, faces);
  out.build_adjacency();
  return out;
}
} // namespace amontons

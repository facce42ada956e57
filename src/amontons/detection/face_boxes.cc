#include "amontons/detection/face_boxes.h"

#include "amontons/surface/projection.h"

#include <algorithm>

namespace amontons
{
namespace
{
template<int dim>
typename BoxTree<dim>::Box flattened(const Eigen::AlignedBox3d &box)
{
  typename BoxTree<dim>::Box out;
  for (int c = 0; c < dim; ++c)
  {
    out[c] = box.min()[c];
    out[c + dim] = box.max()[c];
  }
  return out;
}

template<int dim>
BoxTree<dim> make_tree(std::span<const Eigen::AlignedBox3d> boxes)
{
  BoxTree<dim> tree;
  std::vector<std::array<double, dim>> centres(boxes.size());
  Eigen::AlignedBox3d all;
  for (std::size_t f = 0; f < boxes.size(); ++f)
  {
    const Eigen::Vector3d centre = boxes[f].center();
    std::copy_n(centre.data(), dim, centres[f].begin());
    all.extend(boxes[f]);
  }
  tree.order_by(centres, static_cast<Index>(boxes.size()));
  tree.refit(flattened<dim>(all), [&](std::size_t slot) { return flattened<dim>(boxes[tree.order()[slot]]); });
  return tree;
}
} // namespace

FaceBoxes::FaceBoxes(const Surface &surface, std::span<const double> x)
{
  std::vector<Eigen::AlignedBox3d> boxes(static_cast<std::size_t>(surface.n_faces()));
  for (Index f = 0; f < surface.n_faces(); ++f)
  {
    const FaceCoordinates face = gather_face(surface.dim, surface.face(f), x);
    for (int i = 0; i < face.n_nodes; ++i)
      boxes[f].extend(face.x[i]);
  }
  if (surface.dim == 2)
    tree_ = make_tree<2>(boxes);
  else
    tree_ = make_tree<3>(boxes);
}

void FaceBoxes::meeting(const Eigen::AlignedBox3d &box, std::vector<Index> &faces) const
{
  faces.clear();
  const auto collect = [&](const auto &tree, const auto &flat)
  { tree.visit_meeting(flat, [&](Index slot) { faces.push_back(tree.order()[slot]); }); };
  if (const auto *plane = std::get_if<BoxTree<2>>(&tree_))
    collect(*plane, flattened<2>(box));
  else
    collect(std::get<BoxTree<3>>(tree_), flattened<3>(box));
  std::sort(faces.begin(), faces.end());
}
} // namespace amontons

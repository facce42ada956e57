#include "amontons/algebra/rigid_modes.h"

#include <Eigen/QR>

#include <algorithm>

namespace amontons
{
namespace
{
/// Velocity of a component of a node in a rigid motion: the translations first, then the rotations.
double velocity(int mode, int dim, std::span<const double> place, int component)
{
  if (mode < dim)
    return component == mode ? 1 : 0;
  if (dim == 2)
    return component == 0 ? -place[1] : place[0];
  const int axis = mode - dim, next = (axis + 1) % 3, last = (axis + 2) % 3;
  return component == next ? -place[last] : component == last ? place[next] : 0;
}
} // namespace

std::vector<std::vector<double>> rigid_modes(const Layout &layout, const NodeBlocks &blocks,
                                             std::span<const double> reference)
{
  const int dim = blocks.block_size();
  std::vector<Index> shared;
  for (Index unknown = 0; unknown < layout.n_displacement_unknowns(); ++unknown)
    if (blocks.is_shared(unknown))
      shared.push_back(unknown);
  Eigen::MatrixXd gram =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(shared.size()), static_cast<Eigen::Index>(shared.size()));
  const auto place = [&](Index unknown) { return std::find(shared.begin(), shared.end(), unknown) - shared.begin(); };
  std::vector<std::vector<double>> modes;
  for (int mode = 0; mode < (dim == 2 ? 3 : 6); ++mode)
  {
    auto &out = modes.emplace_back(static_cast<std::size_t>(blocks.n_rows()), 0.0);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(gram.rows());
    for (Index nodal = 0; nodal < layout.n_nodal(); ++nodal)
    {
      const double v =
          velocity(mode, dim, reference.subspan(static_cast<std::size_t>(nodal / dim * dim), dim), nodal % dim);
      for (const Term &term : layout.terms(nodal))
        if (!blocks.is_shared(term.unknown))
          out[blocks.row(term.unknown)] = v;
        else
        {
          right[place(term.unknown)] += term.coefficient * v;
          for (const Term &other : layout.terms(nodal))
            if (mode == 0 && blocks.is_shared(other.unknown))
              gram(place(term.unknown), place(other.unknown)) += term.coefficient * other.coefficient;
        }
    }
    if (shared.empty())
      continue;
    const Eigen::VectorXd fitted = gram.completeOrthogonalDecomposition().solve(right);
    for (std::size_t k = 0; k < shared.size(); ++k)
      out[blocks.row(shared[k])] = fitted[static_cast<Eigen::Index>(k)];
  }
  return modes;
}
} // namespace amontons

#pragma once
#include "amontons/base/ids.h"
#include "amontons/surface/overlap_integrals.h"

#include <span>
#include <vector>

namespace amontons
{
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A target face that an impactor face sees.
struct SeenFace
{
  std::span<const Index> nodes;
  OverlapIntegrals integrals;
  double facing = 0; ///< minus the cosine between the faces' normals
};

/// What one impactor face adds to D and M (contact/mortar.h), over the part of it that sees the target.
///
/// Variables of the derivatives: those of OverlapIntegrals, first its n_own of the impactor, then two for each of
/// `targets`.
struct FaceCoupling
{
  std::vector<int> corners;   ///< that carry a multiplier; another stands in for one that hardly anything covers; -1:
                              ///< left out, for other faces round the node see the target better
  std::vector<Index> targets; ///< nodes seen, ascending
  bool whole = false;         ///< whether all of the face sees the target
  double facing = 0;          ///< mean of what is seen
  Eigen::VectorXd own;        ///< D, [n_corners]
  RowMatrix mortar;           ///< M, [n_corners x n_targets]
  RowMatrix own_gradient;     ///< [n_corners x n_variables], where asked for
  std::vector<RowMatrix> mortar_gradient; ///< [n_corners], each [n_targets x n_variables], where asked for
};

/// @param n_nodes, face_size of the impactor face @param seen at least one face, with overlaps that are not empty
FaceCoupling couple_face(int n_nodes, double face_size, std::span<const SeenFace> seen, bool with_gradient);
} // namespace amontons

#include "amontons/contact/mortar_gradients.h"

#include <algorithm>
#include <numbers>

namespace amontons
{
namespace
{
using Eigen::MatrixXd;
using Eigen::Vector3d;

/// Edges of the impactor sharper than this stay sharp where its normals are averaged.
constexpr double sharp_angle = std::numbers::pi / 6;
constexpr int n_own = OverlapIntegrals::n_own;

void sort_unique(std::vector<Index>::iterator begin, std::vector<Index> &nodes)
{
  std::sort(begin, nodes.end());
  nodes.erase(std::unique(begin, nodes.end()), nodes.end());
}

Eigen::Index find(std::span<const Index> nodes, Index node)
{
  return std::find(nodes.begin(), nodes.end(), node) - nodes.begin();
}

/// Columns of the components of `nodes` in a matrix that has those of `all` from column `first` on.
void add_columns(int dim, std::span<const Index> nodes, std::span<const Index> all, Eigen::Index first,
                 std::vector<Eigen::Index> &columns)
{
  for (const Index node : nodes)
    for (Eigen::Index c = 0, at = first + dim * find(all, node); c < dim; ++c)
      columns.push_back(at + c);
}
} // namespace

MortarNormals::MortarNormals(const PlacedSurface &impactor)
  : impactor_(impactor)
  , normals_(smoothed_normals(impactor.surface, impactor.x, sharp_angle))
{
}

Vector3d MortarNormals::at(Index f, int corner) const
{
  const int dim = impactor_.surface.dim;
  Vector3d out = Vector3d::Zero();
  const auto at = static_cast<std::size_t>(impactor_.surface.face_offsets[f] + corner) * dim;
  std::copy_n(normals_.begin() + static_cast<std::ptrdiff_t>(at), dim, out.data());
  return out;
}

NormalGradient MortarNormals::gradient(Index f, int corner) const
{
  return smoothed_normal_gradient(impactor_.surface, impactor_.x, sharp_angle, f,
                                  impactor_.surface.face_offsets[f] + corner);
}

MortarGradientAssembly::MortarGradientAssembly(const PlacedSurface &impactor, const MortarNormals &normals)
  : impactor_(impactor)
  , normals_(normals)
  , place_(static_cast<std::size_t>(impactor.surface.n_faces()), -1)
{
}

void MortarGradientAssembly::add(Index f, FaceCoupling coupling)
{
  place_[f] = static_cast<Index>(faces_.size());
  Face &face = faces_.emplace_back();
  face.coupling = std::move(coupling);
  const auto nodes = impactor_.surface.face(f);
  face.nodes.assign(nodes.begin(), nodes.end());
  if (impactor_.surface.dim == 3)
    set_variables_in_space(f, face);
  else
    set_variables_in_plane(f, face);
}

void MortarGradientAssembly::set_variables_in_space(Index f, Face &face) const
{
  const ProjectionPlane plane(gather_face(3, impactor_.surface.face(f), impactor_.x));
  const auto n = static_cast<Eigen::Index>(face.nodes.size());
  face.target.resize(2, 3);
  face.target << plane.base()[0].transpose(), plane.base()[1].transpose();
  face.own = RowMatrix::Zero(n_own, 3 * n);
  for (Eigen::Index i = 0; i < n; ++i)
    face.own.block<2, 3>(2 * i, 3 * i) = face.target;
  face.own.bottomRows<2>() = plane.tilt().leftCols(3 * n);
}

void MortarGradientAssembly::set_variables_in_plane(Index f, Face &face) const
{
  const auto ends = impactor_.surface.face(f);
  const std::array<NormalGradient, 2> normals{normals_.gradient(f, 0), normals_.gradient(f, 1)};
  for (const NormalGradient &normal : normals)
    face.nodes.insert(face.nodes.end(), normal.nodes.begin(), normal.nodes.end());
  sort_unique(face.nodes.begin(), face.nodes);
  face.target = Eigen::Matrix2d::Identity();
  face.own = RowMatrix::Zero(n_own, 2 * static_cast<Eigen::Index>(face.nodes.size()));
  for (std::size_t end = 0; end < 2; ++end)
  {
    const auto row = 2 * static_cast<Eigen::Index>(end);
    face.own.block<2, 2>(row, 2 * find(face.nodes, ends[end])).setIdentity();
    const auto &[around, gradient] = normals[end];
    for (std::size_t i = 0; i < around.size(); ++i)
      face.own.block<2, 2>(4 + row, 2 * find(face.nodes, around[i])) +=
          gradient.middleCols<2>(2 * static_cast<Eigen::Index>(i));
  }
}

std::vector<MortarGradientAssembly::Round> MortarGradientAssembly::faces_round(Index j) const
{
  std::vector<Round> out;
  for (const Index f : impactor_.surface.faces_of_node(j))
  {
    if (place_[f] < 0)
      continue;
    const Face &face = faces_[place_[f]];
    const auto nodes = impactor_.surface.face(f);
    for (std::size_t k = 0; k < face.coupling.corners.size(); ++k)
      if (const int corner = face.coupling.corners[k]; corner >= 0 && nodes[corner] == j)
        out.push_back({&face, k, normals_.at(f, corner), normals_.gradient(f, corner)});
  }
  return out;
}

// With sums over the faces D = sum own and M = sum mortar: d(M/D) = (dM - w dD)/D.
MatrixXd MortarGradientAssembly::weight_gradient(const std::vector<Round> &around, std::span<const Index> impactors,
                                                 const MortarCoupling &coupling, Index j) const
{
  const int dim = impactor_.surface.dim;
  const auto targets = coupling.targets_of(j);
  const auto n_targets = static_cast<Eigen::Index>(targets.size());
  const Eigen::Index first_target = dim * static_cast<Eigen::Index>(impactors.size());
  const Eigen::Map<const Eigen::VectorXd> weights(coupling.weights_of(j).data(), n_targets);
  // The rows of M, that of D below.
  RowMatrix sums = RowMatrix::Zero(n_targets + 1, first_target + dim * n_targets);
  std::vector<Eigen::Index> columns;
  for (const auto &[face, corner, normal, turning] : around)
  {
    const auto &seen = face->coupling.targets;
    columns.clear();
    add_columns(dim, face->nodes, impactors, 0, columns);
    add_columns(dim, seen, targets, first_target, columns);
    const auto n_seen = static_cast<Eigen::Index>(seen.size());
    RowMatrix rows(n_seen + 1, face->coupling.own_gradient.cols());
    rows << face->coupling.mortar_gradient[corner], face->coupling.own_gradient.row(static_cast<Eigen::Index>(corner));
    RowMatrix by(n_seen + 1, static_cast<Eigen::Index>(columns.size()));
    by.leftCols(face->own.cols()).noalias() = rows.leftCols<n_own>() * face->own;
    for (Eigen::Index t = 0; t < n_seen; ++t)
      by.middleCols(face->own.cols() + dim * t, dim).noalias() = rows.middleCols<2>(n_own + 2 * t) * face->target;
    for (Eigen::Index t = 0; t <= n_seen; ++t)
    {
      const Eigen::Index row = t == n_seen ? n_targets : find(targets, seen[static_cast<std::size_t>(t)]);
      for (std::size_t c = 0; c < columns.size(); ++c)
        sums(row, columns[c]) += by(t, static_cast<Eigen::Index>(c));
    }
  }
  return (sums.topRows(n_targets) - weights * sums.bottomRows<1>()) / coupling.area[j];
}

// Of the direction of sum own normal. The own of a face that is covered in part is a datum here.
MatrixXd MortarGradientAssembly::normal_gradient(const std::vector<Round> &around,
                                                 std::span<const Index> impactors) const
{
  const int dim = impactor_.surface.dim;
  MatrixXd change = MatrixXd::Zero(dim, dim * static_cast<Eigen::Index>(impactors.size()));
  Vector3d sum = Vector3d::Zero();
  const auto add = [&](std::span<const Index> nodes, const auto &by)
  {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      change.middleCols(dim * find(impactors, nodes[i]), dim) += by.middleCols(dim * static_cast<Eigen::Index>(i), dim);
  };
  for (const auto &[face, corner, normal, turning] : around)
  {
    const auto row = static_cast<Eigen::Index>(corner);
    const double own = face->coupling.own[row];
    sum -= own * normal;
    add(turning.nodes, MatrixXd(-own * turning.gradient));
    if (face->coupling.whole)
      add(face->nodes, MatrixXd(-normal.head(dim) * (face->coupling.own_gradient.row(row).head<n_own>() * face->own)));
  }
  const double length = sum.norm();
  const Eigen::VectorXd n = sum.head(dim) / length;
  return (change - n * (n.transpose() * change)) / length;
}

MortarGradients MortarGradientAssembly::gather(const MortarCoupling &coupling) const
{
  MortarGradients out;
  const Index n_nodes = impactor_.surface.n_nodes();
  out.normal.resize(static_cast<std::size_t>(n_nodes));
  out.weight.resize(static_cast<std::size_t>(n_nodes));
  for (Index j = 0; j < n_nodes; ++j)
  {
    out.offsets.push_back(static_cast<Index>(out.impactors.size()));
    if (!coupling.sees_target(j))
      continue;
    const auto around = faces_round(j);
    const auto first = static_cast<std::ptrdiff_t>(out.impactors.size());
    for (const Round &at : around)
      for (const std::vector<Index> *nodes : {&at.face->nodes, &at.turning.nodes})
        std::copy_if(nodes->begin(), nodes->end(), std::back_inserter(out.impactors), [&](Index i) { return i != j; });
    sort_unique(out.impactors.begin() + first, out.impactors);
    out.impactors.insert(out.impactors.begin() + first, j);
    const std::span<const Index> impactors(out.impactors.begin() + first, out.impactors.end());
    out.normal[j] = normal_gradient(around, impactors);
    out.weight[j] = weight_gradient(around, impactors, coupling, j);
  }
  out.offsets.push_back(static_cast<Index>(out.impactors.size()));
  return out;
}
} // namespace amontons

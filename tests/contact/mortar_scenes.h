#pragma once
#include "amontons/contact/mortar.h"
#include "cases.h"
#include "surface/surfaces.h"

#include <Eigen/Dense>

/// Two surfaces that see each other, and their coupling at any positions of their nodes.
namespace amontons::test
{
struct MortarScene
{
  Surface impactor, target;
  bool axisymmetric = false;
  double w = 0.5;

  [[nodiscard]] int dim() const { return impactor.dim; }
  [[nodiscard]] Eigen::Index n_own() const { return static_cast<Eigen::Index>(impactor.reference.size()); }
  /// Positions of the impactor's nodes, then of the target's.
  [[nodiscard]] Eigen::VectorXd positions() const
  {
    Eigen::VectorXd out(impactor.reference.size() + target.reference.size());
    std::copy(impactor.reference.begin(), impactor.reference.end(), out.begin());
    std::copy(target.reference.begin(), target.reference.end(), out.begin() + n_own());
    return out;
  }

  [[nodiscard]] MortarCoupling couple(const Eigen::VectorXd &x, const MortarScope &scope = {}) const
  {
    const std::span<const double> all(x.data(), static_cast<std::size_t>(x.size()));
    const auto n = static_cast<std::size_t>(n_own());
    const auto every_face = [&](const Eigen::AlignedBox3d &, std::vector<Index> &faces)
    {
      faces.resize(static_cast<std::size_t>(target.n_faces()));
      std::iota(faces.begin(), faces.end(), 0);
    };
    return couple_mortar({impactor, all.first(n)}, {target, all.subspan(n)}, axisymmetric, w, every_face, scope);
  }
};

/// Normals, [n impactor nodes x dim], and weights of all target nodes, [n impactor nodes x n target nodes].
struct DenseCoupling
{
  Eigen::MatrixXd normal, weight;

  DenseCoupling(const MortarScene &scene, const MortarCoupling &coupling)
    : normal(Eigen::MatrixXd::Zero(scene.impactor.n_nodes(), scene.dim()))
    , weight(Eigen::MatrixXd::Zero(scene.impactor.n_nodes(), scene.target.n_nodes()))
  {
    for (Index j = 0; j < scene.impactor.n_nodes(); ++j)
    {
      normal.row(j) = coupling.normal[j].head(scene.dim()).transpose();
      for (std::size_t k = 0; k < coupling.targets_of(j).size(); ++k)
        weight(j, coupling.targets_of(j)[k]) = coupling.weights_of(j)[k];
    }
  }
  DenseCoupling(Eigen::MatrixXd n, Eigen::MatrixXd w)
    : normal(std::move(n))
    , weight(std::move(w))
  {
  }
};

/// How normals and weights change along `direction`, from the gradients. @param coupling with them
inline DenseCoupling change_along(const MortarScene &scene, const MortarCoupling &coupling,
                                  const Eigen::VectorXd &direction)
{
  const int dim = scene.dim();
  const MortarGradients &gradients = coupling.gradients;
  DenseCoupling out(Eigen::MatrixXd::Zero(scene.impactor.n_nodes(), dim),
                    Eigen::MatrixXd::Zero(scene.impactor.n_nodes(), scene.target.n_nodes()));
  for (Index j = 0; j < scene.impactor.n_nodes(); ++j)
  {
    const auto impactors = gradients.impactors_of(j), targets = coupling.targets_of(j);
    if (impactors.empty())
      continue;
    Eigen::VectorXd moves(dim * (impactors.size() + targets.size()));
    Eigen::Index at = 0;
    for (const Index node : impactors)
      moves.segment(dim * at++, dim) = direction.segment(dim * node, dim);
    for (const Index node : targets)
      moves.segment(dim * at++, dim) = direction.segment(scene.n_own() + dim * node, dim);
    out.normal.row(j) = (gradients.normal[j] * moves.head(gradients.normal[j].cols())).transpose();
    const Eigen::VectorXd change = gradients.weight[j] * moves;
    for (std::size_t k = 0; k < targets.size(); ++k)
      out.weight(j, targets[k]) = change[static_cast<Eigen::Index>(k)];
  }
  return out;
}

/// The same by central differences of the coupling without gradients.
inline DenseCoupling difference_along(const MortarScene &scene, const Eigen::VectorXd &x,
                                      const Eigen::VectorXd &direction, double h)
{
  const DenseCoupling up(scene, scene.couple(x + h * direction)), down(scene, scene.couple(x - h * direction));
  return {(up.normal - down.normal) / (2 * h), (up.weight - down.weight) / (2 * h)};
}
} // namespace amontons::test

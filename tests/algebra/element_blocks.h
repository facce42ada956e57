#pragma once
#include "amontons/algebra/system_form.h"

#include <Eigen/Dense>

#include <cmath>
#include <random>

namespace amontons::test
{
constexpr double augmentation = 3.7;

/// The blocks of an augmented Lagrangian's element (THEORY.md section 2).
struct ElementBlocks
{
  Eigen::MatrixXd stiffness, force_by_multiplier, constraint_by_position, constraint_by_multiplier;
  [[nodiscard]] ConstraintValues values() const
  {
    return {stiffness, force_by_multiplier, constraint_by_position, constraint_by_multiplier, augmentation};
  }
};

/// Makes elements of each status, with random directions of gap and slip at the impactor node and their reaction shared
/// by the nodes of a face.
class ElementMaker
{
public:
  ElementMaker(int dim, int n_nodes, unsigned seed)
    : dim_(dim)
    , n_nodes_(n_nodes)
    , random_(seed)
  {
  }

  [[nodiscard]] int n() const { return dim_ * n_nodes_; }
  double number() { return std::uniform_real_distribution(-1., 1.)(random_); }
  Eigen::MatrixXd numbers(Eigen::Index rows, Eigen::Index cols)
  {
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return number(); });
  }

  /// @param by_sigma_n, by_sigma_t derivatives of the tangential force
  ElementBlocks blocks(const Eigen::VectorXd &by_sigma_n, const Eigen::MatrixXd &by_sigma_t)
  {
    const int m = dim_ - 1;
    const double r = augmentation;
    const Eigen::MatrixXd rows = directions(), normal = rows.topRows(1), tangents = rows.bottomRows(m);
    const Eigen::MatrixXd q = by_sigma_n * normal + by_sigma_t * tangents;
    ElementBlocks out = open();
    out.stiffness = r * (normal.transpose() * normal + tangents.transpose() * q);
    out.force_by_multiplier << normal.transpose() + tangents.transpose() * by_sigma_n,
        tangents.transpose() * by_sigma_t;
    out.constraint_by_position << normal, q;
    out.constraint_by_multiplier.setZero();
    out.constraint_by_multiplier.bottomLeftCorner(m, 1) = by_sigma_n / r;
    out.constraint_by_multiplier.bottomRightCorner(m, m) = (by_sigma_t - Eigen::MatrixXd::Identity(m, m)) / r;
    return out;
  }
  [[nodiscard]] ElementBlocks open() const
  {
    return {Eigen::MatrixXd::Zero(n(), n()), Eigen::MatrixXd::Zero(n(), dim_), Eigen::MatrixXd::Zero(dim_, n()),
            -Eigen::MatrixXd::Identity(dim_, dim_) / augmentation};
  }
  ElementBlocks stick()
  {
    return blocks(Eigen::VectorXd::Zero(dim_ - 1), Eigen::MatrixXd::Identity(dim_ - 1, dim_ - 1));
  }
  ElementBlocks frictionless()
  {
    return blocks(Eigen::VectorXd::Zero(dim_ - 1), Eigen::MatrixXd::Zero(dim_ - 1, dim_ - 1));
  }
  ElementBlocks slip(double mu, double k)
  {
    const Eigen::VectorXd s = numbers(dim_ - 1, 1).normalized();
    return blocks(-mu * s, k * (Eigen::MatrixXd::Identity(dim_ - 1, dim_ - 1) - s * s.transpose()));
  }

private:
  Eigen::MatrixXd directions()
  {
    const Eigen::MatrixXd frame = Eigen::HouseholderQR<Eigen::MatrixXd>(numbers(dim_, dim_)).householderQ();
    Eigen::MatrixXd out(dim_, n());
    for (int node = 0; node < n_nodes_; ++node)
      out.middleCols(node * dim_, dim_) = frame * (node == 0 ? 1. : -1. / (n_nodes_ - 1));
    return out;
  }

  int dim_, n_nodes_;
  std::mt19937 random_;
};
} // namespace amontons::test

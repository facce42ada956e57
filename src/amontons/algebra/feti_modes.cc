#include "amontons/algebra/feti_dual.h"

#include <Eigen/LU>

#include <algorithm>

/// FetiDual with held modes.
namespace amontons
{
void FetiDual::set_modes(const std::vector<std::vector<double>> &modes)
{
  modes_ = modes;
  mode_loads_.clear();
  free_motions_.clear();
  for (const std::vector<double> &mode : modes_)
    mode_loads_.push_back(kernel_loads(condense(mode)));
  if (!singular_)
    return;
  for (Eigen::Index k = 0; k < coarse_->free_motions().cols(); ++k)
  {
    const Eigen::VectorXd alpha = coarse_->free_motions().col(k);
    std::vector<double> v(static_cast<std::size_t>(n_columns()), 0.0);
    kernel_.expand_add({alpha.data(), static_cast<std::size_t>(alpha.size())}, v);
    std::fill(local_.begin(), local_.end(), 0.0);
    free_motions_.push_back(expand(v));
  }
}

/// Of each mode (row) with each of these vectors over the unknowns (column).
Eigen::MatrixXd FetiDual::mode_products(const std::vector<std::span<const double>> &vectors) const
{
  const auto view = [](std::span<const double> x)
  { return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())); };
  Eigen::MatrixXd out(modes_.size(), vectors.size());
  for (std::size_t k = 0; k < modes_.size(); ++k)
  {
    std::vector<double> own = modes_[k]; // each unknown counts once
    for (std::size_t i = 0; i < own.size(); ++i)
      if (!layout_.sharing().is_own(static_cast<Index>(i)))
        own[i] = 0;
    for (std::size_t j = 0; j < vectors.size(); ++j)
      out(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j)) = view(own).dot(view(vectors[j]));
  }
  processes_.sum_over_processes({out.data(), static_cast<std::size_t>(out.size())});
  return out;
}

/// Motions that nothing holds: the modes bear what load there is along them, and fix the motion.
FetiStep FetiDual::solve_free(std::vector<double> forces, std::span<const double> row_gaps,
                              std::span<const double> motions, double reduction, double target)
{
  const auto n = static_cast<Eigen::Index>(modes_.size());
  const Eigen::MatrixXd &resist = coarse(true).free_motions();
  Eigen::MatrixXd loads(kernel_.size(), n);
  for (Eigen::Index k = 0; k < n; ++k)
    loads.col(k) = Eigen::Map<const Eigen::VectorXd>(mode_loads_[k].data(), kernel_.size());
  const std::vector<double> own_loads = kernel_loads(condense(forces));
  const Eigen::Map<const Eigen::VectorXd> load(own_loads.data(), kernel_.size());
  const Eigen::VectorXd reactions = (resist.transpose() * loads).fullPivLu().solve(resist.transpose() * load);
  for (Eigen::Index k = 0; k < n; ++k)
    for (std::size_t i = 0; i < forces.size(); ++i)
      forces[i] -= reactions[k] * modes_[k][i];
  FetiStep step = solve_regular(forces, row_gaps, reduction, target);
  std::vector<std::span<const double>> vectors(free_motions_.begin(), free_motions_.end());
  vectors.emplace_back(step.unknowns);
  const Eigen::MatrixXd products = mode_products(vectors);
  const Eigen::VectorXd present = products.col(n), asked = Eigen::Map<const Eigen::VectorXd>(motions.data(), n);
  const Eigen::VectorXd beta = products.leftCols(n).fullPivLu().solve(asked - present);
  for (Eigen::Index j = 0; j < n; ++j)
    for (std::size_t i = 0; i < step.unknowns.size(); ++i)
      step.unknowns[i] += beta[j] * free_motions_[j][i];
  step.modes.assign(reactions.data(), reactions.data() + n);
  return step;
}

/// Modes held where nothing is free: by the Schur complement of their rows.
FetiStep FetiDual::solve_bordered(std::span<const double> forces, std::span<const double> row_gaps,
                                  std::span<const double> motions, double reduction, double target)
{
  const auto n = static_cast<Eigen::Index>(modes_.size());
  FetiStep step = solve_regular(forces, row_gaps, reduction, target);
  std::vector<FetiStep> of_mode;
  const std::vector<double> none(row_gaps.size(), 0.0);
  for (const std::vector<double> &mode : modes_)
    of_mode.push_back(solve_regular(mode, none, reduction, 0));
  std::vector<std::span<const double>> vectors;
  for (const FetiStep &by_mode : of_mode)
    vectors.emplace_back(by_mode.unknowns);
  vectors.emplace_back(step.unknowns);
  const Eigen::MatrixXd products = mode_products(vectors);
  const Eigen::VectorXd excess = products.col(n) - Eigen::Map<const Eigen::VectorXd>(motions.data(), n);
  const Eigen::VectorXd reactions = products.leftCols(n).fullPivLu().solve(excess);
  for (Eigen::Index j = 0; j < n; ++j)
  {
    for (std::size_t i = 0; i < step.unknowns.size(); ++i)
      step.unknowns[i] -= reactions[j] * of_mode[j].unknowns[i];
    for (std::size_t i = 0; i < step.rows.size(); ++i)
      step.rows[i] -= reactions[j] * of_mode[j].rows[i];
  }
  step.modes.assign(reactions.data(), reactions.data() + n);
  return step;
}

FetiStep FetiDual::solve(std::span<const double> forces, std::span<const double> row_gaps,
                         std::span<const double> motions, double reduction, double target)
{
  if (modes_.empty())
    return solve_regular(forces, row_gaps, reduction, target);
  if (singular_)
    return solve_free({forces.begin(), forces.end()}, row_gaps, motions, reduction, target);
  return solve_bordered(forces, row_gaps, motions, reduction, target);
}
} // namespace amontons

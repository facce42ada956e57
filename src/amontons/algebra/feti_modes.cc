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
  {
    mode_loads_.emplace_back(static_cast<std::size_t>(kernel_.size()));
    kernel_.restrict(condense(mode), mode_loads_.back());
  }
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

/// Motions that nothing holds: the modes bear what load there is along them, and fix the motion.
FetiStep FetiDual::solve_free(std::vector<double> forces, std::span<const double> row_gaps,
                              std::span<const double> motions, double reduction, double target)
{
  const auto n = static_cast<Eigen::Index>(modes_.size());
  const Eigen::MatrixXd &resist = coarse(true).free_motions();
  Eigen::MatrixXd loads(kernel_.size(), n), shown(n, n);
  for (Eigen::Index k = 0; k < n; ++k)
    loads.col(k) = Eigen::Map<const Eigen::VectorXd>(mode_loads_[k].data(), kernel_.size());
  Eigen::VectorXd load(kernel_.size());
  kernel_.restrict(condense(forces), {load.data(), static_cast<std::size_t>(load.size())});
  const Eigen::VectorXd reactions = (resist.transpose() * loads).fullPivLu().solve(resist.transpose() * load);
  for (Eigen::Index k = 0; k < n; ++k)
    for (std::size_t i = 0; i < forces.size(); ++i)
      forces[i] -= reactions[k] * modes_[k][i];
  FetiStep step = solve_regular(forces, row_gaps, reduction, target);
  const auto vector = [](const std::vector<double> &x)
  { return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())); };
  Eigen::VectorXd missing(n);
  for (Eigen::Index k = 0; k < n; ++k)
  {
    missing[k] = motions[k] - vector(modes_[k]).dot(vector(step.unknowns));
    for (Eigen::Index j = 0; j < n; ++j)
      shown(k, j) = vector(modes_[k]).dot(vector(free_motions_[j]));
  }
  const Eigen::VectorXd beta = shown.fullPivLu().solve(missing);
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
  const auto vector = [](const std::vector<double> &x)
  { return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())); };
  Eigen::MatrixXd schur(n, n);
  Eigen::VectorXd excess(n);
  for (Eigen::Index k = 0; k < n; ++k)
  {
    excess[k] = vector(modes_[k]).dot(vector(step.unknowns)) - motions[k];
    for (Eigen::Index j = 0; j < n; ++j)
      schur(k, j) = vector(modes_[k]).dot(vector(of_mode[j].unknowns));
  }
  const Eigen::VectorXd reactions = schur.fullPivLu().solve(excess);
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

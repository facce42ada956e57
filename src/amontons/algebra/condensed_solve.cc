#include "amontons/algebra/condensed_form.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

/// Solution of the reduced system, from the whole right side to the whole solution.
namespace amontons
{
/// W^T forces (or T^T), over the rows of the reduced matrix. Every unknown's part is counted by its owner.
std::vector<double> CondensedForm::reduced(std::span<const double> of_unknowns, Side side) const
{
  const Sharing &unknowns = layout_.sharing();
  std::vector<double> out(static_cast<std::size_t>(matrix_.blocks().n_rows()), 0.0);
  for (Index i = 0; i < unknowns.size(); ++i)
    if (unknowns.is_own(i) && !elimination_.is_slave(i))
      out[matrix_.blocks().row(i)] = of_unknowns[i];
  for (const Index slave : elimination_.slaves())
    if (unknowns.is_own(slave))
      for (const auto &[row, coefficient] :
           side == Side::motion ? elimination_.motion(slave) : elimination_.weights(slave))
        out[row] += coefficient * of_unknowns[slave];
  matrix_.blocks().sharing().sum(out, matrix_.blocks().block_size());
  return out;
}

/// motion += T x
void CondensedForm::expand(std::span<const double> x, std::span<double> motion) const
{
  for (Index i = 0; i < layout_.n_displacement_unknowns(); ++i)
    if (!elimination_.is_slave(i))
      motion[i] += x[matrix_.blocks().row(i)];
  for (const Index slave : elimination_.slaves())
    for (const auto &[row, coefficient] : elimination_.motion(slave))
      motion[slave] += coefficient * x[row];
}

double CondensedForm::reduced_dot(std::span<const double> a, std::span<const double> b) const
{
  return matrix_.blocks().sharing().dot(a, b, matrix_.blocks().block_size());
}

Eigen::VectorXd CondensedForm::at_pins(std::span<const double> reduced) const
{
  Eigen::VectorXd out(static_cast<Eigen::Index>(pins_.size()));
  for (Eigen::Index m = 0; m < out.size(); ++m)
    out[m] = pins_[m] < 0 ? 0 : reduced[pins_[m]];
  layout_.sharing().sum_over_processes({out.data(), pins_.size()});
  return out;
}

std::vector<double> CondensedForm::solve_reduced(std::span<const double> forces, double tolerance)
{
  std::vector<double> x(forces.size());
  solver_->solve(forces, x, tolerance);
  return x;
}

/// [A a; b^T 0] [x; z] = [f; c] with a = W^T m, b = T^T m, c = -m . offset for the modes m; w the pinned motions:
///     x = X_f + alpha X_P w - X_a z,   w = P^T x,   b^T x = c,   X = (A + alpha P P^T)^-1.
std::vector<double> CondensedForm::solve_bordered(std::span<const double> forces, std::span<const double> offset,
                                                  double tolerance)
{
  const auto k = static_cast<Eigen::Index>(modes_.size());
  const double alpha = matrix_.pin_stiffness();
  std::vector<double> x = solve_reduced(reduced(forces), tolerance);
  std::vector<std::vector<double>> by_pin, by_mode, b;
  for (Eigen::Index m = 0; m < k; ++m)
  {
    std::vector<double> pinned(x.size(), 0.0);
    if (pins_[m] >= 0)
      pinned[pins_[m]] = alpha;
    by_pin.push_back(solve_reduced(pinned, 0));
    by_mode.push_back(solve_reduced(reduced(modes_[m]), 0));
    b.push_back(reduced(modes_[m], Side::motion));
  }
  Eigen::MatrixXd small = Eigen::MatrixXd::Zero(2 * k, 2 * k);
  Eigen::VectorXd right(2 * k);
  right.head(k) = at_pins(x);
  for (Eigen::Index j = 0; j < k; ++j)
  {
    small.col(j).head(k) = Eigen::VectorXd::Unit(k, j) - at_pins(by_pin[j]);
    small.col(k + j).head(k) = at_pins(by_mode[j]);
    for (Eigen::Index i = 0; i < k; ++i)
    {
      small(k + i, j) = reduced_dot(b[i], by_pin[j]);
      small(k + i, k + j) = -reduced_dot(b[i], by_mode[j]);
    }
    right[k + j] = -layout_.sharing().dot(modes_[j], offset) - reduced_dot(b[j], x);
  }
  const Eigen::VectorXd solution = small.fullPivLu().solve(right);
  for (Eigen::Index m = 0; m < k; ++m)
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] += solution[m] * by_pin[m][i] - solution[k + m] * by_mode[m][i];
  mode_reactions_.assign(solution.data() + k, solution.data() + 2 * k);
  return x;
}

Eigen::VectorXd CondensedForm::of_multipliers(std::size_t constraint, std::span<const double> unknowns) const
{
  const ConstraintPattern &pattern = patterns_[constraint];
  Eigen::VectorXd out(pattern.n_multipliers);
  for (int m = 0; m < pattern.n_multipliers; ++m)
    out[m] = unknowns[layout_.multiplier(pattern.multipliers[m])];
  return out;
}

CondensedForm::RightSide CondensedForm::make_right_side(std::span<const double> rhs) const
{
  const Sharing &unknowns = layout_.sharing();
  RightSide out;
  out.forces.assign(static_cast<std::size_t>(unknowns.size()), 0.0);
  for (Index i = 0; i < unknowns.size(); ++i)
    if (unknowns.is_own(i))
    {
      out.forces[i] = rhs[i];
      out.size2 += rhs[i] * rhs[i];
    }
  for (std::size_t k = 0; k < rows_.size(); ++k)
  {
    const Eigen::VectorXd rl = of_multipliers(k, rhs), force = rows_[k].right_side_force * rl,
                          gap = rows_[k].row_right_side * rl;
    out.size2 += (augmentation_[k] * rl).squaredNorm();
    for (int a = 0; a < patterns_[k].n_nodal(); ++a)
      for (const Term &term : layout_.terms(patterns_[k].nodal[a]))
        out.forces[term.unknown] -= term.coefficient * force[a];
    out.of_rows.insert(out.of_rows.end(), gap.data(), gap.data() + gap.size());
  }
  unknowns.sum(out.forces);
  unknowns.sum_over_processes({&out.size2, 1});
  return out;
}

/// @param reactions of the constraint rows @param solution has the displacements, gets the multipliers
void CondensedForm::find_multipliers(std::span<const double> rhs, std::span<const double> reactions,
                                     std::span<double> solution) const
{
  const double *row = reactions.data();
  for (std::size_t k = 0; k < rows_.size(); ++k)
  {
    Eigen::VectorXd du = Eigen::VectorXd::Zero(patterns_[k].n_nodal());
    for (int a = 0; a < patterns_[k].n_nodal(); ++a)
      for (const Term &term : layout_.terms(patterns_[k].nodal[a]))
        du[a] += term.coefficient * solution[term.unknown];
    const Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(row, rows_[k].n_rows());
    const Eigen::VectorXd step = rows_[k].multiplier_by_row * y +
                                 rows_[k].multiplier_by_right_side * of_multipliers(k, rhs) +
                                 rows_[k].multiplier_by_position * du;
    for (int m = 0; m < patterns_[k].n_multipliers; ++m)
      solution[layout_.multiplier(patterns_[k].multipliers[m])] = step[m];
    row += rows_[k].n_rows();
  }
}

void CondensedForm::solve(std::span<const double> rhs, std::span<double> solution, double tolerance)
{
  const Sharing &unknowns = layout_.sharing();
  const RightSide right_side = make_right_side(rhs);
  const std::vector<double> &forces = right_side.forces;
  const auto n = forces.size();
  const std::vector<double> offset = elimination_.offset(unknowns, right_side.of_rows);
  std::vector<double> resisted = matrix_.multiply(offset);
  for (std::size_t i = 0; i < n; ++i)
    resisted[i] = forces[i] - resisted[i];
  const double absolute = tolerance * std::sqrt(right_side.size2);
  mode_reactions_.clear();
  const std::vector<double> x =
      modes_.empty() ? solve_reduced(reduced(resisted), absolute) : solve_bordered(resisted, offset, absolute);
  std::vector<double> motion = offset;
  expand(x, motion);

  // The slaves' own equilibrium gives the reactions of the rows.
  resisted = matrix_.multiply(motion);
  for (std::size_t m = 0; m < modes_.size(); ++m)
    for (std::size_t i = 0; i < n; ++i)
      resisted[i] += modes_[m][i] * mode_reactions_[m];
  for (std::size_t i = 0; i < n; ++i)
    resisted[i] = forces[i] - resisted[i];
  std::copy(motion.begin(), motion.end(), solution.begin());
  find_multipliers(rhs, elimination_.reactions(unknowns, resisted), solution);
}
} // namespace amontons

#pragma once
#include "amontons/contact/linearisation.h"

namespace amontons
{
enum class ContactStatus : unsigned char
{
  open,
  stick,
  slip
};

/// Multipliers of one contact node: nodal forces (axisymmetry: over the whole ring). lambda_n < 0 in compression; the
/// tangential ones along e_1, e_2 of the linearisation's frame.
struct Multipliers
{
  double normal = 0;
  std::array<double, max_tangents> tangential{0, 0};
};

/// Multipliers first: (lambda_n, lambda_t1[, lambda_t2]).
inline constexpr int max_multipliers = 1 + max_tangents;

/// Residual and tangent of the augmented Lagrangian of one contact element (Alart, Curnier 1991; THEORY.md section 2).
struct ContactElement
{
  ContactStatus status = ContactStatus::open;
  ContactVector force;                                                        ///< F_x
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_multipliers, 1> constraint; ///< F_lambda
  ContactMatrix stiffness;                                                    ///< dF_x/dx
  /// dF_x/dlambda, [n_dofs x n_multipliers]
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Eigen::Dynamic, max_multipliers> force_by_multiplier;
  /// dF_lambda/dx, [n_multipliers x n_dofs]
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_multipliers, Eigen::Dynamic> constraint_by_position;
  /// dF_lambda/dlambda, [n_multipliers x n_multipliers]
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_multipliers, max_multipliers> constraint_by_multiplier;
};

/// The status that sigma = lambda + r g decides (THEORY.md section 2's table).
/// @param mu Coulomb's coefficient; with mu = 0 a closed node is in slip.
ContactStatus contact_status(const ContactLinearisation &linearisation, const Multipliers &lambda, double mu, double r);

/// The element at a given status (by default the one that sigma decides; a solver may hold another for an iteration).
ContactElement contact_element(const ContactLinearisation &linearisation, const Multipliers &lambda, double mu,
                               double r, ContactStatus status);
} // namespace amontons

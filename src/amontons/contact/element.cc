#include "amontons/contact/element.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace amontons
{
namespace
{
/// In the plane the second component is zero and plays no part.
using TangentVector = Eigen::Matrix<double, max_tangents, 1>;
using TangentMatrix = Eigen::Matrix<double, max_tangents, max_tangents>;

/// sigma = lambda + r g
struct AugmentedMultipliers
{
  double normal;
  TangentVector tangential;
};

AugmentedMultipliers augmented(const ContactLinearisation &lin, const Multipliers &lambda, double r)
{
  AugmentedMultipliers sigma{lambda.normal + r * lin.gap, TangentVector::Zero()};
  for (int c = 0; c < lin.n_tangents(); ++c)
    sigma.tangential[c] = lambda.tangential[c] + r * lin.slip[c];
  return sigma;
}

/// The tangential force q: sigma_t or its projection on Coulomb's disc, with its derivatives.
struct TangentialForce
{
  TangentVector value;
  TangentVector constraint; ///< F_lambda_t = (q - lambda_t)/r; in stick g_t itself, free of cancellation
  TangentVector by_sigma_n;
  TangentMatrix by_sigma_t;
};

TangentialForce sticking_force(const AugmentedMultipliers &sigma, const ContactLinearisation &lin)
{
  return {sigma.tangential, Eigen::Map<const TangentVector>(lin.slip.data()), TangentVector::Zero(),
          TangentMatrix::Identity()};
}

/// -mu sigma_n s, and zero without friction, without pressure, or where sigma_t has no direction.
TangentialForce slipping_force(const AugmentedMultipliers &sigma, const Multipliers &lambda, double mu, double r)
{
  const Eigen::Map<const TangentVector> lambda_t(lambda.tangential.data());
  const double radius = mu * std::max(-sigma.normal, 0.);
  const double length = sigma.tangential.norm();
  if (radius == 0 || length <= std::numeric_limits<double>::epsilon() * radius)
    return {TangentVector::Zero(), -lambda_t / r, TangentVector::Zero(), TangentMatrix::Zero()};
  const TangentVector s = sigma.tangential / length;
  return {radius * s, (radius * s - lambda_t) / r, -mu * s,
          radius / length * (TangentMatrix::Identity() - s * s.transpose())};
}

ContactElement zero_element(ContactStatus status, int n_dofs, int n_multipliers)
{
  ContactElement element;
  element.status = status;
  element.force.setZero(n_dofs);
  element.constraint.setZero(n_multipliers);
  element.stiffness.setZero(n_dofs, n_dofs);
  element.force_by_multiplier.setZero(n_dofs, n_multipliers);
  element.constraint_by_position.setZero(n_multipliers, n_dofs);
  element.constraint_by_multiplier.setZero(n_multipliers, n_multipliers);
  return element;
}

void add_normal(ContactElement &element, const ContactLinearisation &lin, double sigma_n, double r)
{
  element.force = sigma_n * lin.gap_direction;
  if (lin.gap_direction_gradient.size() > 0)
    element.stiffness = sigma_n * lin.gap_direction_gradient;
  element.stiffness.noalias() += r * lin.gap_direction * lin.gap_gradient.transpose();
  element.force_by_multiplier.col(0) = lin.gap_direction;
  element.constraint[0] = lin.gap;
  element.constraint_by_position.row(0) = lin.gap_gradient.transpose();
}

/// F_x += q_c d_c and F_lambda_t, with d_c the slip directions: one expression for both statuses.
void add_tangential(ContactElement &element, const ContactLinearisation &lin, const TangentialForce &q, double r)
{
  for (int c = 0; c < lin.n_tangents(); ++c)
  {
    ContactVector gradient = r * q.by_sigma_n[c] * lin.gap_gradient;
    for (int e = 0; e < lin.n_tangents(); ++e)
      gradient += r * q.by_sigma_t(c, e) * lin.slip_gradient[e];
    element.force += q.value[c] * lin.slip_direction[c];
    if (lin.slip_direction_gradient[c].size() > 0)
      element.stiffness += q.value[c] * lin.slip_direction_gradient[c];
    element.stiffness.noalias() += lin.slip_direction[c] * gradient.transpose();
    element.force_by_multiplier.col(0) += q.by_sigma_n[c] * lin.slip_direction[c];
    element.constraint[1 + c] = q.constraint[c];
    element.constraint_by_position.row(1 + c) = gradient.transpose() / r;
    element.constraint_by_multiplier(1 + c, 0) = q.by_sigma_n[c] / r;
    for (int e = 0; e < lin.n_tangents(); ++e)
    {
      element.force_by_multiplier.col(1 + e) += q.by_sigma_t(c, e) * lin.slip_direction[c];
      element.constraint_by_multiplier(1 + c, 1 + e) = (q.by_sigma_t(c, e) - (c == e ? 1. : 0.)) / r;
    }
  }
}
} // namespace

ContactStatus contact_status(const ContactLinearisation &linearisation, const Multipliers &lambda, double mu, double r)
{
  const AugmentedMultipliers sigma = augmented(linearisation, lambda, r);
  if (sigma.normal > 0)
    return ContactStatus::open;
  if (mu > 0 && sigma.tangential.norm() <= -mu * sigma.normal)
    return ContactStatus::stick;
  return ContactStatus::slip;
}

ContactElement contact_element(const ContactLinearisation &linearisation, const Multipliers &lambda, double mu,
                               double r, ContactStatus status)
{
  const int n_multipliers = 1 + linearisation.n_tangents();
  ContactElement element = zero_element(status, linearisation.n_dofs(), n_multipliers);
  if (status == ContactStatus::open)
  {
    element.constraint[0] = -lambda.normal / r;
    for (int c = 1; c < n_multipliers; ++c)
      element.constraint[c] = -lambda.tangential[c - 1] / r;
    element.constraint_by_multiplier.diagonal().setConstant(-1 / r);
    return element;
  }
  const AugmentedMultipliers sigma = augmented(linearisation, lambda, r);
  add_normal(element, linearisation, sigma.normal, r);
  const bool sticks = status == ContactStatus::stick;
  add_tangential(element, linearisation,
                 sticks ? sticking_force(sigma, linearisation) : slipping_force(sigma, lambda, mu, r), r);
  return element;
}
} // namespace amontons

#pragma once
#include "amontons/contact/element.h"

namespace amontons
{
/// A tangential multiplier expressed in the frame of another face: the tangent plane is turned onto the new one by the
/// least rotation, so that its length, and with it the status, stays as it was. In the plane nothing changes.
/// @param tangential components along `tangent_from`
/// @param normal_from, tangent_from frame in which `tangential` was found, as in ContactLinearisation
/// @param to the node's linearisation against the new face
/// @return components along `to.tangent`
std::array<double, max_tangents> carry_tangential(const std::array<double, max_tangents> &tangential,
                                                  const Eigen::Vector3d &normal_from,
                                                  const std::array<Eigen::Vector3d, max_tangents> &tangent_from,
                                                  const ContactLinearisation &to);
} // namespace amontons

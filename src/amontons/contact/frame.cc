#include "amontons/contact/frame.h"

namespace amontons
{
namespace
{
/// The least rotation that takes the unit vector a to b, applied to v (Rodrigues). For b = -a the half turn about an
/// axis normal to a.
Eigen::Vector3d turned(const Eigen::Vector3d &v, const Eigen::Vector3d &a, const Eigen::Vector3d &b)
{
  const double cosine = a.dot(b);
  if (cosine < -1 + 1e-12)
  {
    const Eigen::Vector3d axis = a.unitOrthogonal();
    return 2 * axis.dot(v) * axis - v;
  }
  const Eigen::Vector3d w = a.cross(b);
  return v + w.cross(v) + w.cross(w.cross(v)) / (1 + cosine);
}
} // namespace

std::array<double, max_tangents> carry_tangential(const std::array<double, max_tangents> &tangential,
                                                  const Eigen::Vector3d &normal_from,
                                                  const std::array<Eigen::Vector3d, max_tangents> &tangent_from,
                                                  const ContactLinearisation &to)
{
  if (to.dim == 2)
    return tangential;
  const Eigen::Vector3d force =
      turned(tangential[0] * tangent_from[0] + tangential[1] * tangent_from[1], normal_from, to.normal);
  return {force.dot(to.tangent[0]), force.dot(to.tangent[1])};
}
} // namespace amontons

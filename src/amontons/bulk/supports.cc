#include "amontons/bulk/supports.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace amontons
{
namespace
{
std::string text(double value)
{
  std::ostringstream out;
  out << value;
  return out.str();
}
} // namespace

const Group &boundary_group(const Mesh &mesh, const std::vector<BodyOptions> &bodies, const BoundaryOptions &entry)
{
  if (!mesh.groups.contains(entry.region))
    for (const BodyOptions &body : bodies)
      if (body.name == entry.region && !body.region.empty())
        return find_group(mesh, body.region, -1, entry.where);
  return find_group(mesh, entry.region, -1, entry.where);
}

Supports::Supports(const Mesh &mesh, Kinematics kinematics, const std::vector<BodyOptions> &bodies,
                   const std::vector<BoundaryOptions> &boundary, const RigidBodies &rigid, double end)
  : mesh_(mesh)
{
  std::vector<char> is_rigid(static_cast<std::size_t>(mesh.n_nodes()), 0);
  for (const RigidBody &body : rigid.bodies())
    if (!body.shape)
      for (const Index node : body.nodes)
        is_rigid[node] = 1;

  for (std::size_t e = 0; e < boundary.size(); ++e)
    if ((!boundary[e].fix.empty() || !boundary[e].displacement.empty()) && !rigid.concerns(boundary[e]))
      add_entry(static_cast<int>(e), boundary[e], boundary_group(mesh, bodies, boundary[e]), is_rigid);
  merge(boundary, end);

  if (kinematics != Kinematics::axisymmetric)
    return;
  std::vector<char> has(static_cast<std::size_t>(mesh.n_nodes()), 0);
  for (const HeldComponent &held : held_)
    if (held.nodal % 2 == 0)
      has[held.nodal / 2] = 1;
  for (Index node = 0; node < mesh.n_nodes(); ++node)
    if (!has[node] && !is_rigid[node] &&
        mesh.points[2 * node] == 0) // the reader puts on it what is there but for round-off
      held_.push_back({2 * node, -1, -1});
  std::sort(held_.begin(), held_.end(), [](const auto &a, const auto &b) { return a.nodal < b.nodal; });
}

void Supports::add_entry(int entry, const BoundaryOptions &options, const Group &group,
                         const std::vector<char> &is_rigid)
{
  std::vector<std::pair<int, int>> components; // component, function
  for (const int component : options.fix)
    components.emplace_back(component, -1);
  for (const auto &[component, expression] : options.displacement)
  {
    components.emplace_back(component, static_cast<int>(functions_.size()));
    functions_.emplace_back(expression);
  }
  for (const Index node : group.nodes())
  {
    if (is_rigid[node])
      throw UserError(options.where, "region '" + options.region +
                                         "' has nodes of a rigid body; name the rigid body itself to move it");
    for (const auto &[component, function] : components)
      held_.push_back({node * mesh_.dim + component, function, entry});
  }
}

void Supports::merge(const std::vector<BoundaryOptions> &boundary, double end)
{
  std::stable_sort(held_.begin(), held_.end(), [](const auto &a, const auto &b) { return a.nodal < b.nodal; });
  // Expressions of coordinates that cancel leave round-off of the coordinates' size.
  double round_off = 0;
  for (const double x : mesh_.points)
    round_off = std::max(round_off, 1e-14 * std::abs(x));
  std::vector<HeldComponent> merged;
  for (const HeldComponent &held : held_)
  {
    if (merged.empty() || merged.back().nodal != held.nodal)
    {
      merged.push_back(held);
      continue;
    }
    const HeldComponent &first = merged.back();
    for (const double time : {0.0, 0.37 * end, end})
    {
      const double a = value(first, time), b = value(held, time);
      if (std::abs(a - b) > 1e-12 * std::max(std::abs(a), std::abs(b)) + round_off)
        throw UserError(boundary[held.entry].where,
                        "conflicting boundary conditions: component " + std::string(1, "xyz"[held.nodal % mesh_.dim]) +
                            " of node " + std::to_string(mesh_.node_tags[held.nodal / mesh_.dim]) + " is moved by " +
                            text(a) + " through region '" + boundary[first.entry].region + "' and by " + text(b) +
                            " through region '" + boundary[held.entry].region + "' at t = " + text(time));
    }
  }
  held_ = std::move(merged);
}

double Supports::value(const HeldComponent &held, double time) const
{
  if (held.function < 0)
    return 0;
  const Index node = held.nodal / mesh_.dim;
  std::array<double, 3> point{0, 0, 0};
  for (int c = 0; c < mesh_.dim; ++c)
    point[c] = mesh_.points[static_cast<std::size_t>(node) * mesh_.dim + c];
  return functions_[held.function](time, point);
}
} // namespace amontons

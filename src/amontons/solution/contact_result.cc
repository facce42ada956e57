#include "amontons/solution/contact_interface.h"

#include <algorithm>
#include <array>
#include <limits>

namespace amontons
{
namespace
{
ContactResult empty_result(const std::string &name, const ContactSurfaces &surfaces, std::span<const double> areas)
{
  const Surface &impactor = surfaces.impactor;
  const auto n = static_cast<std::size_t>(impactor.n_nodes());
  const auto dim = static_cast<std::size_t>(impactor.dim);
  ContactResult out;
  out.name = name;
  out.impactor = &impactor;
  out.nodes = surfaces.nodes;
  out.n_own = out.n_nodes = surfaces.n_own;
  out.dim = impactor.dim;
  out.gap.assign(n, std::numeric_limits<double>::infinity());
  out.pressure.assign(n, 0);
  out.traction.assign(n * (dim - 1), 0);
  out.slip.assign(n * (dim - 1), 0);
  out.status.assign(n, ContactStatus::open);
  out.force.assign(n * dim, 0);
  out.area.assign(areas.begin(), areas.end());
  out.area.resize(n, 0);
  out.min_gap = std::numeric_limits<double>::infinity();
  return out;
}

/// Pressure, traction and force of a closed node, and its share in the sums.
void add_closed_node(ContactResult &out, Index i, const ContactLinearisation &now, const Multipliers &lambda)
{
  ++out.n_active;
  ++(out.status[i] == ContactStatus::stick ? out.n_stick : out.n_slip);
  out.pressure[i] = -lambda.normal / out.area[i];
  out.max_pressure = std::max(out.max_pressure, out.pressure[i]);
  out.contact_area += out.area[i];
  for (int a = 0; a < now.n_tangents(); ++a)
    out.traction[i * now.n_tangents() + a] = -lambda.tangential[a] / out.area[i];
  for (int c = 0; c < out.dim; ++c)
  {
    const double normal = -lambda.normal * now.gap_direction[c];
    double tangential = 0;
    for (int a = 0; a < now.n_tangents(); ++a)
      tangential -= lambda.tangential[a] * now.slip_direction[a][c];
    out.normal_force[c] += normal;
    out.tangential_force[c] += tangential;
    out.force[i * out.dim + c] = normal + tangential;
  }
}
} // namespace

ContactResult ContactInterface::result(std::span<const double> displacement, std::span<const double> start,
                                       std::span<const double> multipliers)
{
  move_to(displacement);
  ContactResult out = empty_result(options_.name, surfaces_, covered_areas());
  const int n_tangents = dim_ - 1;
  for (Index i = 0; i < n_nodes(); ++i)
  {
    if (!paired(i))
      continue;
    const ContactLinearisation now = linearise(i, displacement, start);
    const double *values = multipliers.data() + multiplier(i);
    const Multipliers lambda{values[0], {values[1], n_tangents > 1 ? values[2] : 0}};
    out.gap[i] = now.gap;
    out.min_gap = std::min(out.min_gap, now.gap);
    out.status[i] = status(i, now, lambda);
    if (out.status[i] == ContactStatus::open)
      continue;
    add_closed_node(out, i, now, lambda);
    for (int a = 0; a < n_tangents; ++a)
      out.slip[i * n_tangents + a] = total_slip_[i * n_tangents + a] + now.slip[a];
  }
  return out;
}

namespace
{
void add_up(ContactResult &result, const Sharing &processes)
{
  std::array<double, 11> sums{static_cast<double>(result.n_nodes), static_cast<double>(result.n_active),
                              static_cast<double>(result.n_stick), static_cast<double>(result.n_slip),
                              result.contact_area};
  std::copy_n(result.normal_force.begin(), 3, sums.begin() + 5);
  std::copy_n(result.tangential_force.begin(), 3, sums.begin() + 8);
  processes.sum_over_processes(sums);
  result.n_nodes = static_cast<GlobalIndex>(sums[0]);
  result.n_active = static_cast<int>(sums[1]);
  result.n_stick = static_cast<int>(sums[2]);
  result.n_slip = static_cast<int>(sums[3]);
  result.contact_area = sums[4];
  std::copy_n(sums.begin() + 5, 3, result.normal_force.begin());
  std::copy_n(sums.begin() + 8, 3, result.tangential_force.begin());
  std::array<double, 2> extremes{result.max_pressure, -result.min_gap};
  processes.maximum_over_processes(extremes);
  result.max_pressure = extremes[0];
  result.min_gap = -extremes[1];
}
} // namespace

void complete(ContactResult &result, const Sharing &impactor_nodes)
{
  add_up(result, impactor_nodes);
  const int n_tangents = result.dim - 1;
  impactor_nodes.take_owners(result.gap);
  impactor_nodes.take_owners(result.pressure);
  impactor_nodes.take_owners(result.traction, n_tangents);
  impactor_nodes.take_owners(result.slip, n_tangents);
  impactor_nodes.take_owners(result.force, result.dim);
  impactor_nodes.take_owners(result.area);
  std::vector<double> status;
  for (const ContactStatus one : result.status)
    status.push_back(static_cast<double>(one));
  impactor_nodes.take_owners(status);
  for (std::size_t i = 0; i < status.size(); ++i)
    result.status[i] = static_cast<ContactStatus>(status[i]);
}
} // namespace amontons

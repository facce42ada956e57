#include "amontons/solution/start.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace amontons
{
namespace
{
/// Gaps up to this share of the contact's extent are looked at in small strain, where pairs are made once.
constexpr double small_strain_reach = 0.05;
/// Part of the local size below which an overlap at the start is the mesh's chord error, not worth a warning.
constexpr double overlap_to_tell = 1e-6;

struct Box
{
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());
};

Box box_of(const Surface &surface)
{
  Box box;
  for (Index i = 0; i < surface.n_nodes(); ++i)
    for (int c = 0; c < 3; ++c)
    {
      const double x = c < surface.dim ? surface.reference[i * surface.dim + c] : 0;
      box.low[c] = std::min(box.low[c], x);
      box.high[c] = std::max(box.high[c], x);
    }
  return box;
}
} // namespace

std::pair<double, double> separation_and_extent(const ContactInterface &contact)
{
  const Box a = box_of(contact.impactor());
  const double extent = (a.high - a.low).norm();
  if (!contact.target())
    return {0, extent};
  const Box b = box_of(*contact.target());
  const Eigen::Vector3d apart = (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0);
  return {apart.norm(), std::max(extent, (b.high - b.low).norm())};
}

std::vector<double> diagonal_stiffness(const Model &model)
{
  std::vector<double> diagonal(static_cast<std::size_t>(model.n_nodal()), 0.0);
  for (const SubdomainMatrix &matrix : model.bodies().subdomains())
    for (Index row = 0; row < matrix.n_rows(); ++row)
    {
      const auto begin = matrix.col.begin() + matrix.row_ptr[row], end = matrix.col.begin() + matrix.row_ptr[row + 1];
      diagonal[static_cast<std::size_t>(matrix.nodes[row / matrix.n_components]) * matrix.n_components +
               row % matrix.n_components] += matrix.values[std::lower_bound(begin, end, row) - matrix.col.begin()];
    }
  model.nodes().sum(diagonal, model.dim());
  return diagonal;
}

void detect_first(Model &model, const State &state)
{
  for (ContactInterface &contact : model.contacts())
  {
    const auto [separation, extent] = separation_and_extent(contact);
    const double motion = model.prescribed_motion(0, model.options().loading.end);
    contact.detect(state.displacement, separation + std::max(motion, small_strain_reach * extent), false);
    contact.set_initial_gap(state.displacement);
  }
}

std::vector<std::string> initial_warnings(const Model &model)
{
  std::vector<std::string> out;
  for (const ContactInterface &contact : model.contacts())
  {
    const DetectionReport report = contact.detection_report();
    const bool may_meet_later = contact.options().is_self_contact() && !model.small_strain();
    if (report.n_pairs == 0 && !may_meet_later)
      out.push_back("contact '" + contact.options().name + "': no node of the impactor finds the target");
    if (!contact.target() || report.deepest_node < 0 || contact.options().tied)
      continue;
    const double size = std::pow(contact.areas()[report.deepest_node], 1.0 / (model.dim() - 1));
    if (report.deepest < -overlap_to_tell * size)
    {
      const auto node = static_cast<std::size_t>(contact.impactor().node_ids[report.deepest_node]);
      out.push_back("contact '" + contact.options().name + "': " + std::to_string(report.n_penetrations) +
                    " nodes lie inside the target at the start, deepest " + std::to_string(report.deepest) +
                    " at node " + std::to_string(model.mesh().node_tags[node]) +
                    (contact.options().initial_overlap == InitialOverlap::adjust ? "; taken as touching"
                                                                                 : "; resolved as interference"));
    }
  }
  return out;
}
} // namespace amontons

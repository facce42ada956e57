#include "amontons/solution/start.h"

#include "amontons/algebra/linear_solver_failure.h"
#include "amontons/parallel/agreement.h"

#include <algorithm>
#include <array>
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

std::pair<double, double> separation_and_extent(const Model &model, const ContactInterface &contact)
{
  const auto box_of_all = [&](const Surface &surface)
  {
    Box box = box_of(surface);
    std::array<double, 6> extremes{};
    for (int c = 0; c < 3; ++c)
    {
      extremes[c] = box.high[c];
      extremes[3 + c] = -box.low[c];
    }
    model.nodes().maximum_over_processes(extremes);
    for (int c = 0; c < 3; ++c)
    {
      box.high[c] = extremes[c];
      box.low[c] = -extremes[3 + c];
    }
    return box;
  };
  const Box a = box_of_all(contact.impactor());
  const double extent = (a.high - a.low).norm();
  if (!contact.target())
    return {0, extent};
  const Box b = box_of_all(*contact.target());
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

void set_augmentation(Model &model, std::span<const double> diagonal)
{
  for (ContactInterface &contact : model.contacts())
  {
    std::array<double, 2> on_target{0, 0}; // the sum, and how many
    if (contact.target())
    {
      std::vector<Index> own;
      for (const Index node : contact.target_nodes())
        if (model.nodes().is_own(node))
          own.push_back(node);
      const MeanStiffness mean(diagonal, own, model.dim());
      on_target = {mean.sum, static_cast<double>(mean.n)};
    }
    model.nodes().sum_over_processes(on_target);
    const double mean = on_target[1] > 0 ? on_target[0] / on_target[1] : 0;
    agree_on_failures(model.nodes(), [&] { contact.set_augmentation(diagonal, mean); });
  }
}

void detect_first(Model &model, State &state)
{
  std::vector<double> reaches;
  const double motion = model.prescribed_motion(0, model.options().loading.end);
  for (const ContactInterface &contact : model.contacts())
  {
    const auto [separation, extent] = separation_and_extent(model, contact);
    reaches.push_back(separation + std::max(motion, small_strain_reach * extent));
  }
  (void)model.detect(state, reaches, false);
  const std::vector<double> displacement = model.with_halo(state.displacement);
  std::vector<double> deepest;
  agree_on_failures(model.nodes(),
                    [&]
                    {
                      for (ContactInterface &contact : model.contacts())
                        deepest.push_back(contact.set_initial_gap(displacement));
                    });
  model.nodes().maximum_over_processes(deepest);
  for (std::size_t c = 0; c < deepest.size(); ++c)
    model.contacts()[c].keep_in_sight(deepest[c]);
}

namespace
{
/// What the processes' reports come to together, as far as initial_warnings() asks.
struct FirstPairs
{
  double n_pairs, n_penetrations;
  double deepest = 0;
  bool is_here = false; ///< the deepest node: of equally deep ones the first in the mesh
};

FirstPairs together(const Model &model, std::size_t contact)
{
  const DetectionReport report = model.detection_report(contact);
  const Sharing &processes = model.nodes();
  std::array<double, 2> sums{static_cast<double>(report.n_pairs), static_cast<double>(report.n_penetrations)};
  processes.sum_over_processes(sums);
  FirstPairs out{sums[0], sums[1]};
  out.deepest = -processes.maximum_over_processes(report.deepest_node < 0 ? 0 : -report.deepest);
  const bool has_one = report.deepest_node >= 0;
  out.is_here = is_greatest(processes, has_one ? -report.deepest : no_candidate,
                            has_one ? model.place_of(contact, report.deepest_node) : 0);
  return out;
}

std::string overlap_warning(const Model &model, std::size_t c, const FirstPairs &found)
{
  const ContactInterface &contact = model.contacts()[c];
  const Index node = model.detection_report(c).deepest_node;
  const double size = std::pow(contact.areas()[node], 1.0 / (model.dim() - 1));
  if (found.deepest >= -overlap_to_tell * size)
    return "";
  return "contact '" + contact.options().name +
         "': " + std::to_string(static_cast<std::int64_t>(found.n_penetrations)) +
         " nodes lie inside the target at the start, deepest " + std::to_string(found.deepest) + " at node " +
         std::to_string(model.mesh().node_tags[contact.node(node)]) +
         (contact.options().initial_overlap == InitialOverlap::adjust ? "; taken as touching"
                                                                      : "; resolved as interference");
}
} // namespace

std::vector<std::string> initial_warnings(const Model &model)
{
  std::vector<std::string> out;
  const Sharing &processes = model.nodes();
  for (std::size_t c = 0; c < model.contacts().size(); ++c)
  {
    const ContactInterface &contact = model.contacts()[c];
    const FirstPairs found = together(model, c);
    const bool may_meet_later = contact.options().is_self_contact() && !model.small_strain();
    if (found.n_pairs == 0 && !may_meet_later)
      out.push_back("contact '" + contact.options().name + "': no node of the impactor finds the target");
    if (!contact.target() || contact.options().tied || found.deepest == 0)
      continue;
    const std::string warning = told_by_one(processes, found.is_here, [&] { return overlap_warning(model, c, found); });
    if (!warning.empty())
      out.push_back(warning);
  }
  return out;
}
} // namespace amontons

#include "amontons/parallel/agreement.h"
#include "amontons/solution/newton_iterate.h"

#include <array>

namespace amontons
{
namespace
{
/// A node that changed its status so often within an increment is named.
constexpr int named_flips = 3;

const char *name(ContactStatus status)
{
  return status == ContactStatus::open ? "open" : status == ContactStatus::stick ? "stick" : "slip";
}
} // namespace

/// The node whose status has turned most often within the increment, if one that turned just now did often.
std::string Newton::remark(const Evaluation &now, std::span<const ContactStatus> before)
{
  int most = 0;
  std::size_t worst = 0, k = 0;
  double place = 0;
  Index node = -1;
  for (std::size_t c = 0; c < model_.contacts().size(); ++c)
    for (Index i = 0; i < model_.contacts()[c].n_nodes(); ++i, ++k)
      if (now.status[k] != before[k] && ++n_flips_[k] > most)
      {
        most = n_flips_[k];
        worst = k;
        place = model_.place_of(c, i);
        node = model_.contacts()[c].node(i);
      }
  const auto text = [&]
  {
    return "node " + std::to_string(model_.mesh().node_tags[node]) + " " + name(before[worst]) + "<->" +
           name(now.status[worst]) + ", change " + std::to_string(most);
  };
  const bool is_worst = is_greatest(model_.nodes(), most < named_flips ? no_candidate : most, place);
  const std::string told = told_by_one(model_.nodes(), is_worst, text);
  return told.empty() ? face_remark() : told;
}

/// The node that has changed its face most often within the increment, if that is often.
std::string Newton::face_remark() const
{
  int most = 0;
  double place = 0;
  Index node = -1;
  for (std::size_t c = 0; c < model_.contacts().size(); ++c)
    for (Index i = 0; i < model_.contacts()[c].n_nodes(); ++i)
      if (const ContactInterface &contact = model_.contacts()[c]; contact.n_face_changes(i) > most)
      {
        most = contact.n_face_changes(i);
        place = model_.place_of(c, i);
        node = contact.node(i);
      }
  const auto text = [&]
  {
    return "node " + std::to_string(model_.mesh().node_tags[node]) + " goes to another face, change " +
           std::to_string(most);
  };
  return told_by_one(model_.nodes(), is_greatest(model_.nodes(), most < named_flips ? no_candidate : most, place),
                     text);
}

IterationReport Newton::compare(const Iterate &before, const Iterate &after)
{
  IterationReport report;
  report.residual = after.at.scale > 0 ? after.at.norm / after.at.scale : after.at.norm;
  double change = 0;
  for (std::size_t i = 0; i < after.state.displacement.size(); ++i)
    change = std::max(change, std::abs(after.state.displacement[i] - before.state.displacement[i]));
  std::array<double, 2> most{change, largest(after.state.displacement)};
  model_.nodes().maximum_over_processes(most);
  report.correction = most[1] > 0 ? most[0] / most[1] : 0;
  std::array<double, 3> counts{};
  for (std::size_t k = 0; k < after.at.status.size(); ++k)
  {
    counts[0] += after.at.status[k] != before.at.status[k];
    counts[1] += after.at.status[k] == ContactStatus::stick;
    counts[2] += after.at.status[k] == ContactStatus::slip;
  }
  model_.nodes().sum_over_processes(counts);
  report.n_status_changes = static_cast<int>(counts[0]);
  report.n_stick = static_cast<int>(counts[1]);
  report.n_slip = static_cast<int>(counts[2]);
  report.n_active = report.n_stick + report.n_slip;
  report.remark = remark(after.at, before.at.status);
  return report;
}
} // namespace amontons

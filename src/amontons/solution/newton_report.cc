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

std::string Newton::remark(const Evaluation &now, std::span<const ContactStatus> before)
{
  std::size_t worst = now.status.size();
  for (std::size_t k = 0; k < now.status.size(); ++k)
    if (now.status[k] != before[k])
    {
      ++n_flips_[k];
      if (n_flips_[k] >= named_flips && (worst == now.status.size() || n_flips_[k] > n_flips_[worst]))
        worst = k;
    }
  if (worst == now.status.size())
    return face_remark();
  std::size_t first = 0;
  for (const ContactInterface &contact : model_.contacts())
  {
    if (worst < first + static_cast<std::size_t>(contact.n_nodes()))
    {
      const GlobalIndex node = contact.impactor().node_ids[worst - first];
      return "node " + std::to_string(model_.mesh().node_tags[static_cast<std::size_t>(node)]) + " " +
             name(before[worst]) + "<->" + name(now.status[worst]) + ", change " + std::to_string(n_flips_[worst]);
    }
    first += static_cast<std::size_t>(contact.n_nodes());
  }
  return "";
}

/// The node that has changed its face most often within the increment, if that is often.
std::string Newton::face_remark() const
{
  int most = named_flips - 1;
  GlobalIndex node = -1;
  for (const ContactInterface &contact : model_.contacts())
    for (Index i = 0; i < contact.n_nodes(); ++i)
      if (contact.n_face_changes(i) > most)
      {
        most = contact.n_face_changes(i);
        node = contact.impactor().node_ids[i];
      }
  if (node < 0)
    return "";
  return "node " + std::to_string(model_.mesh().node_tags[static_cast<std::size_t>(node)]) +
         " goes to another face, change " + std::to_string(most);
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
  for (std::size_t k = 0; k < after.at.status.size(); ++k)
  {
    report.n_status_changes += after.at.status[k] != before.at.status[k];
    report.n_stick += after.at.status[k] == ContactStatus::stick;
    report.n_slip += after.at.status[k] == ContactStatus::slip;
  }
  report.n_active = report.n_stick + report.n_slip;
  report.remark = remark(after.at, before.at.status);
  return report;
}
} // namespace amontons

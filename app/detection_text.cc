#include "detection_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace amontons
{
namespace
{
/// "12 face, 3 vertex"; nothing of what did not occur. `words` with '_' read as words.
std::string counts_text(const std::map<std::string, Index> &counts)
{
  std::string text;
  for (const auto &[word, count] : counts)
    if (count > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, word);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string self_contact_text(const SelfContactReport &self)
{
  const std::string distance = self.least_distance == self.greatest_distance
                                   ? fmt::format("{:.6g}", self.least_distance)
                                   : fmt::format("{:.6g} to {:.6g}", self.least_distance, self.greatest_distance);
  return fmt::format("  self-contact in {} zones; self-distance {}: each node leaves out {:.3g} faces\n", self.n_zones,
                     distance, self.n_excluded);
}
} // namespace

std::string detection_text(const ContactCheck &contact)
{
  const DetectionReport &report = contact.detection;
  std::string text = fmt::format("contact {}: {} impactor nodes, ", contact.name, contact.n_impactor_nodes);
  text += contact.n_target_faces > 0 ? fmt::format("{} target faces\n", contact.n_target_faces) : "analytic target\n";
  text += fmt::format("  method {}, detection distance w = {:.6g} ({})\n", report.method, report.distance,
                      report.distance_face < 0 ? "not set by a face"
                                               : fmt::format("set by target face {}", report.distance_face));
  const Index n_unpaired = contact.n_impactor_nodes - report.n_pairs;
  text += fmt::format("  {} nodes with a face: {}\n", report.n_pairs, counts_text(report.pairs_by_kind));
  if (n_unpaired > 0)
    text += fmt::format("  {} nodes without: {}\n", n_unpaired, counts_text(report.unpaired_by_reason));
  if (report.self_contact)
    text += self_contact_text(*report.self_contact);
  if (report.n_penetrations > 0)
    text += fmt::format("  {} nodes inside the target, the deepest by {:.6g} at ({:.6g})\n", report.n_penetrations,
                        -report.deepest, fmt::join(report.deepest_point, ", "));
  for (const auto &[step, seconds] : report.seconds)
    text += fmt::format("  {}: {:.3g} s\n", step, seconds);
  return text;
}

std::string detection_json(const std::vector<ContactCheck> &contacts)
{
  auto list = nlohmann::ordered_json::array();
  for (const ContactCheck &contact : contacts)
  {
    const DetectionReport &report = contact.detection;
    list.push_back({{"name", contact.name},
                    {"n_impactor_nodes", contact.n_impactor_nodes},
                    {"n_target_faces", contact.n_target_faces},
                    {"method", report.method},
                    {"distance", report.distance},
                    {"distance_face", report.distance_face},
                    {"n_pairs", report.n_pairs},
                    {"pairs_by_kind", report.pairs_by_kind},
                    {"unpaired_by_reason", report.unpaired_by_reason},
                    {"n_penetrations", report.n_penetrations},
                    {"deepest", report.deepest},
                    {"deepest_node", report.deepest_node},
                    {"deepest_point", report.deepest_point},
                    {"seconds", report.seconds}});
    if (const auto &self = report.self_contact)
      list.back()["self_contact"] = {{"n_zones", self->n_zones},
                                     {"n_excluded_mean", self->n_excluded},
                                     {"least_self_distance", self->least_distance},
                                     {"greatest_self_distance", self->greatest_distance}};
  }
  return list.dump(2);
}
} // namespace amontons

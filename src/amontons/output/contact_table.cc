#include "amontons/output/contact_table.h"

#include "amontons/base/error.h"

#include <fmt/format.h>

#include <iterator>
#include <span>

namespace amontons
{
namespace
{
constexpr std::string_view axes = "xyz";

std::string header(int dim)
{
  std::string text = "id";
  for (int c = 0; c < dim; ++c)
    text += fmt::format(",{}", axes[c]);
  for (int c = 0; c < dim; ++c)
    text += fmt::format(",u{}", axes[c]);
  text += ",gap,pressure";
  for (const char *quantity : {"traction", "slip"})
    for (int t = 1; t < dim; ++t)
      text += fmt::format(",{}_{}", quantity, t);
  text += ",status";
  for (int c = 0; c < dim; ++c)
    text += fmt::format(",f{}", axes[c]);
  return text + ",area\n";
}

std::string_view status_name(ContactStatus status)
{
  switch (status)
  {
  case ContactStatus::open:
    return "open";
  case ContactStatus::stick:
    return "stick";
  case ContactStatus::slip:
    return "slip";
  }
  return "";
}

void append(std::string &row, std::span<const double> values)
{
  for (const double value : values)
    fmt::format_to(std::back_inserter(row), ",{:.17g}", value); // 17 digits bring the same double back
}
} // namespace

std::string contact_table(const ContactResult &contact, const SolutionState &state)
{
  const Surface &surface = *contact.impactor;
  const int dim = contact.dim;
  const auto of_node = [](const std::vector<double> &values, std::size_t node, int n_components)
  { return std::span(values).subspan(node * n_components, n_components); };
  AMONTONS_ASSERT(surface.dim == dim && contact.status.size() == surface.node_ids.size());

  std::string text = header(dim);
  for (std::size_t i = 0; i < surface.node_ids.size(); ++i)
  {
    const auto node = static_cast<std::size_t>(surface.node_ids[i]);
    text += std::to_string(state.mesh->node_tags[node]);
    append(text, of_node(surface.reference, i, dim));
    append(text, of_node(state.displacement, node, dim));
    append(text, of_node(contact.gap, i, 1));
    append(text, of_node(contact.pressure, i, 1));
    append(text, of_node(contact.traction, i, dim - 1));
    append(text, of_node(contact.slip, i, dim - 1));
    text.append(",").append(status_name(contact.status[i]));
    append(text, of_node(contact.force, i, dim));
    append(text, of_node(contact.area, i, 1));
    text += '\n';
  }
  return text;
}

void ContactTables::accepted(const IncrementReport & /*report*/, const SolutionState &state)
{
  for (const ContactResult &contact : state.contacts)
    folder_.write(contact_file_stem(contact.name) + ".csv", contact_table(contact, state));
}
} // namespace amontons

#include "amontons/output/contact_table.h"

#include "amontons/base/error.h"
#include "amontons/parallel/archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

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
/// By the node's position in the whole mesh.
using Row = std::pair<GlobalIndex, std::string>;

std::string row_text(const ContactResult &contact, const SolutionState &state, std::size_t i)
{
  const int dim = contact.dim;
  const auto of_node = [](const std::vector<double> &values, std::size_t node, int n_components)
  { return std::span(values).subspan(node * n_components, n_components); };
  const auto node = static_cast<std::size_t>(contact.nodes[i]);
  std::string text = std::to_string(state.mesh->node_tags[node]);
  append(text, of_node(contact.impactor->reference, i, dim));
  append(text, of_node(state.displacement, node, dim));
  append(text, of_node(contact.gap, i, 1));
  append(text, of_node(contact.pressure, i, 1));
  append(text, of_node(contact.traction, i, dim - 1));
  append(text, of_node(contact.slip, i, dim - 1));
  text.append(",").append(status_name(contact.status[i]));
  append(text, of_node(contact.force, i, dim));
  append(text, of_node(contact.area, i, 1));
  return text + '\n';
}

template<class Archive>
void show(Archive &message, std::vector<Row> &rows)
{
  std::size_t n = rows.size();
  message.value(n);
  rows.resize(n);
  for (auto &[node, text] : rows)
  {
    message.value(node);
    message.text(text);
  }
}

/// Those of all processes, on process 0.
std::vector<Row> gathered(std::vector<Row> own, const Sharing &processes)
{
  if (!processes.is_distributed())
    return own;
  Packer packer;
  show(packer, own);
  std::vector<Row> out;
  for (const Message &from : processes.messages()->exchange("output", {{0, packer.message.take()}}))
  {
    Unpacker unpacker{ByteReader(from.bytes)};
    std::vector<Row> rows;
    show(unpacker, rows);
    out.insert(out.end(), rows.begin(), rows.end());
  }
  std::sort(out.begin(), out.end());
  return out;
}
} // namespace

std::string contact_table(const ContactResult &contact, const SolutionState &state)
{
  AMONTONS_ASSERT(contact.impactor->dim == contact.dim && contact.status.size() == contact.nodes.size());
  std::vector<Row> rows;
  for (Index i = 0; i < contact.n_own; ++i)
    rows.emplace_back(contact.impactor->node_ids[i], row_text(contact, state, i));
  std::string text = header(contact.dim);
  for (const auto &[node, row] : gathered(std::move(rows), *state.nodes))
    text += row;
  return text;
}

void ContactTables::accepted(const IncrementReport & /*report*/, const SolutionState &state)
{
  for (const ContactResult &contact : state.contacts)
  {
    const std::string text = contact_table(contact, state);
    if (folder_.communicator().is_root())
      folder_.write(contact_file_stem(contact.name) + ".csv", text);
  }
}
} // namespace amontons

#include "amontons/solution/checkpoint_contacts.h"

#include <algorithm>

namespace amontons
{
namespace
{
/// Adds node i of one history to another.
void append(ContactHistory &to, const ContactHistory &from, std::size_t i)
{
  const auto add = [&](auto &values, const auto &others, std::size_t n)
  {
    const auto first = others.begin() + static_cast<std::ptrdiff_t>(i * n);
    values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(n));
  };
  add(to.nodes, from.nodes, 1);
  add(to.pairing, from.pairing, 1);
  add(to.face_nodes, from.face_nodes, max_face_nodes);
  add(to.status, from.status, 1);
  add(to.total_slip, from.total_slip, from.total_slip.size() / from.nodes.size());
}
} // namespace

std::vector<ContactPlace> contact_places(std::span<const Checkpoint *const> parts, std::size_t contact, int dim)
{
  std::vector<ContactPlace> out;
  for (std::size_t part = 0; part < parts.size(); ++part)
  {
    std::size_t before = 0;
    for (std::size_t c = 0; c < contact; ++c)
      before += parts[part]->contacts[c].nodes.size();
    const std::vector<GlobalIndex> &nodes = parts[part]->contacts[contact].nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      out.push_back({nodes[i], part, i, (before + i) * dim});
  }
  std::sort(out.begin(), out.end(), [](const ContactPlace &a, const ContactPlace &b) { return a.node < b.node; });
  return out;
}

void add_contact(Checkpoint &out, std::span<const Checkpoint *const> parts, std::size_t contact,
                 std::span<const ContactPlace> places, int dim)
{
  ContactHistory &history = out.contacts.emplace_back();
  const auto add = [&](State &to, const State &from, std::size_t multiplier)
  {
    const auto first = from.multipliers.begin() + static_cast<std::ptrdiff_t>(multiplier);
    to.multipliers.insert(to.multipliers.end(), first, first + dim);
  };
  for (const ContactPlace &place : places)
  {
    const Checkpoint &part = *parts[place.part];
    append(history, part.contacts[contact], place.i);
    add(out.state, part.state, place.multiplier);
    if (out.last)
      add(out.last->start, part.last->start, place.multiplier);
  }
}

void forget_contacts(Checkpoint &checkpoint)
{
  checkpoint.contacts.clear();
  checkpoint.state.multipliers.clear();
  if (checkpoint.last)
    checkpoint.last->start.multipliers.clear();
}

bool is_whole(const Checkpoint &checkpoint, std::size_t n_contacts, int dim)
{
  std::size_t n_nodes = 0;
  for (const ContactHistory &contact : checkpoint.contacts)
  {
    const std::size_t n = contact.nodes.size();
    if (contact.pairing.size() != n || contact.status.size() != n || contact.face_nodes.size() != n * max_face_nodes ||
        contact.total_slip.size() != n * (dim - 1) || !std::is_sorted(contact.nodes.begin(), contact.nodes.end()))
      return false;
    n_nodes += n;
  }
  const auto fits = [&](const State &state) { return state.multipliers.size() == n_nodes * dim; };
  return checkpoint.contacts.size() == n_contacts && fits(checkpoint.state) &&
         (!checkpoint.last || fits(checkpoint.last->start));
}
} // namespace amontons

#include "amontons/exchange/contact_sides.h"

#include "amontons/detection/self_contact_exclusions.h"
#include "amontons/parallel/agreement.h"

#include <algorithm>

namespace amontons
{
namespace
{
// The nodes looked for in this part that see a face.
std::vector<Index> seeing_nodes(const PartContact &contact)
{
  std::vector<Index> nodes;
  for (const HeldSurface::Source &source : contact.impactor.sources())
    for (Index k = 0; k < source.n_own; ++k)
      if (contact.pairs[source.nodes[k]].face >= 0)
        nodes.push_back(source.nodes[k]);
  return nodes;
}

// The faces round the nodes, and those seen.
Shipments sights_of(const PartContact &contact, std::vector<Index> nodes)
{
  const Surface &surface = contact.impactor.surface();
  Shipments shipments;
  Shipment &shipment = shipments[0];
  for (const Index node : nodes)
  {
    const auto attached = surface.faces_of_node(node);
    shipment.faces.insert(shipment.faces.end(), attached.begin(), attached.end());
    shipment.faces.push_back(contact.pairs[node].face);
  }
  std::sort(shipment.faces.begin(), shipment.faces.end());
  shipment.faces.erase(std::unique(shipment.faces.begin(), shipment.faces.end()), shipment.faces.end());
  shipment.n_own = static_cast<Index>(nodes.size());
  shipment.nodes = std::move(nodes);
  add_nodes_of_faces(shipments, surface);
  return shipments;
}

void pack_sights(const PartContact &contact, const std::vector<Index> &nodes, ByteWriter &writer)
{
  const Surface &surface = contact.impactor.surface();
  const Shipments shipments = sights_of(contact, nodes);
  const Shipment &shipment = shipments.at(0);
  std::vector<Index> room;
  writer.add(surface.dim);
  pack_topology(shipment, surface, surface.reference, room, writer);
  pack_positions(shipment, surface.dim, contact.impactor.x(), writer);
  for (Index k = 0; k < shipment.n_own; ++k)
  {
    const Index face = contact.pairs[shipment.nodes[k]].face;
    const auto place = std::lower_bound(shipment.faces.begin(), shipment.faces.end(), face);
    writer.add(static_cast<Index>(place - shipment.faces.begin()));
  }
}
} // namespace

std::vector<Message> ContactSides::ask(PartWork &work) const
{
  std::map<Rank, ByteWriter> writers;
  for (std::size_t c = 0; c < work.contacts().size(); ++c)
  {
    const PartContact &contact = work.contacts()[c];
    if (!contact.is_self)
      continue;
    const std::vector<Index> nodes = seeing_nodes(contact);
    if (nodes.empty())
      continue;
    ByteWriter sight;
    pack_sights(contact, nodes, sight);
    writers[decider(c)].add(c);
    writers[decider(c)].add_array(sight.take());
  }
  std::vector<Message> messages;
  for (auto &[rank, writer] : writers)
    messages.push_back({rank, writer.take()});
  return messages;
}

std::vector<Message> ContactSides::answer(const std::vector<Message> &questions, Index &n_nodes)
{
  std::map<std::size_t, std::vector<Sight>> sights;
  for (const Message &question : questions)
    for (ByteReader reader(question.bytes); !reader.is_at_end();)
    {
      const auto contact = reader.get<std::size_t>();
      sights[contact].push_back({question.rank, reader.get_array<std::byte>()});
    }
  std::map<Rank, ByteWriter> writers; // contact by contact, as they were asked
  for (const auto &[contact, own] : sights)
  {
    std::vector<std::vector<char>> answers;
    n_nodes += decide(own, kept_[contact], answers);
    for (std::size_t s = 0; s < own.size(); ++s)
      writers[own[s].rank].add_array(answers[s]);
  }
  std::vector<Message> messages;
  for (auto &[rank, writer] : writers)
    messages.push_back({rank, writer.take()});
  return messages;
}

Index ContactSides::decide(const std::vector<Sight> &sights, RolesById &kept,
                           std::vector<std::vector<char>> &answers) const
{
  std::vector<ByteReader> readers;
  for (const Sight &sight : sights)
    readers.emplace_back(sight.bytes);
  HeldSurface held(readers[0].get<int>(), "impactor");
  for (std::size_t s = 0; s < sights.size(); ++s)
  {
    if (s > 0)
      readers[s].get<int>();
    held.add_topology(sights[s].rank, readers[s]);
  }
  held.merge(true);
  held.move(readers);

  const Surface &surface = held.surface();
  Pairing pairing(surface.node_ids.size());
  for (std::size_t s = 0; s < sights.size(); ++s)
  {
    const HeldSurface::Source &source = held.sources()[s];
    for (Index k = 0; k < source.n_own; ++k)
      pairing[source.nodes[k]].face = source.faces[readers[s].get<Index>()];
  }
  std::vector<Roles::Role> old(surface.node_ids.size(), Roles::Role::none);
  for (Index node = 0; node < surface.n_nodes(); ++node)
    if (const auto found = kept.find(surface.node_ids[node]); found != kept.end())
      old[node] = found->second;
  Roles roles(surface, std::move(old));
  roles.assign(pairing, surface_normals(surface, held.x()).node);
  for (Index node = 0; node < surface.n_nodes(); ++node)
    if (roles.kept()[node] != Roles::Role::none)
      kept[surface.node_ids[node]] = roles.kept()[node];
  for (const HeldSurface::Source &source : held.sources())
  {
    std::vector<char> &answer = answers.emplace_back();
    for (Index k = 0; k < source.n_own; ++k)
      answer.push_back(pairing[source.nodes[k]].face >= 0 ? 1 : 0);
  }
  return surface.n_nodes();
}

void ContactSides::apply(PartWork &work, const std::vector<Message> &answers) const
{
  std::map<Rank, ByteReader> readers;
  for (const Message &message : answers)
    readers.emplace(message.rank, ByteReader(message.bytes));
  for (std::size_t c = 0; c < work.contacts().size(); ++c)
  {
    PartContact &contact = work.contacts()[c];
    if (!contact.is_self)
      continue;
    const std::vector<Index> nodes = seeing_nodes(contact);
    if (nodes.empty())
      continue;
    const std::vector<char> is_impactor = readers.at(decider(c)).get_array<char>();
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if (is_impactor[k] == 0)
      {
        contact.pairs[nodes[k]] = Pair{};
        contact.pairs[nodes[k]].reason = NoPairReason::target_side;
      }
  }
}

Index ContactSides::assign(PartWork &work)
{
  const auto &contacts = work.contacts();
  if (std::none_of(contacts.begin(), contacts.end(), [](const PartContact &contact) { return contact.is_self; }))
    return 0;
  const Communicator &all = messages_.communicator();
  Index n_nodes = 0;
  std::vector<Message> out, in;
  agree_on_errors(all, [&] { out = ask(work); });
  std::vector<Rank> asked;
  for (const Message &message : out)
    asked.push_back(message.rank);
  in = messages_.exchange("sides", std::move(out));
  agree_on_errors(all, [&] { out = answer(in, n_nodes); });
  in = messages_.exchange_with("sides", std::move(out), asked);
  agree_on_errors(all, [&] { apply(work, in); });
  return n_nodes;
}
} // namespace amontons

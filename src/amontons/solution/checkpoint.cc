#include "amontons/solution/checkpoint.h"

#include "amontons/base/error.h"
#include "amontons/base/hash.h"
#include "amontons/parallel/agreement.h"
#include "amontons/parallel/archive.h"
#include "amontons/solution/checkpoint_contacts.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

namespace amontons
{
namespace
{
const char *const phase = "checkpoint";
constexpr std::size_t numbers_of_rigid_body = 15;

template<class Archive>
void show(Archive &message, State &state)
{
  message.array(state.displacement);
  message.array(state.multipliers);
  std::vector<double> rigid = to_numbers(state.rigid);
  message.array(rigid);
  state.rigid = to_rigid_states(rigid);
}

template<class Archive>
void show(Archive &message, Checkpoint &checkpoint)
{
  message.value(checkpoint.increment);
  message.value(checkpoint.time);
  message.value(checkpoint.next_step);
  message.value(checkpoint.last_motion);
  message.value(checkpoint.linear_solver);
  message.value(checkpoint.counters);
  show(message, checkpoint.state);
  bool has_last = checkpoint.last.has_value();
  message.value(has_last);
  if (has_last)
  {
    LastIncrement &last = checkpoint.last ? *checkpoint.last : checkpoint.last.emplace();
    show(message, last.start);
    message.value(last.from);
    message.value(last.to);
  }
  std::size_t n_contacts = checkpoint.contacts.size();
  message.value(n_contacts);
  checkpoint.contacts.resize(n_contacts);
  for (ContactHistory &contact : checkpoint.contacts)
  {
    message.array(contact.nodes);
    message.array(contact.pairing);
    message.array(contact.face_nodes);
    message.array(contact.status);
    message.array(contact.total_slip);
  }
  message.array(checkpoint.cells.cells);
  message.array(checkpoint.cells.offset);
  message.array(checkpoint.cells.values);
}

/// Positions in the whole: of the nodes, and behind all nodes of the points of analytic bodies.
std::vector<GlobalIndex> ids_of_nodes(const Mesh &mesh, Index n_state_nodes)
{
  std::vector<GlobalIndex> ids = mesh.node_ids;
  ids.resize(static_cast<std::size_t>(n_state_nodes));
  std::iota(ids.begin() + mesh.n_nodes(), ids.end(), mesh.n_global_nodes);
  return ids;
}

/// The state with its displacements at some of the nodes, in their order.
template<class Node>
State at_nodes(const State &state, const std::vector<Node> &nodes, int dim)
{
  State out{{}, state.rigid, state.multipliers};
  out.displacement.reserve(nodes.size() * dim);
  for (const Node node : nodes)
    for (int c = 0; c < dim; ++c)
      out.displacement.push_back(state.displacement.at(static_cast<std::size_t>(node) * dim + c));
  return out;
}

void put_at_nodes(State &state, const std::vector<GlobalIndex> &nodes, int dim, const State &values)
{
  for (std::size_t k = 0; k < values.displacement.size(); ++k)
    state.displacement.at(static_cast<std::size_t>(nodes[k / dim]) * dim + k % dim) = values.displacement[k];
}

void append(CellHistories &histories, Index cell, std::span<const double> values)
{
  histories.cells.push_back(cell);
  histories.values.insert(histories.values.end(), values.begin(), values.end());
  histories.offset.push_back(histories.values.size());
}

/// By the cell's position.
std::map<GlobalIndex, std::span<const double>> by_cell(const CellHistories &histories)
{
  std::map<GlobalIndex, std::span<const double>> out;
  for (std::size_t i = 0; i < histories.cells.size(); ++i)
    out[histories.cells[i]] =
        std::span(histories.values).subspan(histories.offset[i], histories.offset[i + 1] - histories.offset[i]);
  return out;
}

/// What a process brings to the whole.
struct Share
{
  std::vector<GlobalIndex> nodes; ///< those it owns
  Checkpoint part;                ///< displacements at these nodes, cells by their positions in the whole
};

template<class Archive>
void show(Archive &message, Share &share)
{
  message.array(share.nodes);
  show(message, share.part);
}

Share share_of(const Checkpoint &local, const Mesh &mesh, const Sharing &nodes)
{
  Share share;
  std::vector<Index> own;
  const std::vector<GlobalIndex> ids =
      ids_of_nodes(mesh, static_cast<Index>(local.state.displacement.size()) / mesh.dim);
  for (Index node = 0; node < static_cast<Index>(ids.size()); ++node)
    if (nodes.is_own(node))
    {
      own.push_back(node);
      share.nodes.push_back(ids[node]);
    }
  share.part.state = at_nodes(local.state, own, mesh.dim);
  if (local.last)
    share.part.last = LastIncrement{at_nodes(local.last->start, own, mesh.dim), 0, 0};
  share.part.contacts = local.contacts;
  share.part.cells = local.cells;
  for (Index &cell : share.part.cells.cells)
    cell = static_cast<Index>(mesh.cell_ids[cell]);
  return share;
}

/// What a process asks for: nodes, cells and impactor nodes by their positions in the whole.
struct Wish
{
  std::vector<GlobalIndex> nodes, cells;
  std::vector<std::vector<GlobalIndex>> contact_nodes;
};

template<class Archive>
void show(Archive &message, Wish &wish)
{
  message.array(wish.nodes);
  message.array(wish.cells);
  std::size_t n_contacts = wish.contact_nodes.size();
  message.value(n_contacts);
  wish.contact_nodes.resize(n_contacts);
  for (std::vector<GlobalIndex> &nodes : wish.contact_nodes)
    message.array(nodes);
}

/// What of the checkpoint of the whole has to do with some nodes and cells.
Checkpoint part_at(const Checkpoint &whole, const Wish &wish,
                   const std::map<GlobalIndex, std::span<const double>> &histories, int dim)
{
  Checkpoint out = whole;
  out.state = at_nodes(whole.state, wish.nodes, dim);
  if (whole.last)
    out.last->start = at_nodes(whole.last->start, wish.nodes, dim);
  forget_contacts(out);
  const std::array<const Checkpoint *, 1> parts{&whole};
  for (std::size_t c = 0; c < wish.contact_nodes.size(); ++c)
  {
    const std::vector<ContactPlace> all = contact_places(parts, c, dim);
    std::vector<ContactPlace> places;
    for (const GlobalIndex node : wish.contact_nodes[c])
    {
      const auto place = std::lower_bound(all.begin(), all.end(), node,
                                          [](const ContactPlace &a, GlobalIndex b) { return a.node < b; });
      AMONTONS_ASSERT(place != all.end() && place->node == node);
      places.push_back(*place);
    }
    add_contact(out, parts, c, places, dim);
  }
  out.cells = {{}, {0}, {}};
  for (std::size_t cell = 0; cell < wish.cells.size(); ++cell)
    if (const auto found = histories.find(wish.cells[cell]); found != histories.end())
      append(out.cells, static_cast<Index>(cell), found->second);
  return out;
}
} // namespace

Checkpoint gathered(const Checkpoint &local, const Mesh &mesh, const Sharing &nodes)
{
  if (!nodes.is_distributed())
    return local;
  Packer packer;
  Share own = share_of(local, mesh, nodes);
  show(packer, own);
  const std::vector<Message> in = nodes.messages()->exchange(phase, {{0, packer.message.take()}});
  if (in.empty()) // not on process 0
    return {};
  Checkpoint whole = local;
  const std::size_t n =
      local.state.displacement.size() + static_cast<std::size_t>(mesh.n_global_nodes - mesh.n_nodes()) * mesh.dim;
  whole.state.displacement.assign(n, 0.0);
  if (whole.last)
    whole.last->start.displacement.assign(n, 0.0);
  std::vector<Share> shares(in.size());
  std::vector<const Checkpoint *> parts;
  std::map<GlobalIndex, std::span<const double>> histories;
  for (std::size_t k = 0; k < in.size(); ++k)
  {
    Unpacker unpacker{ByteReader(in[k].bytes)};
    Share &share = shares[k];
    show(unpacker, share);
    put_at_nodes(whole.state, share.nodes, mesh.dim, share.part.state);
    if (whole.last)
      put_at_nodes(whole.last->start, share.nodes, mesh.dim, share.part.last->start);
    histories.merge(by_cell(share.part.cells));
    parts.push_back(&share.part);
  }
  forget_contacts(whole);
  for (std::size_t c = 0; c < local.contacts.size(); ++c)
    add_contact(whole, parts, c, contact_places(parts, c, mesh.dim), mesh.dim);
  whole.cells = {{}, {0}, {}};
  for (const auto &[cell, values] : histories)
    append(whole.cells, static_cast<Index>(cell), values);
  return whole;
}

Checkpoint part_of(const Checkpoint &whole, std::uint64_t problem_key, const Mesh &mesh, const Sharing &nodes,
                   Index n_state_nodes, const std::vector<std::vector<GlobalIndex>> &contact_nodes)
{
  const auto check = [&]
  {
    if (nodes.rank() > 0)
      return;
    if (whole.problem_key != problem_key)
      throw UserError("the checkpoint is of another problem: mesh, kinds of bodies and contacts must be those "
                      "of the deck");
    if (!is_whole(whole, contact_nodes.size(), mesh.dim))
      throw UserError("the checkpoint does not hold what contacts remember");
  };
  if (!nodes.is_distributed())
  {
    check();
    return whole;
  }
  MessageExchange &messages = *nodes.messages();
  agree_on_errors(messages.communicator(), check);
  Packer request;
  Wish own{ids_of_nodes(mesh, n_state_nodes), mesh.cell_ids, contact_nodes};
  show(request, own);
  std::vector<Message> answers;
  const auto histories = by_cell(whole.cells);
  for (const Message &from : messages.exchange(phase, {{0, request.message.take()}}))
  {
    Unpacker unpacker{ByteReader(from.bytes)};
    Wish wish;
    show(unpacker, wish);
    Checkpoint part = part_at(whole, wish, histories, mesh.dim);
    Packer packer;
    show(packer, part);
    answers.push_back({from.rank, packer.message.take()});
  }
  const std::vector<Message> in = messages.exchange(phase, std::move(answers));
  Unpacker unpacker{ByteReader(in.front().bytes)};
  Checkpoint part;
  show(unpacker, part);
  part.problem_key = problem_key;
  if (nodes.rank() > 0) // the work so far is counted once
    part.counters.n_factorizations = 0;
  return part;
}

std::vector<double> to_numbers(const std::vector<RigidState> &bodies)
{
  std::vector<double> out;
  for (const RigidState &body : bodies)
  {
    out.insert(out.end(), body.translation.data(), body.translation.data() + 3);
    out.insert(out.end(), body.rotation_vector.data(), body.rotation_vector.data() + 3);
    out.insert(out.end(), body.rotation.data(), body.rotation.data() + 9);
  }
  return out;
}

std::vector<RigidState> to_rigid_states(const std::vector<double> &numbers)
{
  std::vector<RigidState> out;
  for (std::size_t i = 0; i + numbers_of_rigid_body <= numbers.size(); i += numbers_of_rigid_body)
  {
    const double *number = numbers.data() + i;
    out.push_back({Eigen::Vector3d(number), Eigen::Vector3d(number + 3), Eigen::Matrix3d(number + 6)});
  }
  return out;
}

std::uint64_t problem_key(const ProblemOptions &options, const Mesh &mesh)
{
  Hash hash;
  hash.add(options.mesh.kinematics);
  hash.add(options.strain);
  for (const BodyOptions &body : options.bodies)
    hash.add(body.material.law);
  for (const ContactOptions &contact : options.contact)
  {
    for (const std::string &name : {contact.name, contact.impactor, contact.target})
      hash.add(std::span<const char>(name.c_str(), name.size() + 1));
    hash.add(contact.tied);
    hash.add(contact.initial_overlap);
    hash.add(contact.discretization);
  }
  hash.add(std::span<const double>(mesh.points));
  for (Index cell = 0; cell < mesh.cells.size(); ++cell)
    hash.add(std::span<const Index>(mesh.cells[cell]));
  return hash.value();
}
} // namespace amontons

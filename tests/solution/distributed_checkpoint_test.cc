// Checkpoints of parts and of the whole. Every expectation holds on any number of processes.
#include "amontons/base/error.h"
#include "amontons/solution/checkpoint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

namespace amontons
{
namespace
{
constexpr Index n_nodes = 20; // of the whole mesh; one point of an analytic body behind them
constexpr Index n_cells = 9;
constexpr int dim = 2;
constexpr std::uint64_t key = 42;

/// Cells with an odd number remember something, the more the greater the number.
void add_history(CellHistories &histories, Index cell, GlobalIndex id)
{
  if (id % 2 == 0)
    return;
  histories.cells.push_back(cell);
  for (GlobalIndex k = 0; k < 7 * id; ++k)
    histories.values.push_back(0.5 * static_cast<double>(k + 100 * id));
  histories.offset.push_back(histories.values.size());
}

using ContactNodes = std::vector<std::vector<GlobalIndex>>;

/// By contact; one node is in both.
const ContactNodes all_contact_nodes{{0, 1, 2, 3, 5, 8, 13}, {3, 4, 11}};

void add_contact(Checkpoint &out, std::size_t c, const std::vector<GlobalIndex> &nodes)
{
  ContactHistory &history = out.contacts.emplace_back();
  for (const GlobalIndex id : nodes)
  {
    const double value = static_cast<double>(100 * c + id);
    Pair pair;
    pair.face = static_cast<Index>(7 * c + id);
    pair.gap = 0.125 * value;
    history.nodes.push_back(id);
    history.pairing.push_back(pair);
    history.face_nodes.insert(history.face_nodes.end(), {id + 1, id + 2, -1, -1});
    history.status.push_back(static_cast<ContactStatus>(id % 3));
    history.total_slip.push_back(value);
    for (State *state : {&out.state, &out.last->start})
      state->multipliers.insert(state->multipliers.end(), {value, state == &out.state ? 1.0 : 2.0});
  }
}

/// A checkpoint at some nodes. @param ids of the nodes in the whole
Checkpoint checkpoint_at(const std::vector<GlobalIndex> &ids, const ContactNodes &contact_nodes)
{
  Checkpoint out;
  out.problem_key = key;
  out.increment = 3;
  out.time = 0.3;
  out.next_step = 0.1;
  out.last_motion = 0.01;
  out.linear_solver = LinearSolverType::amg;
  out.last.emplace().from = 0.2;
  out.last->to = 0.3;
  for (State *state : {&out.state, &out.last->start})
  {
    const double sign = state == &out.state ? 1 : -1;
    for (const GlobalIndex id : ids)
      for (int c = 0; c < dim; ++c)
        state->displacement.push_back(sign / static_cast<double>(10 * id + c + 1));
    RigidState &body = state->rigid.emplace_back();
    body.translation = {sign, 2, 3};
    body.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  }
  for (std::size_t c = 0; c < contact_nodes.size(); ++c)
    add_contact(out, c, contact_nodes[c]);
  out.cells.offset = {0};
  out.counters.n_detections = 11;
  return out;
}

Checkpoint whole_checkpoint()
{
  std::vector<GlobalIndex> ids;
  for (GlobalIndex id = 0; id <= n_nodes; ++id)
    ids.push_back(id);
  Checkpoint out = checkpoint_at(ids, all_contact_nodes);
  for (Index cell = 0; cell < n_cells; ++cell)
    add_history(out.cells, cell, cell);
  return out;
}

void expect_same(const State &a, const State &b)
{
  EXPECT_EQ(a.displacement, b.displacement);
  EXPECT_EQ(a.multipliers, b.multipliers);
  EXPECT_EQ(to_numbers(a.rigid), to_numbers(b.rigid));
}

void expect_same(const Checkpoint &a, const Checkpoint &b)
{
  EXPECT_EQ(a.problem_key, b.problem_key);
  EXPECT_EQ(a.increment, b.increment);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.next_step, b.next_step);
  EXPECT_EQ(a.last_motion, b.last_motion);
  EXPECT_EQ(a.linear_solver, b.linear_solver);
  expect_same(a.state, b.state);
  ASSERT_TRUE(a.last && b.last);
  EXPECT_EQ(a.last->from, b.last->from);
  EXPECT_EQ(a.last->to, b.last->to);
  expect_same(a.last->start, b.last->start);
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t c = 0; c < a.contacts.size(); ++c)
  {
    EXPECT_EQ(a.contacts[c].nodes, b.contacts[c].nodes);
    EXPECT_EQ(a.contacts[c].face_nodes, b.contacts[c].face_nodes);
    ASSERT_EQ(a.contacts[c].pairing.size(), b.contacts[c].pairing.size());
    for (std::size_t i = 0; i < a.contacts[c].pairing.size(); ++i)
    {
      EXPECT_EQ(a.contacts[c].pairing[i].face, b.contacts[c].pairing[i].face);
      EXPECT_EQ(a.contacts[c].pairing[i].gap, b.contacts[c].pairing[i].gap);
    }
    EXPECT_EQ(a.contacts[c].status, b.contacts[c].status);
    EXPECT_EQ(a.contacts[c].total_slip, b.contacts[c].total_slip);
  }
  EXPECT_EQ(a.cells.cells, b.cells.cells);
  EXPECT_EQ(a.cells.offset, b.cells.offset);
  EXPECT_EQ(a.cells.values, b.cells.values);
  EXPECT_EQ(a.counters.n_detections, b.counters.n_detections);
}

/// Nodes 5, 6 and the analytic body's point are on all processes, node 9 on the first two, the rest one by one, each
/// process's in an order of its own; cells one by one.
class CheckpointParts : public testing::Test
{
protected:
  CheckpointParts()
  {
    const auto here = [this](GlobalIndex k) { return k % all_.size() == all_.rank(); };
    mesh_.dim = dim;
    mesh_.n_global_nodes = n_nodes;
    mesh_.n_global_cells = n_cells;
    mesh_.node_ids = {5, 6};
    for (GlobalIndex id = n_nodes - 1; id >= 0; --id)
      if (id != 5 && id != 6 && (here(7 * id + 1) || (id == 9 && all_.rank() < 2)))
        mesh_.node_ids.push_back(id);
    if (all_.rank() % 2 == 1)
      std::reverse(mesh_.node_ids.begin() + 2, mesh_.node_ids.end());
    mesh_.node_tags = mesh_.node_ids;
    std::vector<GlobalIndex> ids = mesh_.node_ids;
    ids.push_back(n_nodes);
    for (const std::vector<GlobalIndex> &nodes : all_contact_nodes)
    {
      std::vector<GlobalIndex> &own = contact_nodes_.emplace_back();
      std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(own), here);
    }
    local_ = checkpoint_at(ids, contact_nodes_);
    for (GlobalIndex id = 0; id < n_cells; ++id)
      if (here(id))
      {
        add_history(local_.cells, static_cast<Index>(mesh_.cell_ids.size()), id);
        mesh_.cell_ids.push_back(id);
      }
    nodes_ = Sharing(all_.size() > 1 ? std::make_shared<MessageExchange>(all_) : nullptr, "nodes", ids);
  }

  /// On process 0. One process has the whole in its own order.
  [[nodiscard]] Checkpoint whole() const
  {
    if (all_.size() == 1)
      return local_;
    return all_.is_root() ? whole_checkpoint() : Checkpoint();
  }
  [[nodiscard]] Checkpoint own_part(const Checkpoint &from, std::uint64_t of = key) const
  {
    return part_of(from, of, mesh_, nodes_, nodes_.size(), contact_nodes_);
  }

  Communicator all_{MPI_COMM_WORLD};
  Mesh mesh_;
  Sharing nodes_;
  ContactNodes contact_nodes_;
  Checkpoint local_;
};

TEST_F(CheckpointParts, MakeTheWhole)
{
  const Checkpoint made = gathered(local_, mesh_, nodes_);
  if (all_.is_root())
    expect_same(made, whole());
}

TEST_F(CheckpointParts, ComeFromTheWhole)
{
  expect_same(own_part(whole()), local_);
}

TEST_F(CheckpointParts, OfAnotherProblemAreRefusedByAll)
{
  EXPECT_THROW(own_part(whole(), key + 1), UserError);
}

TEST_F(CheckpointParts, WorkIsCountedOnceByWhomeverTakesItOver)
{
  Checkpoint from = whole();
  from.counters.n_factorizations = 12;
  auto n = static_cast<double>(own_part(from).counters.n_factorizations);
  nodes_.sum_over_processes({&n, 1});
  EXPECT_EQ(n, 12);
}
} // namespace
} // namespace amontons

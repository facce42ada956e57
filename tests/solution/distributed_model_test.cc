// Run on one, two and three processes: a model that is spread over them against the whole one.
#include "amontons/solution/free_motions.h"
#include "amontons/solution/start.h"
#include "solution/problem.h"

#include <gmock/gmock.h>

#include <set>

namespace amontons::test
{
namespace
{
/// Something without symmetry, the same for a node wherever it is.
double value_at(GlobalIndex node, int component)
{
  return 1e-3 * std::sin(1.7 * static_cast<double>(node) + 0.9 * component);
}

std::vector<double> values(const Model &model)
{
  std::vector<double> out;
  for (Index node = 0; node < model.n_nodal() / model.dim(); ++node)
    for (int c = 0; c < model.dim(); ++c)
      out.push_back(value_at(model.node_id(node), c));
  return out;
}

/// Two blocks with other cells, the upper one held by springs and loaded in every way there is; a rigid sheet below.
Problem blocks()
{
  Blocks mesh(3);
  mesh.add("lower", {0, 0, 0}, {2, 2, 1}, {4, 3, 2});
  mesh.add("upper", {0.3, 0.2, 1.02}, {1, 1.2, 1}, {3, 3, 3});
  mesh.add_sheet("sheet", {-1, -1, -0.01}, {4, 0, 0}, {0, 4, 0}, {2, 2});
  mesh.add_sheet("loose", {5, 5, 5}, {1, 0, 0}, {0, 1, 0}, {1, 1}); // of no body: with process 0
  mesh.add_point("corner", {1.3, 1.4, 2.02});
  Problem problem(mesh, Kinematics::three_dimensional);
  problem.elastic("lower", 10);
  problem.elastic("upper", 3, 0.2);
  problem.rigid("sheet");
  problem.on("lower_left").fix = {0, 1};
  problem.on("upper_top").displacement[2] = expression("-0.05 * t + 0.01 * x");
  problem.on("upper_left").spring[0] = expression(0.4);
  problem.on("upper_front").pressure = expression(0.2);
  problem.on("upper_back").traction[1] = expression("0.1 * t");
  problem.on("upper").body_force[2] = expression(-0.3);
  problem.on("corner").force[0] = expression(0.7);
  problem.on("sheet").force[2] = expression(0.5);
  problem.contact("upper_bottom", "lower_top", 0.3);
  problem.contact("lower_bottom", "sheet");
  return problem;
}

class DistributedModel : public testing::Test
{
protected:
  /// Compares a nodal vector of the part with that of the whole.
  void expect_equal(const std::vector<double> &part, const std::vector<double> &whole)
  {
    double size = 0;
    for (const double x : whole)
      size = std::max(size, std::abs(x));
    const int dim = model_.dim();
    for (Index i = 0; i < model_.n_nodal(); ++i)
      ASSERT_NEAR(part[i], whole[static_cast<std::size_t>(model_.node_id(i / dim)) * dim + i % dim], 1e-13 * size);
  }
  /// Of numbers, one for each process.
  double sum(double value)
  {
    messages_->sum("test", {&value, 1});
    return value;
  }

  Problem problem_ = blocks();
  std::shared_ptr<MessageExchange> messages_ = std::make_shared<MessageExchange>(Communicator(MPI_COMM_WORLD));
  Model whole_{problem_.options}, model_{problem_.options, messages_};
};

TEST_F(DistributedModel, EachCellIsOnOneProcess)
{
  EXPECT_EQ(sum(model_.mesh().cells.size()), whole_.mesh().cells.size());
  for (Index cell = 0; cell < model_.mesh().cells.size(); ++cell)
  {
    const auto id = static_cast<Index>(model_.mesh().cell_ids[cell]);
    const auto nodes = model_.mesh().cells[cell], all = whole_.mesh().cells[id];
    ASSERT_EQ(nodes.size(), all.size());
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
      EXPECT_EQ(model_.mesh().node_ids[nodes[k]], all[k]);
      for (int c = 0; c < 3; ++c)
        EXPECT_EQ(model_.mesh().points[3 * nodes[k] + c], whole_.mesh().points[3 * all[k] + c]);
    }
    EXPECT_EQ(model_.bodies().body_of_cell()[cell], whole_.bodies().body_of_cell()[id]);
  }
  // Nobody has much more than his share.
  const double mean = whole_.mesh().cells.size() / static_cast<double>(messages_->communicator().size());
  EXPECT_LE(model_.mesh().cells.size(), 1.3 * mean);
}

TEST_F(DistributedModel, UnknownsAreNumberedAsOne)
{
  EXPECT_EQ(model_.n_global_unknowns(), whole_.n_global_unknowns());
  for (Index i = 0; i < model_.n_nodal(); ++i)
    EXPECT_EQ(model_.layout().terms(i).size(),
              whole_.layout().terms(static_cast<Index>(model_.node_id(i / 3)) * 3 + i % 3).size());
}

TEST_F(DistributedModel, ForcesAddUp)
{
  const auto forces = [&](Model &model)
  {
    std::vector<double> u = values(model), internal(u.size(), 0.0), external(u.size(), 0.0);
    EXPECT_TRUE(model.bodies().assemble_tangent(model.mesh_part(u), 0.7));
    EXPECT_TRUE(model.bodies().forces(model.mesh_part(u), 0.7, model.mesh_part(internal), model.mesh_part(external)));
    model.nodes().sum(internal, 3);
    model.nodes().sum(external, 3);
    return std::pair{internal, external};
  };
  const auto [internal, external] = forces(model_);
  const auto [all_internal, all_external] = forces(whole_);
  expect_equal(internal, all_internal);
  expect_equal(external, all_external);
  expect_equal(diagonal_stiffness(model_), diagonal_stiffness(whole_));
}

TEST_F(DistributedModel, SupportsAndReactionsAreThoseOfTheWhole)
{
  EXPECT_EQ(model_.prescribed_motion(0, 1), whole_.prescribed_motion(0, 1));
  const auto moved = [](const Model &model) { return model.prescribe(model.initial_state(), 0.4, 1).displacement; };
  expect_equal(moved(model_), moved(whole_));
  const std::vector<Reaction> part = model_.reactions(values(model_)), all = whole_.reactions(values(whole_));
  ASSERT_EQ(part.size(), all.size());
  for (std::size_t r = 0; r < part.size(); ++r)
  {
    EXPECT_EQ(part[r].region, all[r].region);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(part[r].force[c], all[r].force[c], 1e-13);
  }
}

TEST_F(DistributedModel, EachElementIsOnOneProcess)
{
  for (Model *model : {&model_, &whole_})
  {
    State state = model->initial_state();
    ASSERT_TRUE(model->bodies().assemble_tangent(model->mesh_part(state.displacement), 0));
    set_augmentation(*model, diagonal_stiffness(*model));
    detect_first(*model, state);
  }
  for (std::size_t k = 0; k < 2; ++k)
  {
    const ContactInterface &part = model_.contacts()[k], &all = whole_.contacts()[k];
    EXPECT_EQ(sum(part.n_nodes()), all.n_nodes());
    const auto &ids = all.impactor().node_ids;
    for (Index i = 0; i < part.n_nodes(); ++i)
    {
      const auto j = static_cast<Index>(std::find(ids.begin(), ids.end(), part.impactor().node_ids[i]) - ids.begin());
      EXPECT_EQ(part.pairing()[i].face, all.pairing()[j].face);
      EXPECT_NEAR(part.augmentation(i), all.augmentation(j), 1e-12 * all.augmentation(j));
      EXPECT_NEAR(part.areas()[i], all.areas()[j], 1e-14);
      const std::vector<Index> nodes = part.nodes(i), of_all = all.nodes(j);
      ASSERT_EQ(nodes.size(), of_all.size());
      for (std::size_t a = 0; a < nodes.size(); ++a)
        EXPECT_EQ(model_.node_id(nodes[a]), of_all[a]);
      for (const Index node : nodes)
        EXPECT_EQ(model_.reference(node), whole_.reference(static_cast<Index>(model_.node_id(node))));
    }
  }
}

/// Each face is on one process; the halo has what elements couple and no more.
TEST_F(DistributedModel, SurfacesAreSpread)
{
  State state = model_.initial_state();
  detect_first(model_, state);
  std::set<GlobalIndex> coupled;
  for (const ContactInterface &contact : model_.contacts())
    for (Index i = 0; i < contact.n_nodes(); ++i)
      for (const Index node : contact.nodes(i))
        if (node >= model_.n_state_nodes())
          coupled.insert(model_.node_id(node));
  EXPECT_EQ(static_cast<Index>(coupled.size()), model_.n_nodal() / 3 - model_.n_state_nodes());
  if (messages_->communicator().size() > 1)
    EXPECT_GT(sum(static_cast<double>(coupled.size())), 0);
  for (std::size_t k = 0; k < 2; ++k)
  {
    const ContactInterface &part = model_.contacts()[k], &all = whole_.contacts()[k];
    EXPECT_EQ(sum(part.impactor().n_faces()), all.impactor().n_faces());
    EXPECT_EQ(sum(part.target()->n_faces()), all.target()->n_faces());
  }
}

/// Where the upper block stands after it was moved over two faces, elements are those of the whole; the halo has other
/// nodes then.
TEST_F(DistributedModel, HaloFollowsThePairs)
{
  problem_.options.strain = Strain::finite;
  for (BodyOptions &body : problem_.options.bodies)
    if (body.material.law == MaterialLaw::linear_elastic)
      body.material.law = MaterialLaw::neo_hookean;
  Model whole(problem_.options), model(problem_.options, messages_);
  for (const double way : {0.0, 0.9})
    for (Model *one : {&whole, &model})
    {
      State state = one->initial_state();
      for (Index node = 0; node < one->n_state_nodes(); ++node)
        if (one->reference(node)[2] > 1.01)
          state.displacement[3 * static_cast<std::size_t>(node)] = way;
      (void)one->detect(state, std::vector<double>(one->contacts().size(), 0.1), false);
    }
  if (messages_->communicator().size() > 1)
    EXPECT_EQ(model.halo_version(), 2);
  const ContactInterface &part = model.contacts()[0], &all = whole.contacts()[0];
  const auto &ids = all.impactor().node_ids;
  for (Index i = 0; i < part.n_nodes(); ++i)
  {
    const auto j = static_cast<Index>(std::find(ids.begin(), ids.end(), part.impactor().node_ids[i]) - ids.begin());
    EXPECT_EQ(part.pairing()[i].face, all.pairing()[j].face);
    std::vector<GlobalIndex> nodes;
    for (const Index node : part.nodes(i))
    {
      nodes.push_back(model.node_id(node));
      EXPECT_EQ(model.reference(node), whole.reference(static_cast<Index>(nodes.back())));
    }
    EXPECT_THAT(nodes, testing::ElementsAreArray(all.nodes(j)));
  }
}

TEST_F(DistributedModel, HaloFollowsItsOwners)
{
  State state = model_.initial_state();
  detect_first(model_, state);
  for (Index i = 0; i < model_.n_state_nodes() * 3; ++i)
    state.displacement[i] = value_at(model_.node_id(i / 3), i % 3);
  EXPECT_EQ(model_.with_halo(state.displacement), values(model_));
}

TEST_F(DistributedModel, WhatMovesFreelyIsKnownToAll)
{
  EXPECT_EQ(FreeMotions(model_).any(), FreeMotions(whole_).any());
  problem_.options.contact.pop_back();
  const auto refusal = [&](std::shared_ptr<MessageExchange> messages) -> std::string
  {
    const Model model(problem_.options, std::move(messages));
    try
    {
      FreeMotions(model).check_restrained();
    }
    catch (const UserError &error)
    {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_THAT(refusal(nullptr), testing::HasSubstr("'sheet' can move freely"));
  EXPECT_EQ(refusal(messages_), refusal(nullptr));
}

TEST_F(DistributedModel, AnErrorOfOneIsAnErrorOfAll)
{
  problem_.on("loose").traction[0] = expression(1);
  EXPECT_THROW(Model(problem_.options, messages_), UserError);
  problem_.options.boundary.pop_back();
  problem_.options.contact[0].target = "lower_tob";
  EXPECT_THROW(Model(problem_.options, messages_), UserError);
}
} // namespace
} // namespace amontons::test

#include "amontons/solution/given_motions.h"

#include "problem.h"

#include <Eigen/Geometry>
#include <gmock/gmock.h>

/// Rigid motions that supports give to the bodies.
namespace amontons::test
{
namespace
{
/// Of supports that hold a node as a whole.
std::vector<int> all_components(int dim)
{
  return dim == 2 ? std::vector<int>{0, 1} : std::vector<int>{0, 1, 2};
}

/// Base and slider; the base is held below.
Problem two_blocks(int dim, Strain strain = Strain::finite)
{
  Blocks blocks(dim);
  blocks.add("base", {-1.3, -0.7, dim == 2 ? 0 : -0.5}, {2.3, 1.6, 0.5}, {5, 3, 2});
  blocks.add("slider", {-0.6, 1.1, dim == 2 ? 0 : 0.1}, {1.2, 0.7, 0.7}, {3, 2, 2});
  blocks.add_point("corner", dim == 2 ? Point(-0.6, 1.8, 0) : Point(-0.6, 1.1, 0.8));
  blocks.add_point("other corner", dim == 2 ? Point(0.6, 1.8, 0) : Point(0.6, 1.1, 0.8));
  Problem problem(blocks, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional, strain);
  problem.elastic("base");
  problem.elastic("slider", 2, 0.2);
  problem.on("base_bottom").fix = all_components(dim);
  return problem;
}

Eigen::Matrix3d some_rotation(int dim, double angle = 2.3)
{
  const Point axis = dim == 2 ? Point(0, 0, 1) : Point(0.3, -0.8, 0.5).normalized();
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

class States
{
public:
  explicit States(const Model &model)
    : model_(model)
    , state(model.initial_state())
  {
  }
  [[nodiscard]] Point place(Index node) const
  {
    Point x = model_.reference(node);
    for (int c = 0; c < model_.dim(); ++c)
      x[c] += state.displacement[static_cast<std::size_t>(node) * model_.dim() + c];
    return x;
  }
  void put(Index node, const Point &x)
  {
    for (int c = 0; c < model_.dim(); ++c)
      state.displacement[static_cast<std::size_t>(node) * model_.dim() + c] = x[c] - model_.reference(node)[c];
  }
  [[nodiscard]] Index n_nodes() const { return model_.n_state_nodes(); }

private:
  const Model &model_;

public:
  State state;
};

/// Something without symmetry, of size 1.
Point scatter(Index node)
{
  return {std::sin(1.7 * node + 0.3), std::sin(2.9 * node + 1.1), std::sin(0.7 * node + 2.3)};
}

/// Nodes of the slider are those above the gap.
bool is_of_slider(const Model &model, Index node)
{
  return model.dim() == 2 ? model.reference(node).y() > 1 : model.reference(node).z() > 0.05;
}

class GivenMotion : public testing::TestWithParam<int>
{
};

TEST_P(GivenMotion, IsThatOfTheHeldNodesWhateverTheOthersDo)
{
  const int dim = GetParam();
  Problem problem = two_blocks(dim);
  problem.on("slider_top").fix = all_components(dim);
  const Model model(problem.options);
  const GivenMotions given(model);
  States from(model), to(model);
  const Eigen::Matrix3d base = some_rotation(dim), slider = some_rotation(dim, -0.4);
  const Point shift = dim == 2 ? Point(3, -1, 0) : Point(3, -1, 2);
  for (Index node = 0; node < from.n_nodes(); ++node)
  {
    if (!given.is_held()[node])
      from.put(node, from.place(node) + 0.1 * scatter(node));
    to.put(node, (is_of_slider(model, node) ? slider : base) * from.place(node) + shift);
  }
  const std::vector<RigidMotion> motions = given.of_bodies(from.state, to.state);
  EXPECT_LT((motions[0].rotation - base).norm(), 1e-13);
  EXPECT_LT((motions[1].rotation - slider).norm(), 1e-13);
  EXPECT_LT(relative_difference(given.moved(from.state, motions).displacement, to.state.displacement), 1e-13);
  EXPECT_LT((given.of_observer(from.state, to.state).rotation - base).norm(), 1e-13); // it has more held nodes
  const Point x(0.3, 0.8, dim == 2 ? 0 : -0.4), y = x + motions[1].way(x);
  EXPECT_LT((y + motions[1].inverse().way(y) - x).norm(), 1e-14);
}

TEST_P(GivenMotion, IsTheProperOneWithTheLeastSquares)
{
  const int dim = GetParam();
  const Model model(two_blocks(dim).options);
  const GivenMotions given(model);
  const States from(model);
  States to(model);
  const Eigen::Matrix3d turned = some_rotation(dim);
  for (Index node = 0; node < to.n_nodes(); ++node)
    to.put(node, turned * (to.place(node) + 0.2 * scatter(node)));
  const RigidMotion best = given.of_observer(from.state, to.state);
  EXPECT_NEAR(best.rotation.determinant(), 1, 1e-14);
  const auto squares = [&](const RigidMotion &motion)
  {
    double sum = 0;
    for (Index node = 0; node < to.n_nodes(); ++node)
      if (given.is_held()[node])
        for (int c = 0; c < dim; ++c)
          sum += std::pow((from.place(node) + motion.way(from.place(node)) - to.place(node))[c], 2);
    return sum;
  };
  for (int axis = dim == 2 ? 2 : 0; axis < 3; ++axis)
    for (const double angle : {-2.0, -0.01, 0.01, 1.0})
    {
      RigidMotion other = best;
      other.rotation = Eigen::AngleAxisd(angle, Point::Unit(axis)) * best.rotation;
      EXPECT_GT(squares(other), squares(best));
    }
  for (int c = 0; c < dim; ++c)
    for (const double shift : {-0.01, 0.01})
    {
      RigidMotion other = best;
      other.translation[c] += shift;
      EXPECT_GT(squares(other), squares(best));
    }
}

TEST_P(GivenMotion, ABodyThatTellsNoRotationTurnsWithTheObserver)
{
  const int dim = GetParam();
  // In space two places are not enough.
  for (const std::vector<std::string> &supports : {{}, {"corner"}, std::vector<std::string>{"corner", "other corner"}})
  {
    if (dim == 2 && supports.size() == 2)
      continue;
    Problem problem = two_blocks(dim);
    for (const std::string &support : supports)
      problem.on(support).fix = all_components(dim);
    const Model model(problem.options);
    const GivenMotions given(model);
    const States from(model);
    States to(model);
    const Point apart = supports.empty() ? Point(0, 0, 0) : Point(0.4, 0.9, 0);
    for (Index node = 0; node < to.n_nodes(); ++node)
      to.put(node, some_rotation(dim) * to.place(node) + (is_of_slider(model, node) ? apart : Point(0, 0, 0)));
    EXPECT_LT(relative_difference(given.moved(from.state, given.of_bodies(from.state, to.state)).displacement,
                                  to.state.displacement),
              1e-13);
  }
}

INSTANTIATE_TEST_SUITE_P(All, GivenMotion, testing::Values(2, 3));

/// Of a whole problem that turns.
double angle_of_observer(const Problem &problem)
{
  const Model model(problem.options);
  const GivenMotions given(model);
  const States from(model);
  States to(model);
  for (Index node = 0; node < to.n_nodes(); ++node)
    to.put(node, some_rotation(2, 0.3) * to.place(node));
  return Eigen::AngleAxisd(given.of_observer(from.state, to.state).rotation).angle();
}

TEST(GivenMotions, TheObserverStandsStillWhereTheProblemTellsDirections)
{
  EXPECT_NEAR(angle_of_observer(two_blocks(2)), 0.3, 1e-14);
  EXPECT_EQ(angle_of_observer(two_blocks(2, Strain::small)), 0);
  Problem symmetric = two_blocks(2);
  symmetric.on("slider_left").fix = {0};
  EXPECT_EQ(angle_of_observer(symmetric), 0);
  Problem sprung = two_blocks(2);
  sprung.on("slider_left").spring[0] = expression(0.1);
  EXPECT_EQ(angle_of_observer(sprung), 0);
  Problem on_shape = two_blocks(2);
  on_shape.rigid("ground", ground(2, -2));
  EXPECT_EQ(angle_of_observer(on_shape), 0);
}
} // namespace
} // namespace amontons::test

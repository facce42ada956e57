#include "problem.h"

#include <gmock/gmock.h>

/// The answer, and Newton's way to it, must not depend on the frame that a problem is seen from, moving as it may.
namespace amontons::test
{
namespace
{
/// A frame that turns in the plane of the first and the last axis, at a speed that changes and changes its sign, and
/// shifts.
struct Frame
{
  bool moves;
  int dim;

  static double angle(double t) { return 1.1 * t + 0.4 * std::sin(9 * t); }
  [[nodiscard]] std::string cosine() const { return moves ? "cos(1.1*t+0.4*sin(9*t))" : "1"; }
  [[nodiscard]] std::string sine() const { return moves ? "sin(1.1*t+0.4*sin(9*t))" : "0"; }

  /// About z in the plane and y in space.
  [[nodiscard]] std::string turning() const
  {
    return moves ? std::string(dim == 2 ? "" : "-") + "(1.1*t+0.4*sin(9*t))" : "0";
  }

  /// A vector that the frame's own observer has as `vector`, expressions.
  [[nodiscard]] std::map<int, Expression> seen(std::vector<std::string> vector) const
  {
    const std::string first = vector.front(), last = vector.back();
    vector.front() = cosine() + "*(" + first + ")-" + sine() + "*(" + last + ")";
    vector.back() = sine() + "*(" + first + ")+" + cosine() + "*(" + last + ")";
    std::map<int, Expression> out;
    for (int c = 0; c < dim; ++c)
      out[c] = expression(vector[c]);
    return out;
  }
  /// The displacement of what moves by `load` in its own frame.
  [[nodiscard]] std::map<int, Expression> displacement(std::vector<std::string> load) const
  {
    const char *axes = "xyz";
    for (int c = 0; c < dim; ++c)
      load[c] = std::string(1, axes[c]) + "+" + load[c];
    std::map<int, Expression> out = seen(load);
    for (int c = 0; c < dim; ++c)
      out[c].text += std::string("-") + axes[c] + (moves ? "+" + std::to_string(c - 0.7) + "*t*t" : "");
    return out;
  }
  /// Vectors at the end, as the frame's own observer has them.
  [[nodiscard]] std::vector<double> back(std::vector<double> vectors) const
  {
    const double c = std::cos(moves ? angle(1) : 0), s = std::sin(moves ? angle(1) : 0);
    for (std::size_t first = 0; first < vectors.size(); first += dim)
    {
      double &x = vectors[first], &z = vectors[first + dim - 1];
      std::tie(x, z) = std::pair(c * x + s * z, -s * x + c * z);
    }
    return vectors;
  }
};

using Vector = std::vector<std::string>;

/// In the plane the first and the last component.
Vector components(const Frame &frame, const std::string &x, const std::string &y, const std::string &z)
{
  return frame.dim == 2 ? Vector{x, z} : Vector{x, y, z};
}

enum class Base
{
  deformable,
  coupled, ///< deformable, surface to surface
  rigid,
};

void add_base(Blocks &blocks, Base base, int dim)
{
  if (base != Base::rigid && dim == 2)
    blocks.add("base", {-1.5, -0.6, 0}, {3.1, 0.6, 0}, {16, 3, 0});
  else if (base != Base::rigid)
    blocks.add("base", {-1.1, -0.8, -0.5}, {2.3, 1.5, 0.5}, {7, 3, 1});
  else if (dim == 2)
    blocks.add_line("base", {{1.6, 0.1, 0}, {0.1, -0.03, 0}, {-1.5, 0.1, 0}}, 5);
  else
    blocks.add_sheet("base", {-1.1, -0.8, -0.02}, {2.3, 0, 0.02}, {0, 1.5, 0}, {7, 3});
}

/// A rounded slider pressed and dragged, a force of fixed direction on its rear side: nodes close, and go from face to
/// face.
Problem rounded_slider(const Frame &frame, Base base, double mu)
{
  const int dim = frame.dim;
  Blocks blocks(dim);
  add_base(blocks, base, dim);
  const auto rounded = [=](const Point &x)
  {
    Point out = x;
    out[dim - 1] += (1 - x[dim - 1]) * std::pow(x[0], 2) / 7;
    return out;
  };
  if (dim == 2)
    blocks.add("slider", {-0.56, 0, 0}, {1.21, 0.7, 0}, {9, 4, 0}, rounded);
  else
    blocks.add("slider", {-0.56, -0.41, 0}, {1.21, 0.7, 0.7}, {4, 2, 2}, rounded);
  Problem problem(blocks, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional, Strain::finite);
  problem.elastic("slider", 2, 0.2);
  if (base != Base::rigid)
    problem.elastic("base");
  else
    problem.rigid("base");
  problem.contact("slider_bottom", base == Base::rigid ? "base" : "base_top", mu).discretization =
      base == Base::coupled ? Discretization::mortar : Discretization::node_to_face;
  BoundaryOptions &ground = problem.on(base == Base::rigid ? "base" : "base_bottom");
  ground.displacement = frame.displacement(components(frame, "0", "0", "0"));
  if (base == Base::rigid)
    ground.rotation[dim == 2 ? 2 : 1] = expression(frame.turning());
  const std::string drag = "0.3*max(t-0.4,0)", press = base == Base::rigid ? "-0.15*min(t,0.4)" : "-0.25*min(t,0.4)";
  problem.on("slider_top").displacement = frame.displacement(components(frame, drag, "0.05*t", press));
  problem.on("slider_left").traction = frame.seen(components(frame, "0.02*t", "0.01*t", "0"));
  problem.options.loading.increments = 10;
  problem.options.loading.fixed = true;
  return problem;
}

class FrameIndifference : public testing::TestWithParam<std::tuple<int, Base, double>>
{
};

TEST_P(FrameIndifference, SameIterationsAndTheSameForces)
{
  const auto [dim, base, mu] = GetParam();
  const Frame still{false, dim}, moving{true, dim};
  const Record at_rest = rounded_slider(still, base, mu).converge(),
               moved = rounded_slider(moving, base, mu).converge();
  ASSERT_EQ(moved.states.size(), at_rest.states.size());
  EXPECT_EQ(moved.iterations(), at_rest.iterations());
  for (std::size_t k = 0; k < moved.states.size(); ++k)
    EXPECT_EQ(moved.states[k].contacts[0].status, at_rest.states[k].contacts[0].status) << "increment " << k;
  const ContactResult &a = moved.contact(), &b = at_rest.contact();
  EXPECT_LT(relative_difference(moving.back(a.force), b.force), 1e-9);
  EXPECT_LT(relative_difference(a.slip, b.slip), 1e-9);
  EXPECT_GT(b.n_stick + b.n_slip, dim == 2 ? 3 : 4);
}

INSTANTIATE_TEST_SUITE_P(All, FrameIndifference,
                         testing::Combine(testing::Values(2, 3),
                                          testing::Values(Base::deformable, Base::coupled, Base::rigid),
                                          testing::Values(0.0, 0.3)));
/// A block hollow below that forces press and push, and only friction holds; rigid, or not.
Problem loaded_block(const Frame &frame, bool rigid)
{
  const int dim = frame.dim;
  Blocks blocks(dim);
  add_base(blocks, Base::deformable, dim);
  const auto hollow = [=](const Point &x)
  {
    Point out = x;
    out[dim - 1] += (1 - x[dim - 1]) * (0.05 - (x[0] * x[0] + (dim == 3 ? x[1] * x[1] : 0)) / 40);
    return out;
  };
  if (dim == 2)
    blocks.add("slider", {-0.56, 0, 0}, {1.21, 0.7, 0}, {9, 4, 0}, hollow);
  else
    blocks.add("slider", {-0.56, -0.41, 0}, {1.21, 0.7, 0.7}, {4, 2, 2}, hollow);
  Problem problem(blocks, dim == 2 ? Kinematics::plane_strain : Kinematics::three_dimensional, Strain::finite);
  problem.elastic("base");
  problem.contact("slider_bottom", "base_top", 0.3);
  problem.on("base_bottom").displacement = frame.displacement(components(frame, "0", "0", "0"));
  const std::map<int, Expression> load =
      frame.seen(components(frame, "0.007*max(t-0.4,0)", "0.003*max(t-0.4,0)", "-0.08*min(t,0.4)"));
  if (rigid)
  {
    problem.rigid("slider");
    BoundaryOptions &slider = problem.on("slider");
    slider.force = load;
    for (int axis = dim == 2 ? 2 : 0; axis < 3; ++axis)
      slider.moment[axis] = expression(0);
  }
  else
  {
    problem.elastic("slider", 2, 0.2);
    problem.on("slider_top").traction = load;
  }
  problem.options.loading.increments = 10;
  return problem;
}

class FrameOfLoads : public testing::TestWithParam<std::tuple<int, bool>>
{
};

TEST_P(FrameOfLoads, SameIterationsAndTheSameForcesWhereOnlyContactHolds)
{
  const auto [dim, rigid] = GetParam();
  const Frame still{false, dim}, moving{true, dim};
  const Record at_rest = loaded_block(still, rigid).converge(), moved = loaded_block(moving, rigid).converge();
  ASSERT_EQ(moved.states.size(), at_rest.states.size());
  EXPECT_EQ(moved.iterations(), at_rest.iterations());
  const ContactResult &a = moved.contact(), &b = at_rest.contact();
  EXPECT_EQ(a.status, b.status);
  EXPECT_LT(relative_difference(moving.back(a.force), b.force), 1e-9);
  EXPECT_GT(b.n_stick + b.n_slip, dim == 2 ? 1 : 2);
}

INSTANTIATE_TEST_SUITE_P(All, FrameOfLoads, testing::Combine(testing::Values(2, 3), testing::Bool()));
} // namespace
} // namespace amontons::test

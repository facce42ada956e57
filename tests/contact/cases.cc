#include "measures.h"

#include <Eigen/Geometry>

namespace amontons::test
{
namespace
{
struct Kind
{
  std::string name;
  std::function<Case(unsigned, bool)> make;
};

const std::vector<Kind> &kinds()
{
  static const std::vector<Kind> all = []
  {
    std::vector<Kind> list;
    const auto add_face = [&](const std::string &name, int dim, int n_nodes)
    {
      list.push_back({name, [=](unsigned seed, bool slip) { return finite_case(dim, n_nodes, false, seed, slip); }});
      list.push_back({name + "_small", [=](unsigned seed, bool slip) { return small_case(dim, n_nodes, seed, slip); }});
    };
    add_face("segment", 2, 2);
    add_face("triangle", 3, 3);
    add_face("quadrilateral", 3, 4);
    list.push_back({"quadrilateral_far", [](unsigned seed, bool slip) { return finite_case(3, 4, true, seed, slip); }});
    const auto add_shape = [&](const std::string &name, int dim, ShapeType type, bool axisymmetric)
    {
      for (const bool small : {false, true})
        list.push_back({name + (small ? "_small" : ""), [=](unsigned seed, bool slip)
                        { return shape_case(dim, type, axisymmetric, small, seed, slip); }});
    };
    add_shape("line", 2, ShapeType::plane, false);
    add_shape("circle", 2, ShapeType::circle, false);
    add_shape("axisymmetric_sphere", 2, ShapeType::sphere, true);
    add_shape("axisymmetric_cone", 2, ShapeType::cone, true);
    add_shape("axisymmetric_cylinder", 2, ShapeType::cylinder, true);
    add_shape("plane", 3, ShapeType::plane, false);
    add_shape("cylinder", 3, ShapeType::cylinder, false);
    add_shape("sphere", 3, ShapeType::sphere, false);
    add_shape("cone", 3, ShapeType::cone, false);
    return list;
  }();
  return all;
}
} // namespace

double uniform(Random &random, double low, double high)
{
  return std::uniform_real_distribution<double>(low, high)(random);
}

Eigen::VectorXd random_vector(Random &random, int size, double low, double high)
{
  Eigen::VectorXd out(size);
  for (auto &component : out)
    component = uniform(random, low, high);
  return out;
}

Eigen::Matrix3d random_rotation(Random &random, int dim)
{
  const Eigen::Vector3d axis = dim == 2 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(random_vector(random, 3));
  return Eigen::AngleAxisd(uniform(random, -3, 3), axis.normalized()).toRotationMatrix();
}

const std::vector<std::string> &case_kinds()
{
  static const std::vector<std::string> names = []
  {
    std::vector<std::string> out;
    for (const auto &kind : kinds())
      out.push_back(kind.name);
    return out;
  }();
  return names;
}

std::vector<std::string> slipless_case_kinds()
{
  std::vector<std::string> out;
  for (const auto &name : case_kinds())
    if (name != "quadrilateral_far")
      out.push_back(name);
  return out;
}

Case make_case(const std::string &name, unsigned seed, bool with_slip)
{
  for (const auto &kind : kinds())
    if (kind.name == name)
      return kind.make(seed, with_slip);
  throw std::invalid_argument("no such kind of case: " + name);
}
} // namespace amontons::test

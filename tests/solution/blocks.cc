#include "blocks.h"

#include <algorithm>
#include <cstdio>

namespace amontons::test
{
namespace
{
std::string exact_text(double x)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

std::string facet_name(int dim, int axis, bool high)
{
  if (axis == dim - 1)
    return high ? "_top" : "_bottom";
  if (axis == 0)
    return high ? "_right" : "_left";
  return high ? "_back" : "_front";
}
} // namespace

int Blocks::add_node(const Point &x)
{
  points_.push_back(x);
  mesh_.nodes.push_back({exact_text(x[0]), exact_text(x[1]), exact_text(x[2])});
  return static_cast<int>(mesh_.nodes.size());
}

int Blocks::add_group(int dim, const std::string &name)
{
  mesh_.groups.emplace_back(dim, name);
  return static_cast<int>(mesh_.groups.size());
}

void Blocks::add(const std::string &name, const Point &low, const Point &size, std::array<int, 3> n, const Map &map)
{
  if (dim_ == 2)
    n[2] = 0;
  std::vector<int> numbers;
  for (int k = 0; k <= n[2]; ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i)
      {
        const Point share(double(i) / n[0], double(j) / n[1], dim_ == 3 ? double(k) / n[2] : 0);
        numbers.push_back(add_node(map(low + share.cwiseProduct(size))));
      }
  const auto node = [&](int i, int j, int k) { return numbers[(k * (n[1] + 1) + j) * (n[0] + 1) + i]; };
  const auto quadrilateral_nodes = [&](std::array<int, 3> at, int a, int b)
  {
    std::vector<int> out;
    for (const auto &[da, db] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
    {
      std::array<int, 3> c = at;
      c[a] += da;
      c[b] += db;
      out.push_back(node(c[0], c[1], c[2]));
    }
    return out;
  };
  const int cells = add_group(dim_, name);
  for (int k = 0; k < std::max(n[2], 1); ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
      {
        std::vector<int> nodes = quadrilateral_nodes({i, j, k}, 0, 1);
        if (dim_ == 3)
          for (const int top : quadrilateral_nodes({i, j, k + 1}, 0, 1))
            nodes.push_back(top);
        mesh_.elements.push_back({dim_ == 3 ? hexahedron : quadrilateral, cells, nodes});
      }
  for (int axis = 0; axis < dim_; ++axis)
    for (const bool high : {false, true})
    {
      const int group = add_group(dim_ - 1, name + facet_name(dim_, axis, high));
      const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
      for (int p = 0; p < n[a]; ++p)
        for (int q = 0; q < (dim_ == 3 ? n[b] : 1); ++q)
        {
          std::array<int, 3> at{0, 0, 0};
          at[axis] = high ? n[axis] : 0;
          at[a] = p;
          at[b] = dim_ == 3 ? q : 0;
          std::array<int, 3> next = at;
          ++next[a];
          if (dim_ == 3)
            mesh_.elements.push_back({quadrilateral, group, quadrilateral_nodes(at, a, b)});
          else
            mesh_.elements.push_back({line, group, {node(at[0], at[1], 0), node(next[0], next[1], 0)}});
        }
    }
}

void Blocks::add_line(const std::string &name, const std::vector<Point> &points, int n_per_part)
{
  const int group = add_group(1, name);
  int last = add_node(points[0]);
  for (std::size_t part = 1; part < points.size(); ++part)
    for (int i = 1; i <= n_per_part; ++i)
    {
      const int next = add_node(points[part - 1] + double(i) / n_per_part * (points[part] - points[part - 1]));
      mesh_.elements.push_back({line, group, {last, next}});
      last = next;
    }
}

void Blocks::add_union(const std::string &name, const std::vector<std::string> &groups,
                       const std::function<bool(const Point &middle)> &take)
{
  const int group = add_group(dim_ - 1, name);
  const std::size_t n_elements = mesh_.elements.size();
  for (std::size_t e = 0; e < n_elements; ++e)
  {
    HandMesh::Element element = mesh_.elements[e];
    Point middle = Point::Zero();
    for (const int node : element.nodes)
      middle += points_[static_cast<std::size_t>(node) - 1] / static_cast<double>(element.nodes.size());
    if (std::find(groups.begin(), groups.end(), mesh_.groups[static_cast<std::size_t>(element.group) - 1].second) ==
            groups.end() ||
        !take(middle))
      continue;
    element.group = group;
    mesh_.elements.push_back(element);
  }
}

void Blocks::add_sheet(const std::string &name, const Point &corner, const Point &first, const Point &second,
                       std::array<int, 2> n)
{
  const int group = add_group(2, name);
  std::vector<int> numbers;
  for (int j = 0; j <= n[1]; ++j)
    for (int i = 0; i <= n[0]; ++i)
      numbers.push_back(add_node(corner + double(i) / n[0] * first + double(j) / n[1] * second));
  for (int j = 0; j < n[1]; ++j)
    for (int i = 0; i < n[0]; ++i)
    {
      const int at = j * (n[0] + 1) + i;
      mesh_.elements.push_back(
          {quadrilateral, group, {numbers[at], numbers[at + 1], numbers[at + n[0] + 2], numbers[at + n[0] + 1]}});
    }
}

void Blocks::add_point(const std::string &name, const Point &place)
{
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < points_.size(); ++k)
    if ((points_[k] - place).norm() < (points_[nearest] - place).norm())
      nearest = k;
  mesh_.elements.push_back({point, add_group(0, name), {static_cast<int>(nearest) + 1}});
}
} // namespace amontons::test

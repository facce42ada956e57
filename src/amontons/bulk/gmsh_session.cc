#include "amontons/bulk/gmsh_session.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <gmsh.h>
#include <numeric>
#include <set>
#include <stdexcept>

namespace amontons
{
namespace
{
/// Gmsh throws its last message as a bare string.
template<typename Call>
auto translated(Call &&call)
{
  try
  {
    return call();
  }
  catch (const std::string &message)
  {
    throw std::runtime_error(message);
  }
}

bool is_supported(const std::string &family, int order)
{
  static const std::set<std::string> families{"Point",         "Line",        "Triangle",
                                              "Quadrilateral", "Tetrahedron", "Hexahedron"};
  return families.contains(family) && order <= 1;
}

/// @return the number of nodes
int check_element_type(int type)
{
  std::string name;
  int dim = 0, order = 0, n_nodes = 0, n_primary = 0;
  std::vector<double> coordinates;
  gmsh::model::mesh::getElementProperties(type, name, dim, order, n_nodes, coordinates, n_primary);
  const std::string family = name.substr(0, name.find(' '));
  if (is_supported(family, order))
    return n_nodes;
  if (is_supported(family, 1))
    throw std::runtime_error("has elements of type '" + name + "', of degree " + std::to_string(order) +
                             "; only degree 1 is supported: mesh with `Mesh.ElementOrder = 1`");
  throw std::runtime_error("has elements of type '" + name +
                           "'; supported are triangles, quadrilaterals, tetrahedra and hexahedra of degree 1");
}

/// A .msh 2 lists an element once for each physical group it belongs to.
bool repeats_elements(const std::string &file)
{
  std::ifstream in(file, std::ios::binary);
  std::string section, version;
  in >> section >> version;
  return section == "$MeshFormat" && version.starts_with("2");
}

GmshSession::Elements taken_in_order(const GmshSession::Elements &all, const std::vector<std::size_t> &order)
{
  GmshSession::Elements result;
  for (const std::size_t e : order)
  {
    result.tags.push_back(all.tags[e]);
    result.nodes.push_back(all.nodes[e]);
  }
  return result;
}

/// Of elements on the same nodes the one of smallest tag stays.
/// @param order by tag
std::vector<std::size_t> without_copies(const GmshSession::Elements &all, const std::vector<std::size_t> &order)
{
  std::vector<std::size_t> unique;
  std::set<std::vector<GlobalIndex>> seen;
  for (const std::size_t e : order)
  {
    std::vector<GlobalIndex> key = all.nodes[e];
    std::sort(key.begin(), key.end());
    if (seen.insert(std::move(key)).second)
      unique.push_back(e);
  }
  return unique;
}

/// A .msh 2 whose elements share an elementary tag but not their groups would be read wrongly: Gmsh gives all elements
/// of an entity to all its groups.
void check_copies(std::size_t n_listed, std::size_t n_unique, int dim, int entity)
{
  std::vector<int> groups;
  gmsh::model::getPhysicalGroupsForEntity(dim, entity, groups);
  if (n_listed != n_unique * std::max<std::size_t>(groups.size(), 1))
    throw std::runtime_error("elements of the elementary entity " + std::to_string(entity) + " (dimension " +
                             std::to_string(dim) + ") belong to different physical groups; give each group its own " +
                             "elementary tag, or save the mesh as .msh 4.1");
}

void start_silently(int n_arguments, char **arguments)
{
  gmsh::initialize(n_arguments, arguments, false);
  gmsh::option::setNumber("General.Terminal", 0);
}
} // namespace

GmshSession::GmshSession(const std::map<std::string, double> &parameters)
{
  std::vector<std::string> words{"amontons"};
  for (const auto &[name, value] : parameters)
  {
    char number[32];
    std::snprintf(number, sizeof number, "%.17g", value);
    words.insert(words.end(), {"-setnumber", name, number});
  }
  std::vector<char *> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string &word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  // Gmsh keeps the variables of a .geo beyond its own end; only clear() forgets them.
  start_silently(0, nullptr);
  gmsh::clear();
  gmsh::finalize();
  start_silently(static_cast<int>(words.size()), arguments.data());
}

GmshSession::~GmshSession()
{
  gmsh::finalize();
}

void GmshSession::open(const std::string &file)
{
  // Not gmsh::open(), which brings back the parameters of earlier sessions.
  translated([&] { gmsh::merge(file); });
  repeats_elements_ = repeats_elements(file);
}

void GmshSession::generate(int dim, int n_refinements)
{
  translated(
      [&]
      {
        gmsh::model::mesh::generate(dim);
        for (int i = 0; i < n_refinements; ++i)
          gmsh::model::mesh::refine();
      });
}

std::map<std::string, GmshSession::PhysicalGroup> GmshSession::named_groups() const
{
  return translated(
      []
      {
        std::map<std::string, PhysicalGroup> groups;
        gmsh::vectorpair dim_tags;
        gmsh::model::getPhysicalGroups(dim_tags);
        for (const auto &[dim, tag] : dim_tags)
        {
          std::string name;
          gmsh::model::getPhysicalName(dim, tag, name);
          if (name.empty())
            continue;
          PhysicalGroup group{dim, {}};
          gmsh::model::getEntitiesForPhysicalGroup(dim, tag, group.entities);
          std::sort(group.entities.begin(), group.entities.end());
          if (const auto [other, is_new] = groups.emplace(name, group); !is_new)
            throw std::runtime_error("has two physical groups named '" + name + "' (of dimension " +
                                     std::to_string(other->second.dim) + " and " + std::to_string(dim) +
                                     "); names must be unique");
        }
        return groups;
      });
}

GmshSession::Elements GmshSession::elements(int dim, int entity) const
{
  return translated(
      [&]
      {
        std::vector<int> types;
        std::vector<std::vector<std::size_t>> tags, nodes;
        gmsh::model::mesh::getElements(types, tags, nodes, dim, entity);
        Elements all;
        for (std::size_t t = 0; t < types.size(); ++t)
        {
          const auto n = static_cast<std::size_t>(check_element_type(types[t]));
          all.tags.insert(all.tags.end(), tags[t].begin(), tags[t].end());
          for (std::size_t e = 0; e < tags[t].size(); ++e)
          {
            const auto first = nodes[t].begin() + static_cast<std::ptrdiff_t>(e * n);
            all.nodes.emplace_back(first, first + static_cast<std::ptrdiff_t>(n));
          }
        }
        std::vector<std::size_t> order(all.tags.size());
        std::iota(order.begin(), order.end(), 0);
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return all.tags[a] < all.tags[b]; });
        if (!repeats_elements_)
          return taken_in_order(all, order);
        const std::vector<std::size_t> unique = without_copies(all, order);
        check_copies(order.size(), unique.size(), dim, entity);
        return taken_in_order(all, unique);
      });
}

std::vector<std::pair<GlobalIndex, std::array<double, 3>>> GmshSession::nodes() const
{
  return translated(
      []
      {
        std::vector<std::size_t> tags;
        std::vector<double> x, parametric;
        gmsh::model::mesh::getNodes(tags, x, parametric, -1, -1, false, false);
        std::vector<std::pair<GlobalIndex, std::array<double, 3>>> result;
        result.reserve(tags.size());
        for (std::size_t i = 0; i < tags.size(); ++i)
          result.push_back({static_cast<GlobalIndex>(tags[i]), {x[3 * i], x[3 * i + 1], x[3 * i + 2]}});
        std::sort(result.begin(), result.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
        return result;
      });
}
} // namespace amontons

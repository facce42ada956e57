#pragma once
#include "amontons/bulk/mesh.h"

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace amontons
{
/// Gmsh's one global model, from its start to its end. Silent; reads no configuration of the user's, so that a .geo
/// gives the same mesh everywhere. Only one at a time.
class GmshSession
{
public:
  /// Elements of one entity of the model, each once; nodes by their tags.
  struct Elements
  {
    std::vector<GlobalIndex> tags;
    std::vector<std::vector<GlobalIndex>> nodes;
  };
  struct PhysicalGroup
  {
    int dim = 0;
    std::vector<int> entities;
  };

  /// @param parameters numbers that DefineConstant of a .geo then leaves as they are
  explicit GmshSession(const std::map<std::string, double> &parameters);
  ~GmshSession();
  GmshSession(const GmshSession &) = delete;
  GmshSession &operator=(const GmshSession &) = delete;

  /// All of these @throw std::runtime_error with Gmsh's own words.
  void open(const std::string &file);
  /// Meshes the open geometry up to cells of dimension dim; new nodes of the refinements lie on the geometry.
  void generate(int dim, int n_refinements);
  /// Named groups. @throws also where one name stands for two groups
  [[nodiscard]] std::map<std::string, PhysicalGroup> named_groups() const;
  /// By increasing tag.
  /// @throws also where an element is not a point, segment, triangle, quadrilateral, tetrahedron or hexahedron of
  /// degree 1
  [[nodiscard]] Elements elements(int dim, int entity) const;
  /// Tag and x, y, z of all nodes, by increasing tag.
  [[nodiscard]] std::vector<std::pair<GlobalIndex, std::array<double, 3>>> nodes() const;

private:
  bool repeats_elements_ = false; ///< the open file lists an element once per physical group
};

/// Names that the DefineConstant[...] of a .geo, and of the files it includes, declare.
/// @throws std::runtime_error where a file cannot be read
std::vector<std::string> geo_parameters(const std::string &file);
} // namespace amontons

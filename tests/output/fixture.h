#pragma once
#include "amontons/solution/results.h"
#include "temporary_folder.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

namespace amontons
{
/// Two unit squares side by side (a quadrilateral and two triangles), a rigid segment below, and the lower edge as
/// impactor; every number is different, so that one in the wrong place is found.
struct Example
{
  Mesh mesh;
  Surface surface;
  Sharing nodes{8};
  SolutionState state;

  Example();
  Example(const Example &) = delete; // `state` points into it
};

inline Example::Example()
{
  mesh.dim = 2;
  mesh.points = {0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1, 0, -1, 2, -1};
  mesh.node_tags = {11, 12, 13, 21, 22, 23, 31, 32};
  const auto add = [](Connectivity &entities, std::initializer_list<Index> nodes)
  { entities.push_back(std::vector<Index>(nodes)); };
  add(mesh.cells, {0, 1, 4, 3});
  add(mesh.cells, {1, 2, 5});
  add(mesh.cells, {1, 5, 4});
  mesh.cell_tags = {1, 2, 3};
  number_whole(mesh);
  Group block{2, {}, {1, 2}};
  add(block.entities, {1, 2, 5});
  add(block.entities, {1, 5, 4});
  Group floor{1, {}, {}};
  add(floor.entities, {6, 7});
  mesh.groups = {{"block", block}, {"floor", floor}};

  surface.dim = 2;
  surface.node_ids = {2, 1, 0};
  surface.reference = {2, 0, 1, 0, 0, 0};
  surface.face_offsets = {0, 2, 4};
  surface.face_nodes = {1, 0, 2, 1};
  surface.face_ids = {0, 1};

  ContactResult contact;
  contact.name = "block/floor";
  contact.impactor = &surface;
  contact.nodes = {2, 1, 0};
  contact.n_own = 3;
  contact.n_nodes = 3;
  contact.gap = {0.125, -1e-17, std::numeric_limits<double>::infinity()};
  contact.pressure = {0, 1.0 / 3, 2};
  contact.traction = {0, 0.1, -0.2};
  contact.slip = {0, 0.01, 0.02};
  contact.status = {ContactStatus::open, ContactStatus::stick, ContactStatus::slip};
  contact.force = {0, 0, 0.1, 1.0 / 3, -0.1, 1};
  contact.area = {0.5, 1, 0.5};
  contact.n_active = 2;
  contact.n_stick = 1;
  contact.n_slip = 1;
  contact.normal_force = {0, 4.0 / 3, 0};
  contact.tangential_force = {0.25, 0, 0};
  contact.max_pressure = 2;
  contact.min_gap = -1e-17;
  contact.contact_area = 1.5;

  state.mesh = &mesh;
  state.nodes = &nodes;
  state.displacement = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 0, 0, 0, 0};
  state.stress = {1, 2, 3, 4, 5, 6, 10, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0};
  state.contacts = {contact};
  state.reactions = {{"top", {0.5, -2, 0}}};
}

using test::TemporaryFolder;

inline std::string content_of(const std::filesystem::path &file)
{
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}
} // namespace amontons

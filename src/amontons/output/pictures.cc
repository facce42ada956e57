#include "amontons/output/pictures.h"

#include "amontons/parallel/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace amontons
{
namespace
{
/// Components xx, yy, zz, xy, yz, xz.
double von_mises(std::span<const double, 6> s)
{
  const double normal = std::pow(s[0] - s[1], 2) + std::pow(s[1] - s[2], 2) + std::pow(s[2] - s[0], 2);
  const double shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
  return std::sqrt(normal / 2 + 3 * shear);
}

/// What a grid of bodies shows of the mesh.
struct Shown
{
  std::vector<CellShape> shapes;
  Connectivity cells;                     ///< the mesh's, then the facets of bodies that have no cells
  std::vector<std::int64_t> body_of_cell; ///< position in the deck, -1 for none
  std::vector<Index> nodes;               ///< of these cells, or owned by this process
};

void add_cells(Shown &shown, int dim, const Connectivity &cells)
{
  for (Index cell = 0; cell < cells.size(); ++cell)
  {
    shown.shapes.push_back(cell_shape(dim, cells[cell].size()));
    shown.cells.push_back(cells[cell]);
  }
}

Shown shown(const Mesh &mesh, const Sharing &nodes, const std::vector<BodyOptions> &bodies)
{
  Shown out;
  add_cells(out, mesh.dim, mesh.cells);
  out.body_of_cell.assign(out.shapes.size(), -1);
  for (std::size_t body = 0; body < bodies.size(); ++body)
  {
    const auto found = mesh.groups.find(bodies[body].region);
    if (found == mesh.groups.end()) // an analytic shape
      continue;
    const Group &group = found->second;
    for (const Index cell : group.cells)
      out.body_of_cell[cell] = static_cast<std::int64_t>(body);
    if (group.dim < mesh.dim)
      add_cells(out, group.dim, group.entities);
    out.body_of_cell.resize(out.shapes.size(), static_cast<std::int64_t>(body));
  }
  std::vector<char> wanted(static_cast<std::size_t>(mesh.n_nodes()), 0);
  for (const Index node : out.cells.nodes)
    wanted[node] = 1;
  for (Index node = 0; node < mesh.n_nodes(); ++node)
    if (wanted[node] != 0 || nodes.is_own(node))
      out.nodes.push_back(node);
  return out;
}

/// Entries of an array over the mesh's nodes, n_components to a node.
template<class T>
std::vector<T> of_nodes(const std::vector<T> &values, std::span<const Index> nodes, int n_components)
{
  std::vector<T> out;
  out.reserve(nodes.size() * n_components);
  for (const Index node : nodes)
  {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(node) * n_components;
    out.insert(out.end(), first, first + n_components);
  }
  return out;
}

VtuGrid grid_of(const Mesh &mesh, const Shown &shown)
{
  VtuGrid grid(mesh.dim, of_nodes(mesh.points, shown.nodes, mesh.dim));
  std::vector<Index> position(static_cast<std::size_t>(mesh.n_nodes()), -1);
  for (std::size_t i = 0; i < shown.nodes.size(); ++i)
    position[shown.nodes[i]] = static_cast<Index>(i);
  std::vector<Index> nodes;
  for (Index cell = 0; cell < shown.cells.size(); ++cell)
  {
    nodes.clear();
    for (const Index node : shown.cells[cell])
      nodes.push_back(position[node]);
    grid.add_cell(shown.shapes[cell], nodes);
  }
  return grid;
}

bool is_plastic(const BodyOptions &body)
{
  return body.material.law == MaterialLaw::von_mises;
}

/// A gap that is not known has no number: NaN, as infinity would spoil the range of colours.
std::vector<double> known_or_nan(std::vector<double> values)
{
  std::replace_if(
      values.begin(), values.end(), [](double v) { return !std::isfinite(v); },
      std::numeric_limits<double>::quiet_NaN());
  return values;
}
} // namespace

VtuGrid body_grid(const SolutionState &state, const std::vector<BodyOptions> &bodies,
                  const std::vector<OutputField> &fields)
{
  const Mesh &mesh = *state.mesh;
  const auto wanted = [&](OutputField field) { return std::find(fields.begin(), fields.end(), field) != fields.end(); };

  const Shown what = shown(mesh, *state.nodes, bodies);
  VtuGrid grid = grid_of(mesh, what);
  grid.add_point_data("node", of_nodes(mesh.node_tags, what.nodes, 1));
  if (wanted(OutputField::displacement))
    grid.add_point_data("displacement", 3, in_space(mesh.dim, of_nodes(state.displacement, what.nodes, mesh.dim)));
  grid.add_cell_data("body", what.body_of_cell);
  if (wanted(OutputField::stress))
  {
    std::vector<double> stress = state.stress;
    stress.resize(grid.n_cells() * 6, 0.0); // facets of rigid bodies carry none
    std::vector<double> equivalent;
    for (std::size_t cell = 0; cell < grid.n_cells(); ++cell)
      equivalent.push_back(von_mises(std::span(stress).subspan(cell * 6).first<6>()));
    grid.add_cell_data("stress", 6, stress, "xx,yy,zz,xy,yz,xz");
    grid.add_cell_data("von_mises", 1, equivalent);
  }
  // Asked of the deck, as the pieces of all processes are to hold the same fields.
  if (wanted(OutputField::plastic_strain) && std::any_of(bodies.begin(), bodies.end(), is_plastic))
  {
    std::vector<double> strain = state.plastic_strain;
    strain.resize(grid.n_cells(), 0.0);
    grid.add_cell_data("plastic_strain", 1, strain);
  }
  return grid;
}

VtuGrid contact_grid(const ContactResult &contact, const SolutionState &state)
{
  const Surface &surface = *contact.impactor;
  const int dim = contact.dim;
  VtuGrid grid(dim, surface.reference);
  for (Index face = 0; face < surface.n_faces(); ++face)
    grid.add_cell(cell_shape(dim - 1, surface.face(face).size()), surface.face(face));

  std::vector<std::int64_t> tags, statuses;
  std::vector<double> displacement;
  for (std::size_t i = 0; i < surface.node_ids.size(); ++i)
  {
    const auto node = static_cast<std::size_t>(contact.nodes[i]);
    tags.push_back(state.mesh->node_tags[node]);
    statuses.push_back(static_cast<std::int64_t>(contact.status[i]));
    const auto of_node = std::span(state.displacement).subspan(node * dim, dim);
    displacement.insert(displacement.end(), of_node.begin(), of_node.end());
  }
  grid.add_point_data("node", tags);
  grid.add_point_data("displacement", 3, in_space(dim, displacement));
  grid.add_point_data("status", statuses);
  grid.add_point_data("gap", 1, known_or_nan(contact.gap));
  grid.add_point_data("pressure", 1, contact.pressure);
  grid.add_point_data("traction", dim - 1, contact.traction);
  grid.add_point_data("slip", dim - 1, contact.slip);
  grid.add_point_data("force", 3, in_space(dim, contact.force));
  grid.add_point_data("area", 1, contact.area);
  return grid;
}

Pictures::Pictures(const ResultFolder &folder, OutputOptions options, std::vector<BodyOptions> bodies)
  : folder_(folder)
  , options_(std::move(options))
  , bodies_(std::move(bodies))
{
}

void Pictures::resume(Series earlier)
{
  series_ = std::move(earlier);
  for (auto &[stem, files] : series_)
    std::erase_if(files, [this](const auto &entry) { return !std::filesystem::exists(folder_.path() / entry.second); });
}

void Pictures::start(const SolutionState &initial, std::int64_t /*n_dofs*/)
{
  if (initial.increment > 0) // a run that goes on
  {
    last_written_ = initial.increment;
    if (folder_.communicator().is_root())
      folder_.remove_pictures_after(initial.increment);
  }
  else if (options_.every > 0)
    write(initial);
}

void Pictures::accepted(const IncrementReport & /*report*/, const SolutionState &state)
{
  if (options_.every > 0 && state.increment % options_.every == 0)
    write(state);
}

void Pictures::finish(const SolutionState &last, const Counters & /*counters*/, const Timers & /*timers*/,
                      const std::string & /*failure*/)
{
  if (options_.every > 0 && last.increment != last_written_)
    write(last);
}

void Pictures::write(const SolutionState &state)
{
  last_written_ = state.increment;
  add("solution", state,
      write_grid(picture_name("solution", state.increment), body_grid(state, bodies_, options_.fields)));
  for (const ContactResult &contact : state.contacts)
  {
    const std::string stem = contact_file_stem(contact.name);
    add(stem, state, write_grid(picture_name(stem, state.increment), contact_grid(contact, state)));
  }
}

std::string Pictures::write_grid(const std::string &name, const VtuGrid &grid) const
{
  const Communicator &all = folder_.communicator();
  if (all.size() == 1)
  {
    folder_.write(name + ".vtu", grid.text());
    return name + ".vtu";
  }
  std::vector<std::string> pieces;
  for (Rank rank = 0; rank < all.size(); ++rank)
    pieces.push_back(fmt::format("{}_{}.vtu", name, rank));
  agree_on_errors(all, [&] { folder_.write(pieces[all.rank()], grid.text()); });
  if (all.is_root())
    folder_.write(name + ".pvtu", grid.text_of_pieces(pieces));
  return name + ".pvtu";
}

void Pictures::add(const std::string &stem, const SolutionState &state, const std::string &file)
{
  if (!folder_.communicator().is_root())
    return;
  series_[stem].emplace_back(state.time, file);
  folder_.write(stem + ".pvd", pvd_text(series_[stem]));
}
} // namespace amontons

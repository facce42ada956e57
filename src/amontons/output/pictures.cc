#include "amontons/output/pictures.h"

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

/// Adds the mesh's cells, then the facets of bodies that have no cells. @return the body of each
std::vector<std::int64_t> add_cells(VtuGrid &grid, const Mesh &mesh, const std::vector<BodyOptions> &bodies)
{
  std::vector<std::int64_t> body_of_cell(static_cast<std::size_t>(mesh.cells.size()), -1);
  for (Index cell = 0; cell < mesh.cells.size(); ++cell)
    grid.add_cell(cell_shape(mesh.dim, mesh.cells[cell].size()), mesh.cells[cell]);
  for (std::size_t body = 0; body < bodies.size(); ++body)
  {
    const auto found = mesh.groups.find(bodies[body].region);
    if (found == mesh.groups.end()) // an analytic shape
      continue;
    const Group &group = found->second;
    for (const Index cell : group.cells)
      body_of_cell[cell] = static_cast<std::int64_t>(body);
    if (group.dim == mesh.dim)
      continue;
    for (Index facet = 0; facet < group.entities.size(); ++facet)
    {
      grid.add_cell(cell_shape(group.dim, group.entities[facet].size()), group.entities[facet]);
      body_of_cell.push_back(static_cast<std::int64_t>(body));
    }
  }
  return body_of_cell;
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

  VtuGrid grid(mesh.dim, mesh.points);
  const std::vector<std::int64_t> body_of_cell = add_cells(grid, mesh, bodies);
  grid.add_point_data("node", mesh.node_tags);
  if (wanted(OutputField::displacement))
    grid.add_point_data("displacement", 3, in_space(mesh.dim, state.displacement));
  grid.add_cell_data("body", body_of_cell);
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
  if (wanted(OutputField::plastic_strain) && !state.plastic_strain.empty())
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
    const auto node = static_cast<std::size_t>(surface.node_ids[i]);
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
    last_written_ = initial.increment;
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
  add("solution", state, body_grid(state, bodies_, options_.fields));
  for (const ContactResult &contact : state.contacts)
    add(contact_file_stem(contact.name), state, contact_grid(contact, state));
  last_written_ = state.increment;
}

void Pictures::add(const std::string &stem, const SolutionState &state, const VtuGrid &grid)
{
  const std::string file = fmt::format("{}_{:05d}.vtu", stem, state.increment);
  folder_.write(file, grid.text());
  series_[stem].emplace_back(state.time, file);
  folder_.write(stem + ".pvd", pvd_text(series_[stem]));
}
} // namespace amontons

#include "amontons/bulk/assembly.h"

#include "amontons/bulk/cell_block.h"
#include "amontons/bulk/loads.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace amontons
{
namespace
{
std::string cell_name(const Mesh &mesh, Index cell)
{
  return "cell " + std::to_string(mesh.cell_tags[cell]);
}

/// Physical groups a cell is in, for a message.
std::string groups_of(const Mesh &mesh, Index cell)
{
  std::string names;
  for (const auto &[name, group] : mesh.groups)
    if (std::find(group.cells.begin(), group.cells.end(), cell) != group.cells.end())
      names += (names.empty() ? "'" : ", '") + name + "'";
  return names.empty() ? "no physical group" : "the physical group " + names;
}

/// Body of each cell; rigid bodies may consist of facets, or of no mesh at all.
std::vector<Index> find_bodies(const Mesh &mesh, const std::vector<BodyOptions> &bodies)
{
  std::vector<Index> body_of_cell(static_cast<std::size_t>(mesh.cells.size()), -1);
  for (std::size_t b = 0; b < bodies.size(); ++b)
  {
    const BodyOptions &body = bodies[b];
    const bool rigid = body.material.law == MaterialLaw::rigid;
    if (rigid && body.region.empty())
      continue;
    for (const Index c : find_group(mesh, body.region, rigid ? -1 : mesh.dim, body.where).cells)
    {
      if (body_of_cell[c] >= 0)
        throw UserError(body.where, cell_name(mesh, c) + " belongs to two bodies, '" + bodies[body_of_cell[c]].name +
                                        "' and '" + body.name + "'");
      body_of_cell[c] = static_cast<Index>(b);
    }
  }
  const auto lost = std::find(body_of_cell.begin(), body_of_cell.end(), -1);
  if (lost != body_of_cell.end())
  {
    const auto n_lost = std::count(lost, body_of_cell.end(), -1);
    const Index cell = static_cast<Index>(lost - body_of_cell.begin());
    throw UserError({mesh.file, 0, 0},
                    cell_name(mesh, cell) +
                        (n_lost > 1 ? " and " + std::to_string(n_lost - 1) + " more belong" : std::string(" belongs")) +
                        " to no body of the deck; it is in " + groups_of(mesh, cell));
  }
  return body_of_cell;
}

std::vector<Index> deformable_only(std::vector<Index> body_of_cell, const std::vector<BodyOptions> &bodies)
{
  for (Index &body : body_of_cell)
    if (bodies[body].material.law == MaterialLaw::rigid)
      body = -1;
  return body_of_cell;
}

std::vector<SubdomainMatrix> patterns(const Mesh &mesh, std::span<const Index> deformable_body_of_cell,
                                      std::span<const Index> subdomain_of_cell)
{
  std::vector<bool> taken;
  for (const Index body : deformable_body_of_cell)
    taken.push_back(body >= 0);
  return make_patterns(mesh, taken, subdomain_of_cell);
}

bool mean_dilatation(const BodyOptions &body, CellShape shape, Kinematics kinematics)
{
  if (kinematics == Kinematics::plane_stress)
  {
    if (body.mean_dilatation.value_or(false))
      throw UserError(body.where,
                      "body '" + body.name + "': mean_dilatation has no place in plane stress, which does not lock");
    return false;
  }
  return body.mean_dilatation.value_or(shape == CellShape::quadrilateral || shape == CellShape::hexahedron);
}
} // namespace

struct BodyAssembly::Impl
{
  Impl(const Mesh &mesh, Kinematics kinematics, Strain strain_, const std::vector<BodyOptions> &bodies,
       const std::vector<BoundaryOptions> &boundary, std::span<const Index> subdomain_of_cell);
  void make_blocks(const Mesh &mesh, Kinematics kinematics, const std::vector<BodyOptions> &bodies,
                   std::span<const Index> subdomain_of_cell);
  bool add_cell_forces(bool of_linear, std::span<const double> displacement, std::span<double> force) const;
  bool add_cell_tangents(bool of_linear, std::span<const double> displacement);
  [[nodiscard]] bool has_blocks(bool of_linear) const;
  void start_tangent();

  Strain strain;
  std::vector<double> points;
  std::vector<Index> body_of_cell, deformable_body_of_cell;
  std::vector<SubdomainMatrix> subdomains;
  std::vector<SubdomainMatrix> linear; ///< what linear laws give to `subdomains`, where other things give to them too
  std::vector<std::unique_ptr<CellBlock>> blocks;
  Loads loads;
  bool assembled = false;
};

BodyAssembly::Impl::Impl(const Mesh &mesh, Kinematics kinematics, Strain strain_,
                         const std::vector<BodyOptions> &bodies, const std::vector<BoundaryOptions> &boundary,
                         std::span<const Index> subdomain_of_cell)
  : strain(strain_)
  , points(mesh.points)
  , body_of_cell(find_bodies(mesh, bodies))
  , deformable_body_of_cell(deformable_only(body_of_cell, bodies))
  , subdomains(patterns(mesh, deformable_body_of_cell, subdomain_of_cell))
  , loads({mesh.dim, kinematics == Kinematics::axisymmetric, points}, strain,
          LoadRegions(mesh, bodies, deformable_body_of_cell, subdomain_of_cell), boundary, subdomains)
{
  make_blocks(mesh, kinematics, bodies, subdomain_of_cell);
}

void BodyAssembly::Impl::make_blocks(const Mesh &mesh, Kinematics kinematics, const std::vector<BodyOptions> &bodies,
                                     std::span<const Index> subdomain_of_cell)
{
  if (mesh.dim != (kinematics == Kinematics::three_dimensional ? 3 : 2))
    throw UserError({mesh.file, 0, 0}, "the mesh has dimension " + std::to_string(mesh.dim) +
                                           ", which does not go with the deck's 'kinematics'");
  std::map<std::tuple<Index, Index, CellShape>, CellList> lists;
  for (Index c = 0; c < mesh.cells.size(); ++c)
  {
    const Index body = deformable_body_of_cell[c];
    if (body < 0)
      continue;
    const Index subdomain = subdomain_of_cell.empty() ? 0 : subdomain_of_cell[c];
    CellList &list = lists[{subdomain, body, cell_shape(mesh.dim, mesh.cells[c].size())}];
    list.cells.push_back(c);
    list.nodes.insert(list.nodes.end(), mesh.cells[c].begin(), mesh.cells[c].end());
  }
  for (auto &[key, list] : lists)
  {
    const auto [subdomain, body, shape] = key;
    list.subdomain = subdomain;
    list.moduli = elastic_moduli(bodies[body], strain);
    if (bodies[body].material.law == MaterialLaw::von_mises)
      list.hardening = hardening(bodies[body], strain);
    list.mean_dilatation = mean_dilatation(bodies[body], shape, kinematics);
    blocks.push_back(make_cell_block(shape, kinematics, strain, std::move(list), points, subdomains[subdomain]));
  }
}

bool BodyAssembly::Impl::has_blocks(bool of_linear) const
{
  return std::any_of(blocks.begin(), blocks.end(), [&](const auto &block) { return block->is_linear() == of_linear; });
}

bool BodyAssembly::Impl::add_cell_forces(bool of_linear, std::span<const double> displacement,
                                         std::span<double> force) const
{
  return std::all_of(blocks.begin(), blocks.end(),
                     [&](const auto &block)
                     { return block->is_linear() != of_linear || block->add_force(displacement, force); });
}

bool BodyAssembly::Impl::add_cell_tangents(bool of_linear, std::span<const double> displacement)
{
  return std::all_of(blocks.begin(), blocks.end(),
                     [&](const auto &block) {
                       return block->is_linear() != of_linear ||
                              block->add_tangent(displacement, subdomains[block->list().subdomain]);
                     });
}

/// Leaves in `subdomains` what linear laws give, which needs no displacement.
void BodyAssembly::Impl::start_tangent()
{
  if (assembled && !linear.empty())
  {
    for (std::size_t s = 0; s < subdomains.size(); ++s)
      subdomains[s].values = linear[s].values;
    return;
  }
  for (SubdomainMatrix &matrix : subdomains)
    std::fill(matrix.values.begin(), matrix.values.end(), 0.0);
  (void)add_cell_tangents(true, {});
  if (has_blocks(true) && (has_blocks(false) || !loads.has_constant_tangent()))
    linear = subdomains;
}

BodyAssembly::BodyAssembly(const Mesh &mesh, Kinematics kinematics, Strain strain,
                           const std::vector<BodyOptions> &bodies, const std::vector<BoundaryOptions> &boundary,
                           std::span<const Index> subdomain_of_cell)
  : impl_(std::make_unique<Impl>(mesh, kinematics, strain, bodies, boundary, subdomain_of_cell))
{
}

BodyAssembly::~BodyAssembly() = default;

std::span<const SubdomainMatrix> BodyAssembly::subdomains() const
{
  return impl_->subdomains;
}

bool BodyAssembly::tangent_is_constant() const
{
  return !impl_->has_blocks(false) && impl_->loads.has_constant_tangent();
}

bool BodyAssembly::assemble_tangent(std::span<const double> displacement, double time)
{
  AMONTONS_ASSERT(displacement.size() == impl_->points.size());
  impl_->start_tangent();
  if (!impl_->add_cell_tangents(false, displacement))
    return false;
  impl_->loads.add_tangent(displacement, time, impl_->subdomains);
  impl_->assembled = true;
  return true;
}

bool BodyAssembly::forces(std::span<const double> displacement, double time, std::span<double> internal,
                          std::span<double> external) const
{
  AMONTONS_ASSERT(displacement.size() == impl_->points.size() && internal.size() == displacement.size() &&
                  external.size() == displacement.size());
  std::fill(internal.begin(), internal.end(), 0.0);
  std::fill(external.begin(), external.end(), 0.0);
  impl_->loads.add_external(displacement, time, external);
  const bool of_loads_too = tangent_is_constant() && impl_->assembled;
  for (const SubdomainMatrix &matrix : of_loads_too ? impl_->subdomains : impl_->linear)
    multiply_add(matrix, displacement, internal);
  if (of_loads_too)
    return true;
  if (impl_->linear.empty() && !impl_->add_cell_forces(true, displacement, internal))
    return false;
  if (!impl_->add_cell_forces(false, displacement, internal))
    return false;
  impl_->loads.add_internal(displacement, time, internal);
  return true;
}

std::vector<double> BodyAssembly::stress(std::span<const double> displacement) const
{
  std::vector<double> out(6 * impl_->body_of_cell.size(), 0);
  for (const auto &block : impl_->blocks)
    block->write_stress(displacement, out);
  return out;
}

void BodyAssembly::commit(std::span<const double> displacement)
{
  for (const auto &block : impl_->blocks)
    block->commit(displacement);
}

CellHistories BodyAssembly::histories() const
{
  CellHistories out;
  out.offset.push_back(0);
  for (const auto &block : impl_->blocks)
    block->append_history(out);
  return out;
}

void BodyAssembly::set_histories(const CellHistories &histories)
{
  std::vector<Index> place(impl_->body_of_cell.size(), -1);
  for (std::size_t i = 0; i < histories.cells.size(); ++i)
    place.at(static_cast<std::size_t>(histories.cells[i])) = static_cast<Index>(i);
  for (const auto &block : impl_->blocks)
    block->set_history(histories, place);
}

std::vector<double> BodyAssembly::plastic_strain() const
{
  if (std::none_of(impl_->blocks.begin(), impl_->blocks.end(),
                   [](const auto &block) { return block->list().hardening.has_value(); }))
    return {};
  std::vector<double> out(impl_->body_of_cell.size(), 0);
  for (const auto &block : impl_->blocks)
    block->write_plastic_strain(out);
  return out;
}

std::span<const Index> BodyAssembly::body_of_cell() const
{
  return impl_->body_of_cell;
}
} // namespace amontons

#include "amontons/solution/form_choice.h"

#include "amontons/algebra/amg_solver.h"
#include "amontons/algebra/condensed_form.h"
#include "amontons/algebra/coupled_form.h"
#include "amontons/algebra/feti_form.h"
#include "amontons/bulk/partition.h"

#include <algorithm>

namespace amontons
{
namespace
{
/// Unknowns of a subdomain: in 3D as measured (docs/decisions/0012-feti.md), in the plane a guess.
int subdomain_size(int dim)
{
  return dim == 3 ? 650 : 1200;
}

std::unique_ptr<SystemForm> make_feti(const Model &model)
{
  FetiOptions options;
  options.nodes = model.nodes();
  options.points = model.points();
  options.axisymmetric = model.options().mesh.kinematics == Kinematics::axisymmetric;
  for (const ContactInterface &contact : model.contacts())
    for (const std::vector<Index> *nodes : {&contact.surfaces().nodes, &contact.target_nodes()})
      options.contact_nodes.insert(options.contact_nodes.end(), nodes->begin(), nodes->end());
  return std::make_unique<FetiForm>(model.layout(), model.bodies().subdomains(), std::move(options));
}

/// 3D displacements from which multigrid is faster than a factorisation (docs/decisions/0011), and subdomains are
/// faster than both (0012), as measured.
constexpr GlobalIndex amg_from = 15000, feti_from = 40000;

/// Whether the stiffness stays as it is for the whole run, so that subdomains are factorised once.
bool has_constant_stiffness(const ProblemOptions &options)
{
  return options.strain == Strain::small && std::all_of(options.bodies.begin(), options.bodies.end(),
                                                        [](const BodyOptions &body) {
                                                          return body.material.law == MaterialLaw::linear_elastic ||
                                                                 body.material.law == MaterialLaw::rigid;
                                                        });
}
/// Rows of mortar in finite strain follow the nodes round the impactor node: to eliminate them would be to solve for
/// the whole interface.
bool has_moving_mortar(const ProblemOptions &options)
{
  return options.strain == Strain::finite &&
         std::any_of(options.contact.begin(), options.contact.end(),
                     [](const ContactOptions &contact) { return contact.discretization == Discretization::mortar; });
}

bool is_coupled(const ProblemOptions &options)
{
  return options.solver.multipliers == MultiplierForm::coupled || has_moving_mortar(options);
}
} // namespace

std::vector<LinearSolverType> linear_solvers(const ProblemOptions &options, const Mesh &mesh)
{
  using enum LinearSolverType;
  const LinearSolverType linear = options.solver.linear;
  const bool coupled = is_coupled(options);
  if (has_moving_mortar(options) &&
      (linear == amg || linear == feti || options.solver.multipliers == MultiplierForm::condensed))
    throw UserError("solver: 'discretization: mortar' in finite strain goes with 'multipliers: coupled' and 'linear: "
                    "direct' only: the rows of neighbouring nodes hang together; take these, or leave both keys out");
  if (coupled && (linear == amg || linear == feti))
    throw UserError("solver: 'multipliers: coupled' goes with 'linear: direct' only: the multipliers' part of the "
                    "matrix is no work for amg or feti; take 'multipliers: condensed'");
  if (linear == feti && options.strain != Strain::small)
    throw UserError("solver: 'linear: feti' solves problems of small strain: in finite strain the stiffness of a "
                    "compressed subdomain is not positive; take 'amg' or 'direct'");
  if (linear != automatic)
    return {linear};
  const GlobalIndex n_displacements = mesh.n_global_nodes * mesh.dim;
  if (coupled || mesh.dim == 2 || n_displacements <= amg_from)
    return {direct};
  if (n_displacements > feti_from && has_constant_stiffness(options))
    return {feti, amg, direct};
  return {amg, direct};
}

std::vector<Index> make_partition(const ProblemOptions &options, const Mesh &mesh, int n_processes)
{
  if (linear_solvers(options, mesh).front() != LinearSolverType::feti)
    return {};
  std::vector<Index> out;
  for (int size = subdomain_size(mesh.dim); size > mesh.dim; size /= 2)
  {
    out = partition_cells(mesh, options.bodies, size);
    if (out.empty() || *std::max_element(out.begin(), out.end()) + 1 >= n_processes)
      break;
  }
  return out;
}

std::unique_ptr<SystemForm> make_form(const Model &model, LinearSolverType linear)
{
  if (linear == LinearSolverType::feti)
    return make_feti(model);
  if (is_coupled(model.options()))
    return std::make_unique<CoupledForm>(model.layout(), model.bodies().subdomains(), make_direct_solver());
  return std::make_unique<CondensedForm>(model.layout(), model.bodies().subdomains(),
                                         linear == LinearSolverType::amg ? make_amg_solver() : make_direct_solver(),
                                         model.points());
}
} // namespace amontons

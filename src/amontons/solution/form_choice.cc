#include "amontons/solution/form_choice.h"

#include "amontons/algebra/condensed_form.h"
#include "amontons/algebra/coupled_form.h"
#include "amontons/algebra/feti_form.h"
#include "amontons/bulk/partition.h"

namespace amontons
{
namespace
{
/// Unknowns of a subdomain, as measured (docs/decisions/0012-feti.md).
int subdomain_size(int dim)
{
  return dim == 3 ? 650 : 1200;
}

std::unique_ptr<SystemForm> make_feti(const Model &model)
{
  FetiOptions options;
  options.points = model.mesh().points;
  options.axisymmetric = model.options().mesh.kinematics == Kinematics::axisymmetric;
  for (const ContactInterface &contact : model.contacts())
    for (const Surface *surface : {&contact.impactor(), contact.target()})
      if (surface)
        options.contact_nodes.insert(options.contact_nodes.end(), surface->node_ids.begin(), surface->node_ids.end());
  return std::make_unique<FetiForm>(model.layout(), model.bodies().subdomains(), std::move(options));
}

/// Places of the nodal components in the reference.
std::vector<double> reference_places(const Model &model)
{
  std::vector<double> out;
  for (Index node = 0; node < model.n_nodal() / model.dim(); ++node)
    for (int c = 0; c < model.dim(); ++c)
      out.push_back(model.reference(node)[c]);
  return out;
}
} // namespace

std::vector<Index> make_partition(const ProblemOptions &options, const Mesh &mesh)
{
  if (options.solver.linear != LinearSolverType::feti)
    return {};
  return partition_cells(mesh, options.bodies, subdomain_size(mesh.dim));
}

std::unique_ptr<SystemForm> make_form(const Model &model)
{
  if (model.options().solver.linear == LinearSolverType::feti)
  {
    if (!model.small_strain())
      throw UserError("solver: 'linear: feti' solves problems of small strain: in finite strain the stiffness of a "
                      "compressed subdomain is not positive; take 'amg' or 'direct'");
    return make_feti(model);
  }
  if (model.options().solver.multipliers == MultiplierForm::condensed)
    return std::make_unique<CondensedForm>(model.layout(), model.bodies().subdomains(), make_direct_solver(),
                                           reference_places(model));
  return std::make_unique<CoupledForm>(model.layout(), model.bodies().subdomains(), make_direct_solver());
}
} // namespace amontons

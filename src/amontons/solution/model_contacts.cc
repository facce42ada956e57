#include "amontons/algebra/linear_solver_failure.h"
#include "amontons/solution/model.h"

#include <algorithm>
#include <numeric>

/// Model: its contacts, and the search for their faces.
namespace amontons
{
void Model::build_contacts()
{
  contacts_.reserve(options_.contact.size()); // the search keeps their addresses
  auto surface = part_.surfaces.begin(), whole = part_.whole_surfaces.begin();
  for (const ContactOptions &contact : options_.contact)
  {
    const RigidBody *analytic = nullptr;
    for (const RigidBody &body : rigid_->bodies())
      if (body.shape && body.name == contact.target)
        analytic = &body;
    ContactSurfaces surfaces = share_of(*surface++);
    if (!analytic && !contact.is_self_contact())
    {
      surfaces.target = std::move(*surface++);
      for (const GlobalIndex id : surfaces.target->node_ids)
        surfaces.target_nodes.push_back(position(id));
    }
    if (contact.discretization == Discretization::mortar && !analytic && !contact.is_self_contact())
      surfaces.whole_impactor = std::make_shared<const Surface>(std::move(*whole++));
    if (surfaces.whole_impactor || (wants_whole_target(contact, options_.strain) && !analytic))
      surfaces.whole_target = std::make_shared<const Surface>(std::move(*whole++));
    contacts_.emplace_back(points_, options_.mesh.kinematics, options_.strain, contact, options_.detection,
                           std::move(surfaces), analytic);
  }
  AMONTONS_ASSERT(surface == part_.surfaces.end() && whole == part_.whole_surfaces.end());
  part_.surfaces.clear();
  part_.whole_surfaces.clear();
  Index first = 0;
  for (ContactInterface &contact : contacts_)
  {
    contact.set_first_multiplier(first);
    first += contact.n_nodes() * dim();
  }
}

/// An impactor surface as this process has it.
ContactSurfaces Model::share_of(const Surface &impactor) const
{
  std::vector<char> is_own;
  for (const GlobalIndex id : impactor.node_ids)
    is_own.push_back(nodes_.is_own(position(id)) ? 1 : 0);
  ContactSurfaces out;
  out.impactor = own_first(impactor, is_own);
  out.n_own = static_cast<Index>(std::count(is_own.begin(), is_own.end(), 1));
  for (const GlobalIndex id : out.impactor.node_ids)
    out.nodes.push_back(position(id));
  return out;
}

/// What takes all processes: areas of contact nodes, the search of faces, whether the stiffness stays.
void Model::build_search()
{
  for (ContactInterface &contact : contacts_)
  {
    std::vector<double> areas(node_ids_.size(), 0.0);
    const std::vector<double> here =
        tributary_areas(contact.impactor(), options_.mesh.kinematics == Kinematics::axisymmetric);
    for (std::size_t i = 0; i < here.size(); ++i)
      areas[contact.surfaces().nodes[i]] = here[i];
    nodes_.sum(areas);
    std::vector<double> own;
    for (Index i = 0; i < contact.n_nodes(); ++i)
      own.push_back(areas[contact.node(i)]);
    contact.set_areas(std::move(own));
    contact.share(messages_);
    contact.place_faces([this](GlobalIndex id) { return position(id); });
  }
  tangent_is_constant_ = nodes_.true_on_all(bodies_->tangent_is_constant());
  search_ = std::make_unique<ContactSearch>(contacts_, options_.detection, options_.exchange, nodes_.messages());
  auto n = static_cast<double>(std::accumulate(contacts_.begin(), contacts_.end(), Index(0),
                                               [](Index sum, const auto &c) { return sum + c.n_nodes(); })) *
           dim();
  nodes_.sum_over_processes({&n, 1});
  n_global_multipliers_ = static_cast<GlobalIndex>(n);
}

bool Model::detect(State &state, std::span<const double> reaches, bool keep)
{
  AMONTONS_ASSERT(search_ != nullptr); // in small strain it is given up once it has found the pairs
  const std::vector<double> before = with_halo(state.displacement);
  search_->search(before, reaches, small_strain());
  bool changed = false;
  const auto take = [&]
  {
    for (std::size_t c = 0; c < contacts_.size(); ++c)
      if (contacts_[c].is_searched())
        changed |= contacts_[c].take_pairs(search_->pairs(c), search_->target(c), before, keep);
      else if (contacts_[c].is_mortar())
        changed |= contacts_[c].couple(before, reaches[c]);
  };
  try
  {
    agree_on_failures(nodes_, take);
  }
  catch (const NumericalFailure &)
  {
    update_halo(); // some nodes have other faces by now
    throw;
  }
  changed = !nodes_.true_on_all(!changed);
  if (changed)
  {
    update_halo();
    const std::vector<double> after = with_halo(state.displacement);
    agree_on_failures(nodes_,
                      [&]
                      {
                        for (ContactInterface &contact : contacts_)
                          contact.turn_multipliers(after, state.multipliers);
                      });
  }
  if (small_strain())
  {
    for (std::size_t c = 0; c < contacts_.size(); ++c)
      detection_reports_.push_back(search_->report(c));
    search_.reset();
  }
  return changed;
}
} // namespace amontons

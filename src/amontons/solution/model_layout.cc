#include "amontons/solution/model.h"

#include <algorithm>
#include <numeric>

/// Model: its nodes, the halo among them, and the numbering of unknowns.
namespace amontons
{
namespace
{
/// Components along which a node of a rigid body moves when its body turns about an axis.
int n_spins(int dim)
{
  return dim == 2 ? 1 : 3;
}
int spin_axis(int dim, int k)
{
  return dim == 2 ? 2 : k;
}
} // namespace

/// A node belongs to a process that has a deformable cell at it, where there is one. Collective.
void Model::number_nodes(std::vector<GlobalIndex> halo)
{
  node_ids_ = mesh().node_ids;
  for (Index k = 0; k < rigid_->n_extra_nodes(); ++k)
    node_ids_.push_back(mesh().n_global_nodes + k);
  node_ids_.insert(node_ids_.end(), halo.begin(), halo.end());
  position_of_id_.clear();
  if (messages_ && messages_->communicator().size() > 1)
    for (std::size_t node = 0; node < node_ids_.size(); ++node)
      position_of_id_.emplace(node_ids_[node], static_cast<Index>(node));
  std::vector<char> has_cell(node_ids_.size(), 0);
  for (const SubdomainMatrix &matrix : bodies_->subdomains())
    for (const Index node : matrix.nodes)
      has_cell[node] = 1;
  nodes_ = Sharing(messages_, "model", node_ids_, has_cell);

  rigid_of_node_.assign(node_ids_.size(), -1);
  for (std::size_t b = 0; b < rigid_->bodies().size(); ++b)
    for (const Index node : rigid_->bodies()[b].nodes)
      rigid_of_node_[node] = static_cast<int>(b);
  std::vector<double> points = mesh().points;
  for (Index k = 0; k < rigid_->n_extra_nodes(); ++k)
  {
    const Eigen::Vector3d &point = rigid_->bodies()[rigid_of_node_[mesh().n_nodes() + k]].point;
    points.insert(points.end(), point.data(), point.data() + dim());
  }
  points_ = with_halo(points);
}

std::vector<double> Model::with_halo(std::span<const double> nodal) const
{
  AMONTONS_ASSERT(nodal.size() == static_cast<std::size_t>(n_state_nodes()) * dim());
  std::vector<double> out(nodal.begin(), nodal.end());
  out.resize(node_ids_.size() * static_cast<std::size_t>(dim()), 0.0);
  nodes_.take_owners(out, dim());
  return out;
}

void Model::update_halo()
{
  if (nodes_.is_distributed())
  {
    std::vector<GlobalIndex> wanted;
    for (const ContactInterface &contact : contacts_)
      for (const GlobalIndex id : contact.wanted_nodes())
        if (const auto found = position_of_id_.find(id);
            found == position_of_id_.end() || found->second >= n_state_nodes())
          wanted.push_back(id);
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    const bool has_all =
        std::all_of(wanted.begin(), wanted.end(), [this](GlobalIndex id) { return position_of_id_.count(id) > 0; });
    if (!nodes_.true_on_all(has_all))
    {
      number_nodes(std::move(wanted));
      build_layout();
      ++halo_version_;
    }
  }
  for (ContactInterface &contact : contacts_)
    contact.place_faces([this](GlobalIndex id) { return position(id); });
}

Eigen::Vector3d Model::reference(Index node) const
{
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  std::copy_n(points_.begin() + static_cast<std::ptrdiff_t>(node) * dim(), dim(), x.data());
  return x;
}

void Model::build_layout()
{
  std::vector<double> held(static_cast<std::size_t>(n_nodal()), 0);
  for (const HeldComponent &component : supports_->held())
    held[component.nodal] = 1;
  nodes_.maximum(held, dim()); // of the halo only owners know
  // Nodes of no deformable cell and no rigid body have no stiffness: they stay where they are.
  std::vector<double> stiff(rigid_of_node_.size(), 0);
  for (const SubdomainMatrix &matrix : bodies_->subdomains())
    for (const Index node : matrix.nodes)
      stiff[node] = 1;
  nodes_.maximum(stiff);

  std::vector<Index> offsets{0};
  std::vector<Term> terms;
  Index n = rigid_->n_unknowns();
  std::vector<GlobalIndex> ids(static_cast<std::size_t>(n));
  std::iota(ids.begin(), ids.end(), 0);
  std::vector<char> preferred(ids.size(), 0);
  for (Index node = 0; node < static_cast<Index>(rigid_of_node_.size()); ++node)
    for (int c = 0; c < dim(); ++c)
    {
      if (const int b = rigid_of_node_[node]; b >= 0)
      {
        const RigidBody &body = rigid_->bodies()[b];
        if (body.translation[c].unknown >= 0)
          terms.push_back({body.translation[c].unknown, 1});
        for (int k = 0; k < n_spins(dim()); ++k)
          if (const Index unknown = body.rotation[spin_axis(dim(), k)].unknown; unknown >= 0)
            terms.push_back({unknown, 0});
      }
      else if (stiff[node] != 0 && held[node * dim() + c] == 0)
      {
        terms.push_back({n++, 1});
        ids.push_back(rigid_->n_unknowns() + node_id(node) * dim() + c);
        preferred.push_back(nodes_.is_own(node) ? 1 : 0);
      }
      offsets.push_back(static_cast<Index>(terms.size()));
    }
  Index n_multipliers = 0;
  for (const ContactInterface &contact : contacts_)
    n_multipliers += contact.n_nodes() * dim();
  layout_ = Layout(Sharing(messages_, "model", ids, preferred), n_multipliers, std::move(offsets), std::move(terms));
  update_layout(initial_state());
}

void Model::update_layout(const State &state)
{
  for (std::size_t b = 0; b < rigid_->bodies().size(); ++b)
  {
    const RigidBody &body = rigid_->bodies()[b];
    for (int k = 0; k < n_spins(dim()); ++k)
    {
      const int axis = spin_axis(dim(), k);
      if (body.rotation[axis].unknown < 0)
        continue;
      for (const Index node : body.nodes)
      {
        const Eigen::Vector3d velocity =
            rigid_->spin_velocity(static_cast<int>(b), state.rigid[b], reference(node), axis);
        for (int c = 0; c < dim(); ++c)
          for (Term &term : layout_.terms(node * dim() + c))
            if (term.unknown == body.rotation[axis].unknown)
              term.coefficient = velocity[c];
      }
    }
  }
}
} // namespace amontons

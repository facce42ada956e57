#include "amontons/algebra/feti_interface.h"

#include "amontons/base/error.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
/// Share of a rigid motion's mean square that the boundary has to show; below, nodes are added to it.
constexpr double visible_share = 1e-2;

/// How well the rows show the motions: least ratio of mean squares, over the rows and over all.
double visibility(const Eigen::MatrixXd &motions, const std::vector<Index> &rows)
{
  if (rows.empty())
    return 0;
  const Eigen::MatrixXd shown = motions(rows, Eigen::all);
  const Eigen::MatrixXd gram = shown.transpose() * shown / static_cast<double>(rows.size()),
                        whole = motions.transpose() * motions / static_cast<double>(motions.rows());
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(gram, whole, Eigen::EigenvaluesOnly)
      .eigenvalues()[0];
}

/// Of a node's components.
double mean_diagonal(const SubdomainMatrix &matrix, Index node)
{
  double out = 0;
  const int n = matrix.n_components;
  for (Index row = node * n; row < (node + 1) * n; ++row)
  {
    const auto begin = matrix.col.begin() + matrix.row_ptr[row], end = matrix.col.begin() + matrix.row_ptr[row + 1];
    out += matrix.values[std::lower_bound(begin, end, row) - matrix.col.begin()] / n;
  }
  return out;
}
} // namespace

FetiInterface::FetiInterface(const Layout &layout, std::span<const SubdomainMatrix> subdomains,
                             const FetiOptions &options)
  : layout_(layout)
  , subdomains_(subdomains)
  , options_(options)
  , dim_(static_cast<int>(options.nodes.maximum_over_processes(subdomains.empty() ? 1 : subdomains[0].n_components)))
  , copies_(layout.n_nodal() / dim_, subdomains, options.nodes)
  , first_local_(1, 0)
{
  for (const SubdomainMatrix &matrix : subdomains)
    first_local_.push_back(first_local_.back() + matrix.n_rows());
  find_rigid_unknowns();
  find_boundary();
  number_columns();
  share_glue();
}

/// An unknown is rigid unless it is a nodal component of a subdomain, and of no more than one.
void FetiInterface::find_rigid_unknowns()
{
  std::vector<int> n_uses(static_cast<std::size_t>(layout_.n_displacement_unknowns()), 0);
  std::vector<char> is_component(n_uses.size(), 0);
  for (Index nodal = 0; nodal < layout_.n_nodal(); ++nodal)
    for (const Term &term : layout_.terms(nodal))
    {
      ++n_uses[term.unknown];
      is_component[term.unknown] =
          layout_.terms(nodal).size() == 1 && term.coefficient == 1 && !copies_.of(nodal / dim_).empty();
    }
  rigid_of_unknown_.assign(n_uses.size(), -1);
  for (std::size_t unknown = 0; unknown < n_uses.size(); ++unknown)
    if (n_uses[unknown] != 1 || !is_component[unknown])
    {
      AMONTONS_ASSERT(layout_.sharing().n_copies(static_cast<Index>(unknown)) == options_.nodes.n_processes());
      rigid_of_unknown_[unknown] = static_cast<Index>(rigid_unknowns_.size());
      rigid_unknowns_.push_back(static_cast<Index>(unknown));
    }
}

bool FetiInterface::is_free(Index nodal) const
{
  const auto terms = layout_.terms(nodal);
  return terms.size() == 1 && rigid_of_unknown_[terms[0].unknown] < 0;
}

void FetiInterface::find_boundary()
{
  const Index n_nodes = copies_.n_nodes();
  is_boundary_.assign(static_cast<std::size_t>(n_nodes), 0);
  for (Index node = 0; node < n_nodes; ++node)
  {
    is_boundary_[node] = copies_.of(node).size() > 1;
    for (int c = 0; c < dim_; ++c)
      is_boundary_[node] |= !is_free(node * dim_ + c);
  }
  for (const Index node : options_.contact_nodes)
    is_boundary_[node] = 1;
  show_motions();
  // What shows the motions of another process's subdomain is known there only.
  std::vector<double> flags(is_boundary_.begin(), is_boundary_.begin() + options_.nodes.size());
  options_.nodes.maximum(flags);
  std::copy(flags.begin(), flags.end(), is_boundary_.begin());
}

void FetiInterface::show_motions()
{
  for (std::size_t s = 0; s < subdomains_.size(); ++s)
  {
    const std::vector<Index> &nodes = subdomains_[s].nodes;
    std::vector<Index> shown;
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (int c = 0; c < dim_; ++c)
        if (is_boundary_[nodes[a]])
          shown.push_back(static_cast<Index>(a) * dim_ + c);
    const Eigen::MatrixXd all = motions(s);
    if (visibility(all, shown) >= visible_share)
      continue;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(all.transpose());
    for (Eigen::Index k = 0; k < all.cols(); ++k)
      is_boundary_[nodes[qr.colsPermutation().indices()[k] / dim_]] = 1;
  }
}

void FetiInterface::number_columns()
{
  std::vector<FetiCopy *> on_boundary;
  for (Index node = 0; node < copies_.n_nodes(); ++node)
    if (is_boundary_[node])
      for (FetiCopy &copy : copies_.of(node))
        on_boundary.push_back(&copy);
  std::sort(on_boundary.begin(), on_boundary.end(),
            [](const FetiCopy *a, const FetiCopy *b)
            { return std::pair(a->subdomain, a->node) < std::pair(b->subdomain, b->node); });
  first_column_.assign(1, 0);
  boundary_.resize(subdomains_.size());
  Index column = 0;
  for (FetiCopy *copy : on_boundary)
  {
    first_column_.resize(static_cast<std::size_t>(copy->subdomain) + 1, column);
    copy->column = column;
    places_.push_back({copy->subdomain, copy->node * dim_});
    column += dim_;
    if (copies_.is_own(*copy))
      for (int c = 0; c < dim_; ++c)
        boundary_[copy->subdomain - copies_.first_own_subdomain()].push_back(copy->node * dim_ + c);
  }
  first_column_.resize(static_cast<std::size_t>(copies_.n_subdomains()) + 1, column);
}

Index FetiInterface::own_column(const Place &place) const
{
  const std::vector<Index> &boundary = boundary_[place.subdomain - copies_.first_own_subdomain()];
  const auto found = std::lower_bound(boundary.begin(), boundary.end(), place.unknown);
  AMONTONS_ASSERT(found != boundary.end() && *found == place.unknown);
  return first_of(place.subdomain) + static_cast<Index>(found - boundary.begin());
}

template<class Row>
void FetiInterface::for_each_glue_row(bool own, Row &&row) const
{
  for (Index nodal = 0; nodal < layout_.n_nodal(); ++nodal)
  {
    const auto of_node = copies_.of(nodal / dim_);
    const bool held = !is_free(nodal);
    if (!own &&
        (held || std::none_of(of_node.begin(), of_node.end(), [&](const auto &c) { return copies_.is_own(c); })))
      continue;
    for (std::size_t k = held ? 0 : 1; k < of_node.size(); ++k)
      if (copies_.is_own(of_node[k]) == own)
        row(nodal, k);
  }
}

void FetiInterface::share_glue()
{
  std::vector<GlobalIndex> ids;
  std::vector<char> is_own;
  const GlobalIndex n_subdomains = copies_.n_subdomains();
  for (const bool own : {false, true})
    for_each_glue_row(own,
                      [&](Index nodal, std::size_t k)
                      {
                        const Index node = nodal / dim_;
                        ids.push_back((options_.nodes.number(node) * dim_ + nodal % dim_) * n_subdomains +
                                      copies_.of(node)[k].subdomain);
                        is_own.push_back(own);
                      });
  n_glue_rows_of_others_ = static_cast<Index>(std::count(is_own.begin(), is_own.end(), 0));
  glue_sharing_ = Sharing(options_.nodes.messages(), feti_setup_phase, ids, is_own).counted_as(feti_phase);
}

void FetiInterface::update_shares()
{
  for (Index node = 0; node < copies_.n_nodes(); ++node)
    for (FetiCopy &copy : copies_.of(node))
      if (copies_.is_own(copy))
        copy.stiffness = mean_diagonal(subdomains_[copy.subdomain - copies_.first_own_subdomain()], copy.node);
  copies_.hand_over(
      1, [](const FetiCopy &copy, double *value) { *value = copy.stiffness; },
      [](FetiCopy &copy, const double *value) { copy.stiffness = *value; });
  for (Index node = 0; node < copies_.n_nodes(); ++node)
  {
    double sum = 0;
    for (const FetiCopy &copy : copies_.of(node))
      sum += copy.stiffness;
    for (FetiCopy &copy : copies_.of(node))
      copy.share = copy.stiffness / sum;
  }
}

Eigen::MatrixXd FetiInterface::motions(std::size_t s) const
{
  const std::vector<Index> &nodes = subdomains_[s].nodes;
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(n, 3);
  for (Eigen::Index a = 0; a < n; ++a)
    for (int c = 0; c < dim_; ++c)
      x(a, c) = options_.points[static_cast<std::size_t>(nodes[a]) * dim_ + c];
  x.rowwise() -= x.colwise().mean().eval();
  x /= std::max(x.norm() / std::sqrt(static_cast<double>(n)), 1e-300);
  if (options_.axisymmetric)
  {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n * dim_, 1);
    for (Eigen::Index a = 0; a < n; ++a)
      out(a * dim_ + 1, 0) = 1;
    return out;
  }
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n * dim_, dim_ == 3 ? 6 : 3);
  for (Eigen::Index a = 0; a < n; ++a)
  {
    out.block(a * dim_, 0, dim_, dim_).setIdentity();
    for (int k = 0; k < (dim_ == 3 ? 3 : 1); ++k)
    {
      // Turning about axis k + 2 (modulo 3), z first.
      const int i = k, j = (k + 1) % 3;
      out(a * dim_ + i, dim_ + k) = -x(a, j);
      out(a * dim_ + j, dim_ + k) = x(a, i);
    }
  }
  return out;
}

std::vector<double> FetiInterface::inverse_stiffness() const
{
  std::vector<double> out(static_cast<std::size_t>(n_columns()), 0);
  for (Index node = 0; node < copies_.n_nodes(); ++node)
    for (const FetiCopy &copy : copies_.of(node))
      if (copy.column >= 0)
        std::fill_n(out.begin() + copy.column, dim_, 1 / copy.stiffness);
  return out;
}

FetiRows FetiInterface::glue() const
{
  FetiRows rows;
  std::vector<FetiRows::Entry> row;
  const auto append_row = [&](Index nodal, std::size_t k)
  {
    const auto of_node = copies_.of(nodal / dim_);
    const int c = nodal % dim_;
    const FetiCopy &copy = of_node[k];
    double length2 = 1 / copy.stiffness;
    if (!is_free(nodal))
    {
      row.assign(1, {copy.column + c, 1});
      for (const Term &term : layout_.terms(nodal))
        row.emplace_back(rigid_column(term.unknown), -term.coefficient);
    }
    else
    {
      // Against the mean of those before it.
      double before = 0;
      for (std::size_t i = 0; i < k; ++i)
        before += of_node[i].stiffness;
      row.assign(1, {copy.column + c, -1});
      for (std::size_t i = 0; i < k; ++i)
        row.emplace_back(of_node[i].column + c, of_node[i].stiffness / before);
      length2 += 1 / before;
    }
    rows.push_back(row);
    rows.scale(rows.size() - 1, 1 / std::sqrt(length2));
  };
  for (const bool own : {false, true})
    for_each_glue_row(own, append_row);
  return rows;
}

void FetiInterface::append(Index nodal, double coefficient, std::vector<FetiRows::Entry> &row) const
{
  if (is_free(nodal))
    for (const FetiCopy &copy : copies_.of(nodal / dim_))
      row.emplace_back(copy.column + nodal % dim_, coefficient * copy.share);
  else
    for (const Term &term : layout_.terms(nodal))
      row.emplace_back(rigid_column(term.unknown), coefficient * term.coefficient);
}

void FetiInterface::distribute(std::span<const double> unknowns, std::span<double> local, std::span<double> rigid) const
{
  for (std::size_t k = 0; k < rigid_unknowns_.size(); ++k)
    rigid[k] = unknowns[rigid_unknowns_[k]];
  for (Index nodal = 0; nodal < layout_.n_nodal(); ++nodal)
  {
    const double force = is_free(nodal) ? unknowns[layout_.terms(nodal)[0].unknown] : 0;
    for (const FetiCopy &copy : copies_.of(nodal / dim_))
      if (copies_.is_own(copy))
        local[place_of(copy) + nodal % dim_] = copy.share * force;
  }
}

void FetiInterface::average(std::span<const double> local, std::span<const double> rigid,
                            std::span<double> unknowns) const
{
  std::fill(unknowns.begin(), unknowns.end(), 0.0);
  for (Index nodal = 0; nodal < layout_.n_nodal(); ++nodal)
    if (is_free(nodal))
    {
      double mean = 0;
      for (const FetiCopy &copy : copies_.of(nodal / dim_))
        if (copies_.is_own(copy))
          mean += copy.share * local[place_of(copy) + nodal % dim_];
      unknowns[layout_.terms(nodal)[0].unknown] = mean;
    }
  layout_.sharing().sum(unknowns);
  for (std::size_t k = 0; k < rigid_unknowns_.size(); ++k)
    unknowns[rigid_unknowns_[k]] = rigid[k];
}
} // namespace amontons

#include "amontons/algebra/feti_interface.h"

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
} // namespace

FetiInterface::FetiInterface(const Layout &layout, std::span<const SubdomainMatrix> subdomains,
                             const FetiOptions &options)
  : layout_(layout)
  , subdomains_(subdomains)
  , options_(options)
  , dim_(subdomains.empty() ? 1 : subdomains[0].n_components)
{
  find_copies();
  find_rigid_unknowns();
  find_boundary();
  number_columns();
}

void FetiInterface::find_copies()
{
  const auto n_nodes = static_cast<std::size_t>(layout_.n_nodal() / dim_);
  copy_offsets_.assign(n_nodes + 1, 0);
  for (const SubdomainMatrix &matrix : subdomains_)
    for (const Index node : matrix.nodes)
      ++copy_offsets_[node + 1];
  for (std::size_t node = 0; node < n_nodes; ++node)
    copy_offsets_[node + 1] += copy_offsets_[node];
  copies_.resize(static_cast<std::size_t>(copy_offsets_.back()));
  std::vector<Index> next(copy_offsets_.begin(), copy_offsets_.end() - 1);
  first_local_.assign(1, 0);
  for (std::size_t s = 0; s < subdomains_.size(); ++s)
  {
    for (std::size_t a = 0; a < subdomains_[s].nodes.size(); ++a)
      copies_[next[subdomains_[s].nodes[a]]++] = {static_cast<Index>(s), static_cast<Index>(a)};
    first_local_.push_back(first_local_.back() + subdomains_[s].n_rows());
  }
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
          layout_.terms(nodal).size() == 1 && term.coefficient == 1 && !copies(nodal / dim_).empty();
    }
  rigid_of_unknown_.assign(n_uses.size(), -1);
  for (std::size_t unknown = 0; unknown < n_uses.size(); ++unknown)
    if (n_uses[unknown] != 1 || !is_component[unknown])
    {
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
  const auto n_nodes = static_cast<Index>(copy_offsets_.size()) - 1;
  is_boundary_.assign(static_cast<std::size_t>(n_nodes), 0);
  for (Index node = 0; node < n_nodes; ++node)
  {
    is_boundary_[node] = copies(node).size() > 1;
    for (int c = 0; c < dim_; ++c)
      is_boundary_[node] |= !is_free(node * dim_ + c);
  }
  for (const Index node : options_.contact_nodes)
    is_boundary_[node] = 1;
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
  first_column_.assign(1, 0);
  place_.assign(static_cast<std::size_t>(n_local()), -1);
  boundary_.resize(subdomains_.size());
  Index column = 0;
  for (std::size_t s = 0; s < subdomains_.size(); ++s)
  {
    for (Index i = 0; i < subdomains_[s].n_rows(); ++i)
      if (is_boundary_[subdomains_[s].nodes[i / dim_]])
      {
        place_[first_local_[s] + i] = column++;
        boundary_[s].push_back(i);
      }
    first_column_.push_back(column);
  }
}

void FetiInterface::update_shares()
{
  for (Copy &copy : copies_)
  {
    const SubdomainMatrix &matrix = subdomains_[copy.subdomain];
    copy.stiffness = 0;
    for (Index row = copy.node * dim_; row < (copy.node + 1) * dim_; ++row)
    {
      const auto begin = matrix.col.begin() + matrix.row_ptr[row], end = matrix.col.begin() + matrix.row_ptr[row + 1];
      copy.stiffness += matrix.values[std::lower_bound(begin, end, row) - matrix.col.begin()] / dim_;
    }
  }
  for (std::size_t node = 0; node + 1 < copy_offsets_.size(); ++node)
  {
    double sum = 0;
    for (const Copy &copy : copies(static_cast<Index>(node)))
      sum += copy.stiffness;
    for (Index k = copy_offsets_[node]; k < copy_offsets_[node + 1]; ++k)
      copies_[k].share = copies_[k].stiffness / sum;
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
  for (const Copy &copy : copies_)
    for (int c = 0; c < dim_; ++c)
      if (const Index k = column(copy, c); k >= 0)
        out[k] = 1 / copy.stiffness;
  return out;
}

FetiRows FetiInterface::glue() const
{
  FetiRows rows;
  std::vector<FetiRows::Entry> row;
  const auto finish = [&](double length2)
  {
    rows.push_back(row);
    rows.scale(rows.size() - 1, 1 / std::sqrt(length2));
  };
  for (Index nodal = 0; nodal < layout_.n_nodal(); ++nodal)
  {
    const auto of_node = copies(nodal / dim_);
    const int c = nodal % dim_;
    if (!is_free(nodal))
      for (const Copy &copy : of_node)
      {
        row.assign(1, {column(copy, c), 1});
        for (const Term &term : layout_.terms(nodal))
          row.emplace_back(rigid_column(term.unknown), -term.coefficient);
        finish(1 / copy.stiffness);
      }
    else
    {
      // Each copy against the mean of those before it.
      double before = 0;
      for (std::size_t k = 0; k < of_node.size(); before += of_node[k++].stiffness)
      {
        if (k == 0)
          continue;
        row.assign(1, {column(of_node[k], c), -1});
        for (std::size_t i = 0; i < k; ++i)
          row.emplace_back(column(of_node[i], c), of_node[i].stiffness / before);
        finish(1 / before + 1 / of_node[k].stiffness);
      }
    }
  }
  return rows;
}

void FetiInterface::append(Index nodal, double coefficient, std::vector<FetiRows::Entry> &row) const
{
  if (is_free(nodal))
    for (const Copy &copy : copies(nodal / dim_))
      row.emplace_back(column(copy, nodal % dim_), coefficient * copy.share);
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
    for (const Copy &copy : copies(nodal / dim_))
      local[first_local_[copy.subdomain] + copy.node * dim_ + nodal % dim_] = copy.share * force;
  }
}

void FetiInterface::average(std::span<const double> local, std::span<const double> rigid,
                            std::span<double> unknowns) const
{
  for (std::size_t k = 0; k < rigid_unknowns_.size(); ++k)
    unknowns[rigid_unknowns_[k]] = rigid[k];
  for (Index nodal = 0; nodal < layout_.n_nodal(); ++nodal)
    if (is_free(nodal))
    {
      double mean = 0;
      for (const Copy &copy : copies(nodal / dim_))
        mean += copy.share * local[first_local_[copy.subdomain] + copy.node * dim_ + nodal % dim_];
      unknowns[layout_.terms(nodal)[0].unknown] = mean;
    }
}
} // namespace amontons

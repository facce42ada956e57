#pragma once
#include "amontons/algebra/system_form.h"
#include "lattice_problem.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>

namespace amontons::test
{
/// What a process has of a problem: some of its subdomains with their nodes, the nodes of the rigid body, the
/// constraints of impactor nodes that it owns, and last the other nodes of these.
struct ProblemPart : FormProblem
{
  std::vector<Index> nodes;                   ///< [n_nodes] node of the whole
  std::vector<Index> unknowns;                ///< [n_unknowns] unknown of the whole, multipliers too
  std::vector<std::size_t> whole_subdomains;  ///< [n_subdomains] subdomain of the whole
  std::vector<std::size_t> whole_constraints; ///< [patterns] constraint of the whole

  [[nodiscard]] std::vector<double> of(const std::vector<double> &whole) const
  {
    std::vector<double> out;
    for (Index i = 0; i < layout.n_unknowns(); ++i)
      out.push_back(whole[unknowns[i]]);
    return out;
  }
};

/// How subdomains are dealt out.
enum class Deal
{
  even,      ///< as many to each, neighbours together
  in_turn,   ///< neighbours apart
  apart,     ///< neighbours apart, and no process with subdomains of both halves, where there are several
  last_only, ///< all to the last process
};

inline Rank rank_of_subdomain(Deal deal, std::size_t subdomain, std::size_t n_subdomains, int n_processes)
{
  const std::size_t first_half = n_processes / 2, second_half = n_processes - first_half;
  return static_cast<Rank>(deal == Deal::even              ? subdomain * n_processes / n_subdomains
                           : deal == Deal::in_turn         ? subdomain % n_processes
                           : deal == Deal::last_only       ? n_processes - 1
                           : 2 * subdomain >= n_subdomains ? first_half + subdomain % second_half
                           : first_half > 0                ? subdomain % first_half
                                                           : 0);
}

/// Collective. Whoever has a subdomain with a node prefers to own it and its unknowns.
class Division
{
public:
  /// @param patterns of the whole
  Division(const FormProblem &whole, const std::vector<ConstraintPattern> &patterns,
           std::shared_ptr<MessageExchange> messages, Deal deal)
    : whole_(whole)
    , messages_(std::move(messages))
    , local_of_(static_cast<std::size_t>(whole.n_nodes()), -1)
  {
    part_.dim = whole.dim;
    part_.n_rigid = whole.n_rigid;
    const Communicator &all = messages_->communicator();
    for (std::size_t s = 0; s < whole.subdomains.size(); ++s)
      if (rank_of_subdomain(deal, s, whole.subdomains.size(), all.size()) == all.rank())
      {
        part_.subdomains.push_back(whole.subdomains[s]);
        part_.whole_subdomains.push_back(s);
      }
    number_nodes(patterns);
    number_unknowns();
  }
  [[nodiscard]] ProblemPart take() { return std::move(part_); }

private:
  void add_node(Index node)
  {
    if (local_of_[node] >= 0)
      return;
    local_of_[node] = static_cast<Index>(part_.nodes.size());
    part_.nodes.push_back(node);
    for (int c = 0; c < whole_.dim; ++c)
      part_.points.push_back(whole_.points[node * whole_.dim + c]);
  }
  [[nodiscard]] bool is_rigid(Index node) const
  {
    for (int c = 0; c < whole_.dim; ++c)
      for (const Term &term : whole_.layout.terms(node * whole_.dim + c))
        if (term.unknown < whole_.n_rigid)
          return true;
    return false;
  }

  void number_nodes(const std::vector<ConstraintPattern> &patterns)
  {
    for (SubdomainMatrix &matrix : part_.subdomains)
      for (Index &node : matrix.nodes)
      {
        add_node(node);
        node = local_of_[node];
      }
    n_touched_ = part_.nodes.size();
    for (Index node = 0; node < whole_.n_nodes(); ++node)
      if (is_rigid(node))
        add_node(node);
    share_nodes();
    take_constraints(patterns);
    share_nodes();
    for (const Index node : whole_.contact_nodes)
      if (local_of_[node] >= 0)
        part_.contact_nodes.push_back(local_of_[node]);
  }
  void share_nodes()
  {
    std::vector<char> preferred(part_.nodes.size(), 0);
    std::fill_n(preferred.begin(), n_touched_, 1);
    part_.nodes_sharing =
        Sharing(messages_, "nodes", std::vector<GlobalIndex>(part_.nodes.begin(), part_.nodes.end()), preferred);
  }
  /// Those of own impactor nodes, with the halo that they need.
  void take_constraints(const std::vector<ConstraintPattern> &patterns)
  {
    const int dim = whole_.dim;
    for (std::size_t k = 0; k < patterns.size(); ++k)
      if (const Index impactor = local_of_[patterns[k].nodal[0] / dim];
          impactor >= 0 && impactor < part_.nodes_sharing.size() && part_.nodes_sharing.is_own(impactor))
      {
        part_.whole_constraints.push_back(k);
        ConstraintPattern &pattern = part_.patterns.emplace_back(patterns[k]);
        for (Index &nodal : pattern.nodal)
        {
          add_node(nodal / dim);
          nodal = local_of_[nodal / dim] * dim + nodal % dim;
        }
        for (int m = 0; m < pattern.n_multipliers; ++m)
        {
          multipliers_.push_back(whole_.layout.multiplier(pattern.multipliers[m]));
          pattern.multipliers[m] = static_cast<Index>(multipliers_.size()) - 1;
        }
      }
  }

  void number_unknowns()
  {
    const int dim = whole_.dim;
    std::vector<Index> offsets{0};
    std::vector<Term> terms;
    std::vector<GlobalIndex> ids;
    std::vector<char> preferred(static_cast<std::size_t>(whole_.n_rigid), 0);
    for (Index unknown = 0; unknown < whole_.n_rigid; ++unknown)
      ids.push_back(unknown);
    for (std::size_t k = 0; k < part_.nodes.size(); ++k)
      for (int c = 0; c < dim; ++c)
      {
        for (const Term &term : whole_.layout.terms(part_.nodes[k] * dim + c))
        {
          const bool rigid = term.unknown < whole_.n_rigid;
          terms.push_back({rigid ? term.unknown : static_cast<Index>(ids.size()), term.coefficient});
          if (rigid)
            continue;
          ids.push_back(term.unknown);
          preferred.push_back(k < n_touched_);
        }
        offsets.push_back(static_cast<Index>(terms.size()));
      }
    part_.unknowns.assign(ids.begin(), ids.end());
    part_.unknowns.insert(part_.unknowns.end(), multipliers_.begin(), multipliers_.end());
    part_.layout = {Sharing(messages_, "unknowns", ids, preferred), static_cast<Index>(multipliers_.size()),
                    std::move(offsets), std::move(terms)};
  }

  const FormProblem &whole_;
  std::shared_ptr<MessageExchange> messages_;
  ProblemPart part_;
  std::vector<Index> local_of_;    ///< by node of the whole
  std::size_t n_touched_ = 0;      ///< nodes that a subdomain of this process has
  std::vector<Index> multipliers_; ///< unknowns of the whole
};

/// A form of the whole problem on this process alone, and one of its part of the divided problem: they are given the
/// same and must answer the same.
class DividedForm
{
public:
  using Maker = std::function<std::unique_ptr<SystemForm>(const FormProblem &)>;

  /// Collective. @param whole must stay
  DividedForm(const FormProblem &whole, Deal deal, const Maker &make_reference, const Maker &make_divided)
    : whole_(whole)
    , deal_(deal)
    , messages_(std::make_shared<MessageExchange>(Communicator(MPI_COMM_WORLD)))
    , part_(Division(whole, whole.patterns, messages_, deal).take())
    , reference_(make_reference(whole))
    , divided_(make_divided(part_))
  {
    give_constraints(whole.patterns);
  }

  /// The part has another halo then. @param patterns of the whole; as many multipliers as before
  void set_constraints(const std::vector<ConstraintPattern> &patterns)
  {
    ProblemPart part = Division(whole_, patterns, messages_, deal_).take();
    part.subdomains.swap(part_.subdomains); // the form keeps these
    part_ = std::move(part);
    give_constraints(patterns);
  }
  /// The bodies' stiffness has changed in the whole.
  void take_bodies(const FormProblem &whole)
  {
    for (std::size_t s = 0; s < part_.subdomains.size(); ++s)
      part_.subdomains[s].values = whole.subdomains[part_.whole_subdomains[s]].values;
    for (SystemForm *form : forms())
      form->update_subdomains();
  }

  [[nodiscard]] const ProblemPart &part() const { return part_; }
  [[nodiscard]] ProblemPart &part() { return part_; }
  [[nodiscard]] SystemForm &divided() { return *divided_; }
  [[nodiscard]] SystemForm &reference() { return *reference_; }

  void prepare()
  {
    for (SystemForm *form : forms())
    {
      form->prepare();
      form->update_subdomains();
    }
    const Index n = part_.n_rigid;
    update_rigid_springs(Eigen::MatrixXd::Constant(n, n, 0.3) + 5 * Eigen::MatrixXd::Identity(n, n));
  }
  void update_rigid_springs(const Eigen::MatrixXd &springs)
  {
    for (SystemForm *form : forms())
      form->update_dense_block(0, springs);
  }
  /// @param k of the whole
  void update_constraint(std::size_t k, const ElementBlocks &blocks)
  {
    reference_->update_constraint(k, blocks.values());
    const auto &own = part_.whole_constraints;
    if (const auto place = std::find(own.begin(), own.end(), k); place != own.end())
      divided_->update_constraint(static_cast<std::size_t>(place - own.begin()), blocks.values());
  }
  /// @param modes over the displacement unknowns of the whole
  void set_held_modes(const std::vector<std::vector<double>> &modes)
  {
    std::vector<std::vector<double>> of_part;
    for (const auto &mode : modes)
    {
      of_part.emplace_back();
      for (Index i = 0; i < part_.layout.n_displacement_unknowns(); ++i)
        of_part.back().push_back(mode[part_.unknowns[i]]);
    }
    EXPECT_TRUE(reference_->set_held_modes(modes));
    EXPECT_TRUE(divided_->set_held_modes(of_part));
    prepare();
  }

  /// The divided form's solution; it must be the same on all copies. Collective. @param rhs of the whole
  std::vector<double> solve_divided(const std::vector<double> &rhs, double tolerance)
  {
    std::vector<double> x(part_.unknowns.size());
    divided_->factorize();
    divided_->solve(part_.of(rhs), x, tolerance);
    expect_equal_copies(x);
    return x;
  }
  /// The greatest difference of the divided form's solution from the reference's, over the latter's length. Collective.
  double difference(const std::vector<double> &rhs, double tolerance)
  {
    std::vector<double> expected(rhs.size());
    reference_->factorize();
    reference_->solve(rhs, expected, tolerance);
    const std::vector<double> x = solve_divided(rhs, tolerance);
    const std::vector<double> expected_here = part_.of(expected);
    double worst = 0, size = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      worst = std::max(worst, std::isfinite(x[i]) ? std::abs(x[i] - expected_here[i]) : HUGE_VAL);
    for (const double value : expected)
      size += value * value;
    EXPECT_EQ(divided_->mode_reactions().size(), reference_->mode_reactions().size());
    for (std::size_t m = 0; m < reference_->mode_reactions().size(); ++m)
      worst = std::max(worst, std::abs(divided_->mode_reactions()[m] - reference_->mode_reactions()[m]));
    return part_.layout.sharing().maximum_over_processes(worst) / std::sqrt(size);
  }

private:
  void give_constraints(const std::vector<ConstraintPattern> &patterns)
  {
    reference_->set_constraints(patterns, {rigid_unknowns()});
    divided_->set_constraints(part_.patterns, {rigid_unknowns()});
    prepare();
  }
  [[nodiscard]] std::array<SystemForm *, 2> forms() const { return {reference_.get(), divided_.get()}; }
  [[nodiscard]] std::vector<Index> rigid_unknowns() const
  {
    std::vector<Index> out;
    for (Index i = 0; i < part_.n_rigid; ++i)
      out.push_back(i);
    return out;
  }
  /// Bit by bit. Reactions of held modes are the same everywhere.
  void expect_equal_copies(const std::vector<double> &x) const
  {
    const Sharing &sharing = part_.layout.sharing();
    const auto n = static_cast<std::ptrdiff_t>(sharing.size());
    std::vector<double> owners(x.begin(), x.begin() + n);
    sharing.take_owners(owners);
    EXPECT_TRUE(std::equal(owners.begin(), owners.end(), x.begin())) << "copies of unknowns differ";
    const std::vector<double> reactions(divided_->mode_reactions().begin(), divided_->mode_reactions().end());
    std::vector<double> greatest = reactions;
    sharing.maximum_over_processes(greatest);
    EXPECT_EQ(greatest, reactions) << "reactions of held modes differ";
  }

  const FormProblem &whole_;
  Deal deal_;
  std::shared_ptr<MessageExchange> messages_;
  ProblemPart part_;
  std::unique_ptr<SystemForm> reference_, divided_;
};
} // namespace amontons::test

#pragma once
#include "amontons/algebra/subdomain_matrix.h"
#include "amontons/parallel/sharing.h"

#include <functional>
#include <span>
#include <vector>

namespace amontons
{
/// Phases under which FETI's messages are counted: what is sent in every iteration, that for contact rows by itself,
/// and the rest.
constexpr const char *feti_phase = "feti", *feti_contact_phase = "feti_contact", *feti_setup_phase = "feti_setup";

/// A node's copy in a subdomain, be it of this process or another.
struct FetiCopy
{
  Index subdomain; ///< counted over all processes
  Index node;      ///< of the subdomain
  double stiffness = 0, share = 1;
  Index column = -1; ///< of B, that of the first component; -1 for interior nodes
};

/// The copies of nodes in subdomains. Subdomains are counted over all processes, those of a process one after the
/// other; a node's copies are ordered by them, on every process alike. A process knows all copies of the nodes that it
/// has, whoever's subdomains they are in.
class FetiCopies
{
public:
  /// Collective. @param subdomains of this process @param nodes which processes have which of the nodes
  FetiCopies(Index n_nodes, std::span<const SubdomainMatrix> subdomains, const Sharing &nodes);

  [[nodiscard]] Index n_nodes() const { return static_cast<Index>(offsets_.size()) - 1; }
  [[nodiscard]] Index n_subdomains() const { return first_subdomain_.back(); }
  [[nodiscard]] Index first_own_subdomain() const { return first_subdomain_[rank_]; }
  [[nodiscard]] Index n_own_subdomains() const { return first_subdomain_[rank_ + 1] - first_subdomain_[rank_]; }
  [[nodiscard]] bool is_own(const FetiCopy &copy) const { return is_of(copy, rank_); }
  [[nodiscard]] Rank rank_of(Index subdomain) const;

  [[nodiscard]] std::span<const FetiCopy> of(Index node) const
  {
    return {copies_.data() + offsets_[node], static_cast<std::size_t>(offsets_[node + 1] - offsets_[node])};
  }
  [[nodiscard]] std::span<FetiCopy> of(Index node)
  {
    return {copies_.data() + offsets_[node], static_cast<std::size_t>(offsets_[node + 1] - offsets_[node])};
  }

  /// Hands values of copies from the process that they belong to, to all others that know them. Collective.
  /// @param width numbers to a copy, the same on all processes
  /// @param give writes those of an own copy @param take reads those of another's
  void hand_over(int width, const std::function<void(const FetiCopy &, double *)> &give,
                 const std::function<void(FetiCopy &, const double *)> &take);

private:
  struct Located
  {
    Index node; ///< of the process
    FetiCopy copy;
  };
  [[nodiscard]] bool is_of(const FetiCopy &copy, Rank rank) const
  {
    return copy.subdomain >= first_subdomain_[rank] && copy.subdomain < first_subdomain_[rank + 1];
  }
  void count_subdomains(Index n_own);
  void sort_by_node(const std::vector<Located> &copies);
  [[nodiscard]] std::vector<Located> those_of_others() const;
  /// Messages to all neighbours and from them.
  [[nodiscard]] std::vector<Message> exchange(std::vector<Message> out) const;

  Sharing nodes_;
  Rank rank_;
  std::vector<Index> first_subdomain_; ///< [n_processes + 1]
  std::vector<Index> offsets_;         ///< [n_nodes + 1]
  std::vector<FetiCopy> copies_;
};
} // namespace amontons

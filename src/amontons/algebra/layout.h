#pragma once
#include "amontons/base/ids.h"
#include "amontons/parallel/sharing.h"

#include <span>
#include <vector>

namespace amontons
{
/// What one nodal component is made of: du = sum coefficient * d(unknown) (+ what is prescribed).
struct Term
{
  Index unknown;
  double coefficient;
};

/// Numbering of unknowns. A nodal component (node * n_components + component) is one unknown (a free node), none (held)
/// or a combination (a node of a rigid body). Unknowns run: displacement unknowns, then multipliers.
///
/// Over several processes each has a layout of its own nodes: those of its subdomains, those of rigid bodies (on every
/// process), and last its halo, the other nodes that its constraints couple. Halo nodes and their unknowns are copies
/// as any other, but never owned. The multipliers are those of the process's own constraints and have no copies.
class Layout
{
public:
  Layout() = default;
  Layout(Index n_displacement_unknowns, Index n_multipliers, std::vector<Index> offsets, std::vector<Term> terms)
    : Layout(Sharing(n_displacement_unknowns), n_multipliers, std::move(offsets), std::move(terms))
  {
  }
  /// @param sharing of the displacement unknowns
  Layout(Sharing sharing, Index n_multipliers, std::vector<Index> offsets, std::vector<Term> terms)
    : sharing_(std::move(sharing))
    , n_displacement_unknowns_(sharing_.size())
    , n_multipliers_(n_multipliers)
    , offsets_(std::move(offsets))
    , terms_(std::move(terms))
  {
  }

  /// Of the displacement unknowns.
  [[nodiscard]] const Sharing &sharing() const { return sharing_; }
  [[nodiscard]] Index n_nodal() const { return static_cast<Index>(offsets_.size()) - 1; }
  [[nodiscard]] Index n_displacement_unknowns() const { return n_displacement_unknowns_; }
  [[nodiscard]] Index n_multipliers() const { return n_multipliers_; }
  [[nodiscard]] Index n_unknowns() const { return n_displacement_unknowns_ + n_multipliers_; }
  [[nodiscard]] Index multiplier(Index m) const { return n_displacement_unknowns_ + m; }

  [[nodiscard]] std::span<const Term> terms(Index nodal) const
  {
    return {terms_.data() + offsets_[nodal], static_cast<std::size_t>(offsets_[nodal + 1] - offsets_[nodal])};
  }
  /// For coefficients that turn with a rigid body; the pattern stays.
  [[nodiscard]] std::span<Term> terms(Index nodal)
  {
    return {terms_.data() + offsets_[nodal], static_cast<std::size_t>(offsets_[nodal + 1] - offsets_[nodal])};
  }

  /// unknown_vector[unknown] += coefficient * nodal_vector[nodal]: forces on nodes to forces on unknowns.
  void gather(std::span<const double> nodal_vector, std::span<double> unknown_vector) const
  {
    for (Index i = 0; i < n_nodal(); ++i)
      for (const Term &term : terms(i))
        unknown_vector[term.unknown] += term.coefficient * nodal_vector[i];
  }

private:
  Sharing sharing_;
  Index n_displacement_unknowns_ = 0;
  Index n_multipliers_ = 0;
  std::vector<Index> offsets_{0}; ///< [n_nodal + 1]
  std::vector<Term> terms_;
};
} // namespace amontons

#pragma once
#include "amontons/algebra/feti_coarse.h"
#include "amontons/algebra/feti_interface.h"
#include "amontons/algebra/feti_scaling.h"

#include <array>

namespace amontons
{
/// Rows of B beyond the gluing that a process gives: contact, and small stiffnesses taken as springs of their own.
struct FetiContactRows
{
  FetiRows rows, forces;        ///< of B and of B_f; columns of FetiInterface, then one column per spring
  std::vector<double> springs;  ///< stiffness of each spring, of either sign
  std::vector<Index> impactors; ///< node of each row, or -1
  bool symmetric = true;        ///< forces equal rows

  friend bool operator==(const FetiContactRows &, const FetiContactRows &) = default;
};

/// Contact rows, each given by one process and known to those that have a column of it in a subdomain of theirs.
///
/// Who gives a row knows all its columns. Each of the others gets from it the entries on its own columns and the whole
/// row of G, with which a motion of subdomains that it does not know still gives the row's value without a message. A
/// process has its own rows first, then the others'; vectors over the rows have equal copies, bit by bit. Rows have
/// length one in the inner product of D^-1.
class FetiContact
{
public:
  /// @param processes for what is agreed when rows change
  FetiContact(const FetiInterface &interface, const FetiKernel &kernel, const Sharing &processes)
    : interface_(interface)
    , kernel_(kernel)
    , processes_(processes)
  {
  }

  /// Takes the rows that this process gives, and sends and gets what is to be known of them. Collective.
  /// @param kernel that of this object, over the columns of the springs too
  /// @param inverse_stiffness of FetiInterface's columns, then of the springs
  /// @param mean its mean over all processes, for rows on rigid unknowns only
  void set(FetiContactRows given, std::span<const double> inverse_stiffness, double mean);

  [[nodiscard]] bool is_symmetric() const { return symmetric_; }
  [[nodiscard]] Index size() const { return side(false).rows.size(); }
  [[nodiscard]] Index n_own() const { return static_cast<Index>(scale_.size()); }
  [[nodiscard]] Index n_columns() const { return interface_.n_columns() + static_cast<Index>(springs_.size()); }
  /// Stiffness of the springs of own rows.
  [[nodiscard]] std::span<const double> springs() const { return springs_; }
  /// By which the given rows were multiplied. [n_own()]
  [[nodiscard]] std::span<const double> row_scale() const { return scale_; }

  /// Of B, B_f with `forces`, the entries on own columns; on rigid unknowns and springs if the row is own.
  [[nodiscard]] const FetiRows &rows(bool forces) const { return side(forces).rows; }
  /// The rows of G = B R, G_f, over the coarse unknowns.
  [[nodiscard]] const FetiRows &motions(bool forces) const { return side(forces).motions; }

  /// Each row's value becomes the sum of all processes' parts. Collective, as apply_scaling().
  void sum(std::span<double> values) const { sharing_.sum(values); }
  /// values = (B D^-1 B^T)^-1 values, or with B_f, nearly.
  void apply_scaling(std::span<double> values, bool forces) const { side(forces).scaling.apply(values, sharing_); }

private:
  struct Side
  {
    FetiRows rows, motions;
    FetiScaling scaling;
  };
  [[nodiscard]] Side &side(bool forces) { return sides_[forces && !symmetric_]; }
  [[nodiscard]] const Side &side(bool forces) const { return sides_[forces && !symmetric_]; }
  void scale_rows(FetiContactRows &given, std::span<const double> inverse_stiffness, double mean);
  using Whole = std::array<const FetiRows *, 2>; ///< own rows of each side, over all their columns
  void take_own(const Whole &whole);
  [[nodiscard]] std::vector<Message> messages_to_others(const Whole &whole) const;
  void take_row_of_other(ByteReader &reader);
  void exchange(const Whole &whole);
  [[nodiscard]] double least_own_share(const FetiRows &rows, const FetiContactRows &given,
                                       std::span<const double> inverse_stiffness) const;
  [[nodiscard]] bool is_here(Index column) const
  {
    return column >= interface_.first_rigid_column() ||
           (column >= interface_.first_own_column() && column < interface_.end_of_own_columns());
  }
  [[nodiscard]] int n_sides() const { return symmetric_ ? 1 : 2; }

  const FetiInterface &interface_;
  const FetiKernel &kernel_;
  const Sharing &processes_;
  std::array<Side, 2> sides_;
  std::vector<double> springs_, scale_;
  Sharing sharing_;
  bool symmetric_ = true;
};
} // namespace amontons

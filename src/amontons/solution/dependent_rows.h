#pragma once
#include "amontons/algebra/coupled_form.h"
#include "amontons/contact/element.h"

#include <map>
#include <vector>

namespace amontons
{
/// Constraint rows of the contact elements of one impactor node, made independent of each other.
///
/// At nodes that a support holds, or that are impactors in several contacts, rows can depend on each other or on
/// nothing. The rule: all normal rows are taken first, then the tangential ones, each in the order of the deck's
/// contacts; a row (of a tangent plane, a direction) whose part on the unknowns depends on the rows already taken is
/// dropped and its multiplier is zero. So the matrix is regular and pressures are unique (docs/decisions/0006).
class DependentRows
{
public:
  explicit DependentRows(const Layout &layout)
    : layout_(layout)
  {
  }

  /// Takes the normal row of a closed element, or replaces it by lambda = 0.
  /// @param pattern nodal components of the element's dofs @param r its augmentation parameter
  void filter_normal(ContactElement &element, const ConstraintPattern &pattern, const Multipliers &lambda, double r);

  /// The same for the tangential rows of a sticking element.
  void filter_sticking(ContactElement &element, const ConstraintPattern &pattern, const Multipliers &lambda, double r);

private:
  using SparseRow = std::map<Index, double>;
  template<class Row>
  [[nodiscard]] SparseRow on_unknowns(const ConstraintPattern &pattern, const Row &row) const;
  [[nodiscard]] bool take(SparseRow row, double full_length);
  [[nodiscard]] SparseRow without_taken(SparseRow row) const;

  const Layout &layout_;
  std::vector<SparseRow> taken_; ///< orthonormal
};
} // namespace amontons

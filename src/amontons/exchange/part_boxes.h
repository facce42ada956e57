#pragma once
#include "amontons/exchange/box.h"

#include <vector>

namespace amontons
{
/// A box per part, in a binary tree: which of them another box meets is found without looking at all.
class PartBoxes
{
public:
  explicit PartBoxes(std::vector<Box> boxes)
    : n_parts_(boxes.size())
    , tree_(n_parts_)
  {
    tree_.insert(tree_.end(), boxes.begin(), boxes.end());
    for (std::size_t k = n_parts_; k-- > 1;)
    {
      tree_[k] = tree_[2 * k];
      tree_[k].include(tree_[2 * k + 1]);
    }
  }

  /// Calls visit(part) for each part whose box is within the distance of this one.
  template<typename Visit>
  void visit_meeting(const Box &box, double distance, Visit visit) const
  {
    visit_below(1, box, distance, visit);
  }

private:
  template<typename Visit>
  void visit_below(std::size_t k, const Box &box, double distance, Visit &visit) const
  {
    if (!tree_[k].meets(box, distance))
      return;
    if (k >= n_parts_)
      return visit(static_cast<Rank>(k - n_parts_));
    visit_below(2 * k, box, distance, visit);
    visit_below(2 * k + 1, box, distance, visit);
  }

  std::size_t n_parts_;
  std::vector<Box> tree_; ///< node k has the children 2k and 2k + 1; the parts begin at n_parts_
};
} // namespace amontons

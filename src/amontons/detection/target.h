#pragma once
#include "amontons/surface/projection.h"
#include "amontons/surface/surface.h"

#include <span>

namespace amontons
{
/// The target as detection sees it: its faces where they are now, and what lies across their edges.
class Target
{
public:
  explicit Target(const Surface &surface);

  /// @param x current coordinates, [n_nodes * dim]; they must outlive their use
  void move_to(std::span<const double> x) { x_ = x; }

  [[nodiscard]] const Surface &surface() const { return *surface_; }
  [[nodiscard]] std::span<const double> coordinates() const { return x_; }
  [[nodiscard]] int n_nodes_of_face(Index f) const
  {
    return n_nodes_of_all_ > 0 ? n_nodes_of_all_ : static_cast<int>(surface_->face(f).size());
  }
  [[nodiscard]] FaceCoordinates face(Index f) const { return gather_face(surface_->dim, surface_->face(f), x_); }
  [[nodiscard]] Eigen::Vector3d node(Index i) const
  {
    const double *x = x_.data() + static_cast<std::ptrdiff_t>(i) * surface_->dim;
    return {x[0], x[1], surface_->dim == 3 ? x[2] : 0.0};
  }

  /// The face across edge k of face f (in 2D across its end k); -1 where the target ends there.
  [[nodiscard]] Index neighbour(Index f, int k) const;

private:
  const Surface *surface_;
  std::span<const double> x_;
  int n_nodes_of_all_ = 0; ///< of every face; 0: they differ
};
} // namespace amontons

#include "detection/library_method.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>

#include <optional>

namespace amontons::benchmark
{
namespace
{
using Kernel = CGAL::Simple_cartesian<double>;

// A face as the tree sees it: a box and a point of reference.
struct FaceBox
{
  FaceCoordinates x;
  [[nodiscard]] CGAL::Bbox_3 bbox() const
  {
    Eigen::Vector3d low = x.x[0], high = x.x[0];
    for (int i = 1; i < x.n_nodes; ++i)
    {
      low = low.cwiseMin(x.x[i]);
      high = high.cwiseMax(x.x[i]);
    }
    return {low.x(), low.y(), low.z(), high.x(), high.y(), high.z()};
  }
};

class FacePrimitive
{
public:
  using Id = Index;
  using Point = Kernel::Point_3;
  using Datum = FaceBox;
  using Datum_reference = FaceBox;
  using Point_reference = Point;
  struct Shared_data
  {
    const Surface *surface;
    std::span<const double> x;
  };

  FacePrimitive(std::vector<Index>::const_iterator f, const Surface &, std::span<const double>)
    : face_(*f)
  {
  }
  static Shared_data construct_shared_data(const Surface &surface, std::span<const double> x) { return {&surface, x}; }
  [[nodiscard]] Id id() const { return face_; }
  [[nodiscard]] Datum datum(const Shared_data &shared) const
  {
    return {gather_face(shared.surface->dim, shared.surface->face(face_), shared.x)};
  }
  [[nodiscard]] Point reference_point(const Shared_data &shared) const
  {
    const int dim = shared.surface->dim;
    const double *x = shared.x.data() + static_cast<std::ptrdiff_t>(shared.surface->face(face_)[0]) * dim;
    return {x[0], x[1], dim == 3 ? x[2] : 0.0};
  }

private:
  Index face_;
};

using Traits = CGAL::AABB_traits<Kernel, FacePrimitive>;
using Tree = CGAL::AABB_tree<Traits>;

double squared_distance(const Eigen::Vector3d &x, const CGAL::Bbox_3 &box)
{
  double sum = 0;
  for (int c = 0; c < 3; ++c)
  {
    const double d = std::max({0.0, box.min(c) - x[c], x[c] - box.max(c)});
    sum += d * d;
  }
  return sum;
}

// CGAL's tree of face boxes, gone through the nearer child first, our projection on the faces.
class CgalMethod : public PointwiseMethod
{
public:
  using PointwiseMethod::PointwiseMethod;

private:
  void build() override
  {
    const auto n = static_cast<std::size_t>(target().n_faces());
    std::vector<Index> faces(n);
    for (std::size_t f = 0; f < n; ++f)
      faces[f] = static_cast<Index>(f);
    tree_.emplace();
    tree_->insert(faces.cbegin(), faces.cend(), target(), target_x());
    tree_->do_not_accelerate_distance_queries();
    tree_->build();
  }

  struct Traversal
  {
    using Priority = double;
    const CgalMethod &method;
    Candidate &best;

    static constexpr bool go_further() { return true; }
    void intersection(const Eigen::Vector3d &x, const FacePrimitive &face) { method.look_at(face.id(), x, best); }
    template<typename Node>
    bool do_intersect(const Eigen::Vector3d &x, const Node &node) const
    {
      return squared_distance(x, node.bbox()) <= best.squared_distance;
    }
    template<typename Node>
    std::pair<bool, Priority> do_intersect_with_priority(const Eigen::Vector3d &x, const Node &node) const
    {
      const double distance = squared_distance(x, node.bbox());
      return {distance <= best.squared_distance, -distance};
    }
  };

  void query(const Eigen::Vector3d &x, Candidate &best) override
  {
    Traversal traversal{*this, best};
    tree_->traversal_with_priority(x, traversal);
  }

  std::optional<Tree> tree_;
};
} // namespace

std::unique_ptr<Method> make_cgal_method(const Scene &scene)
{
  return std::make_unique<CgalMethod>(scene);
}
} // namespace amontons::benchmark

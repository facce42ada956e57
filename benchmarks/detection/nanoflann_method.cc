#include "amontons/detection/pair_batch.h"
#include "detection/library_method.h"

#include <nanoflann.hpp>

#include <optional>

namespace amontons::benchmark
{
namespace
{
struct Nodes
{
  std::span<const double> x;
  std::size_t dim = 3;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return x.size() / dim; }
  [[nodiscard]] double kdtree_get_pt(std::size_t node, std::size_t axis) const { return x[node * dim + axis]; }
  template<typename Box>
  bool kdtree_get_bbox(Box &) const
  {
    return false;
  }
};

// The nearest node within a distance.
struct Nearest
{
  using DistanceType = double;
  using IndexType = std::uint32_t;
  double squared_distance;
  std::int64_t node = -1;
  [[nodiscard]] bool full() const { return true; }
  [[nodiscard]] double worstDist() const { return squared_distance; }
  bool addPoint(double squared, std::uint32_t found)
  {
    if (squared < squared_distance)
    {
      squared_distance = squared;
      node = found;
    }
    return true;
  }
};

// A k-d tree of the target's nodes: the nearest within w and half the longest diagonal, then its attached faces. Not
// exact.
template<int dimension>
class NanoflannMethod : public LibraryMethod
{
public:
  explicit NanoflannMethod(const Scene &scene)
    : LibraryMethod(scene)
  {
    nodes_.dim = dimension;
  }

private:
  using Distance = nanoflann::L2_Simple_Adaptor<double, Nodes>;
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<Distance, Nodes, dimension, std::uint32_t>;

  void build() override
  {
    nodes_.x = target_x();
    tree_.emplace(dimension, nodes_, nanoflann::KDTreeSingleIndexAdaptorParams(10));
    double squared_diagonal = 0;
    for (Index f = 0; f < target().n_faces(); ++f)
    {
      const FaceCoordinates x = face(f);
      for (int i = 0; i < x.n_nodes; ++i)
        for (int j = 0; j < i; ++j)
          squared_diagonal = std::max(squared_diagonal, (x.x[i] - x.x[j]).squaredNorm());
    }
    bound_ = scene().distance + 0.5 * std::sqrt(squared_diagonal);
  }

  void query(std::span<const double> impactor_x, std::span<Candidate> found) override
  {
    PairBatch pairs(target(), target_x(), static_cast<int>(target().face(0).size()));
    for (Index node = 0; node < scene().impactor.n_nodes(); ++node)
    {
      const double *x = impactor_x.data() + static_cast<std::ptrdiff_t>(node) * dimension;
      Nearest nearest{bound_ * bound_};
      tree_->findNeighbors(nearest, x, nanoflann::SearchParams());
      found[node] = {};
      if (nearest.node >= 0)
        for (const Index f : target().faces_of_node(static_cast<Index>(nearest.node)))
          pairs.add(node, f, x, found);
    }
    pairs.project(found);
  }

  Nodes nodes_;
  std::optional<Tree> tree_;
  double bound_ = 0;
};
} // namespace

std::unique_ptr<Method> make_nanoflann_method(const Scene &scene)
{
  if (scene.target.dim == 2)
    return std::make_unique<NanoflannMethod<2>>(scene);
  return std::make_unique<NanoflannMethod<3>>(scene);
}
} // namespace amontons::benchmark

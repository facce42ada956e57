#include "amontons/detection/renumbered_detector.h"

#include "amontons/detection/large_vector.h"
#include "amontons/detection/visiting_order.h"

namespace amontons
{
namespace
{
/// A surface with its nodes in a given order and its faces in that of their first nodes; without reference coordinates,
/// which detection does not ask for.
struct Renumbered
{
  Renumbered(const Surface &original, std::vector<Index> node_order);

  Surface surface;
  std::vector<Index> nodes, faces; ///< those on the original surface
};

Renumbered::Renumbered(const Surface &original, std::vector<Index> node_order)
  : nodes(std::move(node_order))
{
  surface.dim = original.dim;
  surface.node_ids.reserve(nodes.size());
  std::vector<Index> number(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    number[nodes[i]] = static_cast<Index>(i);
    surface.node_ids.push_back(original.node_ids[nodes[i]]);
  }
  if (original.node_face_offsets.size() != nodes.size() + 1)
    return; // nodes alone
  surface.face_nodes.reserve(original.face_nodes.size());
  surface.face_offsets.reserve(original.face_offsets.size());
  surface.face_ids.reserve(original.face_ids.size());
  faces.reserve(original.face_ids.size());
  std::vector<char> taken(original.face_ids.size(), 0);
  for (const Index node : nodes)
    for (const Index f : original.faces_of_node(node))
    {
      if (taken[f])
        continue;
      taken[f] = 1;
      faces.push_back(f);
      for (const Index own : original.face(f))
        surface.face_nodes.push_back(number[own]);
      surface.face_offsets.push_back(static_cast<Index>(surface.face_nodes.size()));
      surface.face_ids.push_back(original.face_ids[f]);
      if (!original.face_bodies.empty())
        surface.face_bodies.push_back(original.face_bodies[f]);
    }
  surface.build_adjacency();
}

/// One side as given or renumbered.
class Side
{
public:
  explicit Side(const Surface &surface)
    : given_(surface)
  {
    if (std::vector<Index> order = numbering_order(surface); !order.empty())
      own_.emplace(surface, std::move(order));
  }

  [[nodiscard]] bool is_renumbered() const { return own_.has_value(); }
  [[nodiscard]] const Surface &surface() const { return own_ ? own_->surface : given_; }
  [[nodiscard]] std::span<const Index> nodes() const { return own_ ? own_->nodes : std::span<const Index>{}; }
  [[nodiscard]] std::span<const Index> faces() const { return own_ ? own_->faces : std::span<const Index>{}; }

  std::span<const double> numbered(std::span<const double> x)
  {
    if (!own_)
      return x;
    const int dim = given_.dim;
    x_.resize(x.size());
    for (std::size_t i = 0; i < own_->nodes.size(); ++i)
      for (int c = 0; c < dim; ++c)
        x_[i * dim + c] = x[static_cast<std::size_t>(own_->nodes[i]) * dim + c];
    return x_;
  }
  /// Of what numbered() gave nothing is needed any more.
  void release() { x_ = LargeVector<double>(); }

private:
  const Surface &given_;
  std::optional<Renumbered> own_;
  LargeVector<double> x_;
};

class RenumberedDetector : public Detector
{
public:
  RenumberedDetector(const Surface &impactor, const Surface &target)
    : impactor_(impactor)
    , target_(target)
  {
  }

  [[nodiscard]] bool is_needed() const { return impactor_.is_renumbered() || target_.is_renumbered(); }
  void start(const DetectorMaker &make)
  {
    inner_ = make(impactor_.surface(), target_.surface(), {impactor_.nodes(), target_.faces()});
  }

  const Pairing &detect(std::span<const double> impactor_x, std::span<const double> target_x, double reach) override
  {
    return released(inner_->detect(impactor_.numbered(impactor_x), target_.numbered(target_x), reach));
  }
  const Pairing &detect_within(std::span<const double> impactor_x, std::span<const double> target_x, double w) override
  {
    return released(inner_->detect_within(impactor_.numbered(impactor_x), target_.numbered(target_x), w));
  }

  [[nodiscard]] DetectionReport report() const override { return inner_->report(); }

private:
  const Pairing &released(const Pairing &found)
  {
    impactor_.release();
    target_.release();
    return found;
  }

  Side impactor_, target_;
  std::unique_ptr<Detector> inner_;
};
} // namespace

std::unique_ptr<Detector> make_renumbered_detector(const Surface &impactor, const Surface &target,
                                                   const DetectorMaker &make)
{
  auto detector = std::make_unique<RenumberedDetector>(impactor, target);
  if (!detector->is_needed())
    return nullptr;
  detector->start(make);
  return detector;
}
} // namespace amontons

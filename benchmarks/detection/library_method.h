#pragma once
#include "amontons/detection/search.h"
#include "amontons/surface/projection.h"
#include "detection/method.h"

#include <limits>

namespace amontons::benchmark
{
/// What the ways by libraries have in common: their search, our projection on the faces that it comes upon, and of each
/// node the closest face with its local coordinates.
class LibraryMethod : public Method
{
public:
  explicit LibraryMethod(const Scene &scene)
    : scene_(scene)
    , found_(scene.impactor.node_ids.size())
  {
  }

  Phases detect(const Positions &positions) final
  {
    target_x_ = positions.target;
    Phases phases;
    const double start = processor_time();
    build();
    const double built = processor_time();
    query(positions.impactor, found_);
    phases.build = built - start;
    phases.query = processor_time() - built;
    return phases;
  }

  [[nodiscard]] std::vector<double> distances() const final
  {
    std::vector<double> result;
    for (const Candidate &found : found_)
      result.push_back(found.face >= 0 ? std::sqrt(found.squared_distance) : std::numeric_limits<double>::infinity());
    return result;
  }

protected:
  virtual void build() = 0;
  /// @param found on entry what the last detection found
  virtual void query(std::span<const double> impactor_x, std::span<Candidate> found) = 0;

  [[nodiscard]] int dim() const { return scene_.target.dim; }
  [[nodiscard]] const Scene &scene() const { return scene_; }
  [[nodiscard]] const Surface &target() const { return scene_.target; }
  [[nodiscard]] std::span<const double> target_x() const { return target_x_; }
  [[nodiscard]] FaceCoordinates face(Index f) const { return gather_face(dim(), target().face(f), target_x_); }

  void look_at(Index f, const Eigen::Vector3d &x, Candidate &best) const
  {
    const ClosestPoint closest = closest_point(face(f), x);
    if (closest.squared_distance <= best.squared_distance)
      best = {f, closest.xi, closest.squared_distance};
  }

private:
  const Scene &scene_;
  std::vector<Candidate> found_;
  std::span<const double> target_x_;
};

/// A library that calls back with one face after another, each of which may shrink the bound: projections cannot be put
/// together.
class PointwiseMethod : public LibraryMethod
{
public:
  using LibraryMethod::LibraryMethod;

protected:
  /// @param best on entry a bound
  virtual void query(const Eigen::Vector3d &x, Candidate &best) = 0;

private:
  void query(std::span<const double> impactor_x, std::span<Candidate> found) final
  {
    for (Index node = 0; node < scene().impactor.n_nodes(); ++node)
    {
      const Eigen::Vector3d x = point_of(impactor_x, dim(), node);
      Candidate best{-1, {0, 0}, scene().distance * scene().distance};
      if (found[node].face >= 0) // the face of the last detection bounds the distance
        look_at(found[node].face, x, best);
      query(x, best);
      found[node] = best;
    }
  }
};
} // namespace amontons::benchmark

#include "amontons/detection/detector.h"
#include "detection/method.h"
#include "surface/surfaces.h"

#include <limits>

namespace amontons::benchmark
{
namespace
{
DetectionMethod method_of(const std::string &name)
{
  return name == "nearest-node" ? DetectionMethod::nearest_node
         : name == "brute"      ? DetectionMethod::brute
                                : DetectionMethod::exact;
}

// The library's detector, from coordinates to the whole pairing: gap, kind, sides and ends included.
class OwnMethod : public Method
{
public:
  OwnMethod(const Scene &scene, const std::string &name, bool bare)
    : scene_(scene)
    , without_faces_(bare ? test::cloud(scene.impactor.dim, scene.impactor.reference) : Surface{})
  {
    options_.method = method_of(name);
    if (bare)
      options_.extension = 1e100;
    impactor_ = bare ? &without_faces_ : &scene.impactor;
  }

  Phases detect(const Positions &positions) override
  {
    const double start = processor_time();
    if (!detector_)
      detector_ = make_detector(options_, *impactor_, scene_.target);
    const double made = processor_time();
    pairing_ = &detector_->detect(positions.impactor, positions.target, scene_.reach);
    const double whole = processor_time() - made;
    Phases phases;
    phases.steps = detector_->report().seconds;
    double wall = 0;
    for (const auto &[step, seconds] : phases.steps)
      wall += seconds;
    for (auto &[step, seconds] : phases.steps) // the detector's own clock runs on while others have the processor
      seconds *= whole / wall;
    phases.setup = made - start;
    phases.build = phases.steps["bounds"] + phases.steps["fill"];
    phases.query = whole - phases.build;
    return phases;
  }

  [[nodiscard]] std::vector<double> distances() const override
  {
    std::vector<double> result;
    for (const Pair &pair : *pairing_)
      result.push_back(pair.distance);
    return result;
  }

  [[nodiscard]] bool keeps_pairs() const override { return options_.method == DetectionMethod::exact; }

private:
  const Scene &scene_;
  Surface without_faces_;
  const Surface *impactor_;
  DetectionOptions options_;
  std::unique_ptr<Detector> detector_;
  const Pairing *pairing_ = nullptr;
};
} // namespace

std::unique_ptr<Method> make_own_method(const Scene &scene, const std::string &name, bool bare)
{
  return std::make_unique<OwnMethod>(scene, name, bare);
}
} // namespace amontons::benchmark

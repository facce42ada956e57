#include "amontons/base/error.h"
#include "detection/library_method.h"

#include <embree3/rtcore.h>

#include <atomic>

namespace amontons::benchmark
{
namespace
{
// Larger than what single precision takes from a coordinate, relative to it.
constexpr float rounding = 1.2e-7F;

template<auto release>
struct Release
{
  template<typename Handle>
  void operator()(Handle *handle) const
  {
    release(handle);
  }
};

// Embree's point query on boxes of faces, our projection on the faces that it calls back with. Its boxes are in single
// precision: they and the radius are grown by what rounding may take, so that the result is exact.
class EmbreeMethod : public PointwiseMethod
{
public:
  explicit EmbreeMethod(const Scene &scene)
    : PointwiseMethod(scene)
    , device_(rtcNewDevice("threads=1,user_threads=1"))
  {
    if (!device_)
      throw InternalError("Embree gives no device");
    rtcSetDeviceMemoryMonitorFunction(device_.get(), count_bytes, &bytes_);
  }

  [[nodiscard]] std::size_t bytes_apart() const override { return static_cast<std::size_t>(bytes_.load()); }

private:
  static bool count_bytes(void *counter, ssize_t bytes, bool)
  {
    *static_cast<std::atomic<std::int64_t> *>(counter) += bytes;
    return true;
  }

  static void bounds_of(const RTCBoundsFunctionArguments *arguments)
  {
    const auto &self = *static_cast<const EmbreeMethod *>(arguments->geometryUserPtr);
    const FaceCoordinates x = self.face(static_cast<Index>(arguments->primID));
    Eigen::Vector3d low = x.x[0], high = x.x[0];
    for (int i = 1; i < x.n_nodes; ++i)
    {
      low = low.cwiseMin(x.x[i]);
      high = high.cwiseMax(x.x[i]);
    }
    const double slack = rounding * self.size_;
    RTCBounds &bounds = *arguments->bounds_o;
    bounds.lower_x = static_cast<float>(low.x() - slack);
    bounds.lower_y = static_cast<float>(low.y() - slack);
    bounds.lower_z = static_cast<float>(low.z() - slack);
    bounds.upper_x = static_cast<float>(high.x() + slack);
    bounds.upper_y = static_cast<float>(high.y() + slack);
    bounds.upper_z = static_cast<float>(high.z() + slack);
  }

  void build() override
  {
    size_ = 0;
    for (const double x : target_x())
      size_ = std::max(size_, std::abs(x));
    size_ += scene().distance;
    if (scene_of_embree_) // the faces moved: their boxes are made anew in the same tree
    {
      rtcCommitGeometry(geometry_.get());
      rtcCommitScene(scene_of_embree_.get());
      return;
    }
    scene_of_embree_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_of_embree_.get(), RTC_SCENE_FLAG_DYNAMIC);
    geometry_.reset(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryUserPrimitiveCount(geometry_.get(), static_cast<unsigned>(target().n_faces()));
    rtcSetGeometryUserData(geometry_.get(), this);
    rtcSetGeometryBoundsFunction(geometry_.get(), bounds_of, nullptr);
    rtcSetGeometryBuildQuality(geometry_.get(), RTC_BUILD_QUALITY_REFIT);
    rtcCommitGeometry(geometry_.get());
    rtcAttachGeometry(scene_of_embree_.get(), geometry_.get());
    rtcCommitScene(scene_of_embree_.get());
  }

  struct Visit
  {
    const EmbreeMethod &method;
    const Eigen::Vector3d &x;
    Candidate &best;
  };

  [[nodiscard]] float radius(double squared_distance) const
  {
    return static_cast<float>(std::sqrt(squared_distance)) * (1 + rounding) + rounding * static_cast<float>(size_);
  }

  static bool look(RTCPointQueryFunctionArguments *arguments)
  {
    auto &visit = *static_cast<Visit *>(arguments->userPtr);
    const double before = visit.best.squared_distance;
    visit.method.look_at(static_cast<Index>(arguments->primID), visit.x, visit.best);
    if (visit.best.squared_distance >= before)
      return false;
    arguments->query->radius = visit.method.radius(visit.best.squared_distance);
    return true;
  }

  void query(const Eigen::Vector3d &x, Candidate &best) override
  {
    Visit visit{*this, x, best};
    RTCPointQuery point{static_cast<float>(x.x()), static_cast<float>(x.y()), static_cast<float>(x.z()), 0,
                        radius(best.squared_distance)};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_of_embree_.get(), &point, &context, look, &visit);
  }

  std::atomic<std::int64_t> bytes_{0};
  std::unique_ptr<RTCDeviceTy, Release<rtcReleaseDevice>> device_;
  std::unique_ptr<RTCSceneTy, Release<rtcReleaseScene>> scene_of_embree_;
  std::unique_ptr<RTCGeometryTy, Release<rtcReleaseGeometry>> geometry_;
  double size_ = 0;
};
} // namespace

std::unique_ptr<Method> make_embree_method(const Scene &scene)
{
  return std::make_unique<EmbreeMethod>(scene);
}
} // namespace amontons::benchmark

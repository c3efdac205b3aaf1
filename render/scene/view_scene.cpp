#include "render/scene/view_scene.hpp"

#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "render/scene/embree.hpp"

namespace tesserae::render {
namespace {

/// Part of the lengths involved by which bounds are widened: several times the rounding of a double
/// to a float, of boxes, ray origins and directions, which Embree knows nothing of.
constexpr double kWidenFloats = 5e-7;

/// A Ray under way, with Embree's context at its head, which is all that Embree hands to callbacks.
struct Query {
    RayContext context = ray_context();
    const PlacedBodies* placed = nullptr;
    const Settings* settings = nullptr;
    FrameStats* stats = nullptr;
    Ray ray;
    Hit hit;

    void test(std::uint32_t body) {
        if (hit.take(body, hit_distance(*placed, body, ray, *settings, *stats)))
            ray.limit = hit.distance;
    }
    /// A float that is no smaller than the limit.
    float reach() const {
        const float f = static_cast<float>(ray.limit);
        return f < ray.limit ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
    }
};

/// Everything that fails in Embree here does so for lack of memory.
void check(RTCDevice device) {
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE)
        throw RunError(fmt::format("Embree reports error {} while bounds are built: out of memory?",
                                   static_cast<int>(error)));
}

}  // namespace

struct ViewScene::EmbreeScene {
    std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device{rtcNewDevice(nullptr),
                                                                     &rtcReleaseDevice};
    std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene{nullptr, &rtcReleaseScene};
    std::span<const SliceBounds> slice;
    double reach;

    EmbreeScene(std::span<const SliceBounds> bounds, double origins_reach);
    static void bounds_of(const RTCBoundsFunctionArguments* args);
    static void intersect(const RTCIntersectFunctionNArguments* args);
};

ViewScene::EmbreeScene::EmbreeScene(std::span<const SliceBounds> bounds, double origins_reach)
    : slice(bounds), reach(origins_reach) {
    check(device.get());
    scene.reset(rtcNewScene(device.get()));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(slice.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, &bounds_of, nullptr);
    rtcSetGeometryIntersectFunction(geometry, &intersect);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcJoinCommitScene(scene.get());
    check(device.get());
}

void ViewScene::EmbreeScene::bounds_of(const RTCBoundsFunctionArguments* args) {
    const auto& embree = *static_cast<const EmbreeScene*>(args->geometryUserPtr);
    const SliceBounds& s = embree.slice[args->primID];
    const double widen = kWidenFloats * (s.centre.lpNorm<1>() + s.radius + embree.reach);
    const Eigen::Vector3f low = (s.low.array() - widen).matrix().cast<float>();
    const Eigen::Vector3f high = (s.high.array() + widen).matrix().cast<float>();
    RTCBounds& b = *args->bounds_o;
    b.lower_x = low.x(), b.lower_y = low.y(), b.lower_z = low.z();
    b.upper_x = high.x(), b.upper_y = high.y(), b.upper_z = high.z();
}

/// Called with single rays only: they are traced one by one.
void ViewScene::EmbreeScene::intersect(const RTCIntersectFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    const auto& embree = *static_cast<const EmbreeScene*>(args->geometryUserPtr);
    auto& query = *reinterpret_cast<Query*>(args->context);
    query.test(embree.slice[args->primID].body);
    auto& ray = *reinterpret_cast<RTCRayHit*>(args->rayhit);
    ray.ray.tfar = query.reach();
}

ViewScene::ViewScene(const PlacedBodies& placed, const Camera& camera, const Settings& settings,
                     const SliceRange& range, double reach)
    : placed_(placed), camera_(camera), settings_(settings), range_(range), reach_(reach) {
    // A ray from the side reaches as far as one from the camera that may go farther.
    for (const SliceBounds& s : slice_bounds(placed, camera, settings.ray_limit() + reach, range))
        if (s.radius < kInfinite)
            slice_.push_back(s);
        else
            unbounded_.push_back(s.body);
    if (!slice_.empty()) embree_ = std::make_unique<EmbreeScene>(slice_, reach);
}

ViewScene::~ViewScene() = default;

void ViewScene::nearest(std::span<const ViewRay> rays, std::span<Hit> hits,
                        FrameStats& stats) const {
    TSR_ASSERT(rays.size() == hits.size());
    Query query;
    query.placed = &placed_, query.settings = &settings_, query.stats = &stats;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const ViewRay& r = rays[i];
        // Embree's own assertions end the program on a NaN.
        TSR_ASSERT(r.origin.norm() <= reach_ && r.direction.allFinite());
        TSR_ASSERT(r.fourth >= range_.low && r.fourth <= range_.high);
        query.ray = camera_.to_world(r, settings_.ray_limit());
        query.hit = {};
        for (const std::uint32_t body : unbounded_) query.test(body);
        if (embree_) {
            RTCRayHit ray{};
            ray.ray.org_x = static_cast<float>(r.origin.x());
            ray.ray.org_y = static_cast<float>(r.origin.y());
            ray.ray.org_z = static_cast<float>(r.origin.z());
            ray.ray.dir_x = static_cast<float>(r.direction.x());
            ray.ray.dir_y = static_cast<float>(r.direction.y());
            ray.ray.dir_z = static_cast<float>(r.direction.z());
            ray.ray.tfar = query.reach();
            ray.ray.mask = ~0u;
            ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            render::intersect(embree_->scene.get(), query.context, ray);
        }
        hits[i] = query.hit;
    }
}

}  // namespace tesserae::render

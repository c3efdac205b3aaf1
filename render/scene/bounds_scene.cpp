// SPDX-License-Identifier: Apache-2.0
#include "render/scene/bounds_scene.hpp"

#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "render/scene/embree.hpp"

namespace tesserae::render {
namespace {

/// Part of the lengths involved by which bounds are widened: several times the rounding of a double
/// to a float, of boxes, ray origins and directions, which Embree knows nothing of.
constexpr double kWidenFloats = 5e-7;

/// A search under way, with Embree's context at its head, which is all that Embree hands to
/// callbacks.
struct Query {
    RayContext context = ray_context();
    BoundsScene::Search* candidates = nullptr;
};

/// A float that is no smaller.
float float_above(double value) {
    const float f = static_cast<float>(value);
    return f < value ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

/// Everything that fails in Embree here does so for lack of memory.
void check(RTCDevice device) {
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE)
        throw RunError(fmt::format("Embree reports error {} while bounds are built: out of memory?",
                                   static_cast<int>(error)));
}

}  // namespace

struct BoundsScene::EmbreeScene {
    std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device{rtcNewDevice(nullptr),
                                                                     &rtcReleaseDevice};
    std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene{nullptr, &rtcReleaseScene};
    const std::vector<SliceBounds>& slice;
    double reach;

    EmbreeScene(const std::vector<SliceBounds>& bounds, double origins_reach);
    static void bounds_of(const RTCBoundsFunctionArguments* args);
    static void intersect(const RTCIntersectFunctionNArguments* args);
};

BoundsScene::EmbreeScene::EmbreeScene(const std::vector<SliceBounds>& bounds, double origins_reach)
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

void BoundsScene::EmbreeScene::bounds_of(const RTCBoundsFunctionArguments* args) {
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
void BoundsScene::EmbreeScene::intersect(const RTCIntersectFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    auto& query = *reinterpret_cast<Query*>(args->context);
    auto& ray = *reinterpret_cast<RTCRayHit*>(args->rayhit);
    ray.ray.tfar = float_above(query.candidates->test(args->primID));
}

BoundsScene::BoundsScene(const std::vector<SliceBounds>& bounds, double reach) : reach_(reach) {
    if (!bounds.empty()) embree_ = std::make_unique<EmbreeScene>(bounds, reach);
}

BoundsScene::~BoundsScene() = default;
BoundsScene::BoundsScene(BoundsScene&&) noexcept = default;

void BoundsScene::search(const ViewRay& r, double limit, Search& candidates) const {
    // Embree's own assertions end the program on a NaN.
    TSR_ASSERT(r.origin.norm() <= reach_ && r.direction.allFinite());
    if (!embree_) return;
    Query query;
    query.candidates = &candidates;
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(r.origin.x());
    ray.ray.org_y = static_cast<float>(r.origin.y());
    ray.ray.org_z = static_cast<float>(r.origin.z());
    ray.ray.dir_x = static_cast<float>(r.direction.x());
    ray.ray.dir_y = static_cast<float>(r.direction.y());
    ray.ray.dir_z = static_cast<float>(r.direction.z());
    ray.ray.tfar = float_above(limit);
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    render::intersect(embree_->scene.get(), query.context, ray);
}

}  // namespace tesserae::render

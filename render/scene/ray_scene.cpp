// SPDX-License-Identifier: Apache-2.0
#include "render/scene/ray_scene.hpp"

#include <algorithm>
#include <array>

#include "render/scene/ray_stream.hpp"

namespace tesserae::render {

RayScene::RayScene(const PlacedBodies& placed, const BodyTree& tree, const Settings& settings)
    : placed_(placed), tree_(tree), settings_(settings) {
    // In the order of the leaves: what a ray meets one after the other lies side by side.
    slots_.resize(placed.bodies.size());
    for (const std::uint32_t index : tree.unbounded()) slots_[index] = slot_of(index);
    tree.for_each_bounded([&](std::uint32_t index) { slots_[index] = slot_of(index); });
}

RayScene::Slot RayScene::slot_of(std::uint32_t index) {
    const PlacedBody& body = placed_.bodies[index];
    const auto* ball = std::get_if<Hypersphere>(body.shape);
    const auto* box = std::get_if<Hyperbox>(body.shape);
    if (body.moves()) return {kOther, index};
    if (ball && body.turn == PlacedBody::kNotTurned) {
        balls_.push_back({body.centre, *ball});
        return {kBall, static_cast<std::uint32_t>(balls_.size() - 1)};
    }
    if (box) {
        boxes_.push_back({body.centre, placed_.turns[body.turn], *box});
        return {kBox, static_cast<std::uint32_t>(boxes_.size() - 1)};
    }
    return {kOther, index};
}

void RayScene::nearest(std::span<Ray> rays, std::span<Hit> hits, FrameStats& stats) const {
    for (std::size_t i = 0; i < rays.size(); i += RayStream::kMost) {
        const std::size_t count = std::min<std::size_t>(RayStream::kMost, rays.size() - i);
        nearest_in_stream(rays.subspan(i, count), hits.subspan(i, count), stats);
    }
}

void RayScene::find_blocked(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                            FrameStats& stats) const {
    for (std::size_t i = 0; i < rays.size(); i += RayStream::kMost) {
        const std::size_t count = std::min<std::size_t>(RayStream::kMost, rays.size() - i);
        find_blocked_in_stream(rays.subspan(i, count), blocked.subspan(i, count), stats);
    }
}

void RayScene::nearest_in_stream(std::span<Ray> rays, std::span<Hit> hits,
                                 FrameStats& stats) const {
    RayStream stream(tree_);
    const auto is_own = [&](std::uint32_t i, std::uint32_t body) { return body == rays[i].on; };
    const auto take = [&](std::uint32_t i, std::uint32_t body, double t) {
        if (!(t <= rays[i].limit) || !hits[i].take(body, t)) return;
        rays[i].limit = t;
        stream.shorten(i, t);
    };
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
        hits[i] = {};
        for (const std::uint32_t body : tree_.unbounded())
            if (!is_own(i, body))
                take(i, body, hit_distance(placed_, body, rays[i], settings_, stats));
        stream.add(rays[i]);
    }
    test_bodies(stream, rays, is_own, take, stats);
}

void RayScene::find_blocked_in_stream(std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                                      FrameStats& stats) const {
    RayStream stream(tree_);
    const auto is_settled = [&](std::uint32_t i, std::uint32_t body) {
        return blocked[i] != 0 || body == rays[i].on;
    };
    const auto take = [&](std::uint32_t i, std::uint32_t, double t) {
        if (!(t < kMiss && t <= rays[i].limit)) return;
        blocked[i] = 1;
        stream.shorten(i, -1);
    };
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
        blocked[i] = 0;
        stream.add(rays[i]);
        for (const std::uint32_t body : tree_.unbounded())
            if (!is_settled(i, body))
                take(i, body, hit_distance(placed_, body, rays[i], settings_, stats));
    }
    test_bodies(stream, rays, is_settled, take, stats);
}

/// Calls take(ray, body, distance) for bounded bodies that rays may meet and leaves_out(ray, body)
/// does not name.
template <class LeavesOut, class Take>
void RayScene::test_bodies(RayStream& stream, std::span<const Ray> rays, LeavesOut&& leaves_out,
                           Take&& take, FrameStats& stats) const {
    std::array<std::array<RayStream::Candidate, RayStream::kMostAtOnce>, kKinds> tests;
    std::array<double, RayStream::kMostAtOnce> distances;
    for (auto named = stream.next(); !named.empty(); named = stream.next()) {
        // By kind, so that no test has to ask for it, and ahead, so that none waits for memory.
        std::array<std::size_t, kKinds> counts{};
        for (const RayStream::Candidate& candidate : named) {
            const Slot& slot = slots_[candidate.body()];
            tests[slot.kind][counts[slot.kind]] = candidate;
            counts[slot.kind] += !leaves_out(candidate.ray(), candidate.body());
            prefetch(slot);
        }
        const auto for_each_test = [&](Kind kind, auto&& distance) {
            for (std::size_t k = 0; k < counts[kind]; ++k)
                distances[k] = distance(rays[tests[kind][k].ray()], tests[kind][k].body());
            for (std::size_t k = 0; k < counts[kind]; ++k)
                take(tests[kind][k].ray(), tests[kind][k].body(), distances[k]);
        };
        for_each_test(kBall, [&](const Ray& ray, std::uint32_t body) {
            const Ball& ball = balls_[slots_[body].index];
            return hit_distance(ball.shape, ray.origin - ball.centre, ray.direction, ray.limit,
                                settings_, stats);
        });
        for_each_test(kBox, [&](const Ray& ray, std::uint32_t body) {
            const Box& box = boxes_[slots_[body].index];
            return hit_distance(box.shape, box.turn * (ray.origin - box.centre),
                                box.turn * ray.direction, ray.limit, settings_, stats);
        });
        // Sphere tracing gains from what is found on the way.
        for (std::size_t k = 0; k < counts[kOther]; ++k) {
            const std::uint32_t i = tests[kOther][k].ray(), body = tests[kOther][k].body();
            if (!leaves_out(i, body))
                take(i, body, hit_distance(placed_, body, rays[i], settings_, stats));
        }
    }
}

void RayScene::prefetch(const Slot& slot) const {
    const std::array<const void*, kKinds> first = {balls_.data(), boxes_.data(),
                                                   placed_.bodies.data()};
    constexpr std::array<std::size_t, kKinds> kSize = {sizeof(Ball), sizeof(Box),
                                                       sizeof(PlacedBody)};
    const auto* record =
        static_cast<const std::byte*>(first[slot.kind]) + kSize[slot.kind] * slot.index;
    for (std::size_t at = 0; at < sizeof(Box); at += alignof(Box)) __builtin_prefetch(record + at);
}

}  // namespace tesserae::render

#include "render/scene/ray_scene.hpp"

#include <algorithm>
#include <array>

#include "render/scene/ray_stream.hpp"

namespace tesserae::render {

RayScene::RayScene(const PlacedBodies& placed, const BodyTree& tree, const Settings& settings)
    : placed_(placed), tree_(tree), settings_(settings) {
    const bool is_closed_form = settings.intersector == Intersector::kAnalytic;
    for (const PlacedBody& body : placed.bodies) {
        const auto* ball = std::get_if<Hypersphere>(body.shape);
        const auto* box = std::get_if<Hyperbox>(body.shape);
        if (body.moves()) {
            slots_.push_back({kOther, static_cast<std::uint32_t>(slots_.size())});
        } else if (is_closed_form && ball && body.turn == PlacedBody::kNotTurned) {
            slots_.push_back({kBall, static_cast<std::uint32_t>(balls_.size())});
            balls_.push_back({body.centre, *ball});
        } else if (is_closed_form && box) {
            slots_.push_back({kBox, static_cast<std::uint32_t>(boxes_.size())});
            boxes_.push_back({body.centre, placed.turns[body.turn], *box});
        } else {
            slots_.push_back({kOther, static_cast<std::uint32_t>(slots_.size())});
        }
    }
}

void RayScene::nearest(std::span<Ray> rays, std::span<Hit> hits, FrameStats& stats) const {
    for (std::size_t i = 0; i < rays.size(); i += RayStream::kMost) {
        const std::size_t count = std::min<std::size_t>(RayStream::kMost, rays.size() - i);
        nearest_in_stream(rays.subspan(i, count), hits.subspan(i, count), stats);
    }
}

void RayScene::nearest_in_stream(std::span<Ray> rays, std::span<Hit> hits,
                                 FrameStats& stats) const {
    RayStream stream(tree_);
    const auto distance = [&](std::size_t i, std::uint32_t body) {
        return hit_distance(placed_, body, rays[i], settings_, stats);
    };
    const auto take = [&](std::uint32_t i, std::uint32_t body, double t) {
        if (!(t <= rays[i].limit) || !hits[i].take(body, t)) return;
        rays[i].limit = t;
        stream.shorten(i, t);
    };
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
        hits[i] = {};
        for (const std::uint32_t body : tree_.unbounded())
            if (body != rays[i].on) take(i, body, distance(i, body));
        stream.add(rays[i]);
    }
    std::array<std::array<RayStream::Candidate, RayStream::kMostAtOnce>, kKinds> tests;
    std::array<double, RayStream::kMostAtOnce> distances;
    for (auto named = stream.next(); !named.empty(); named = stream.next()) {
        // By kind, so that no test has to ask for it, and ahead, so that none waits for memory.
        std::array<std::size_t, kKinds> counts{};
        for (const RayStream::Candidate& candidate : named) {
            const Slot& slot = slots_[candidate.body()];
            tests[slot.kind][counts[slot.kind]] = candidate;
            counts[slot.kind] += candidate.body() != rays[candidate.ray()].on;
            prefetch(slot);
        }
        const auto for_each_test = [&](Kind kind, auto&& hit_of) {
            for (std::size_t k = 0; k < counts[kind]; ++k)
                distances[k] = hit_of(tests[kind][k].ray(), tests[kind][k].body());
            for (std::size_t k = 0; k < counts[kind]; ++k)
                take(tests[kind][k].ray(), tests[kind][k].body(), distances[k]);
        };
        for_each_test(kBall, [&](std::uint32_t i, std::uint32_t body) {
            const Ball& ball = balls_[slots_[body].index];
            return ray_hit(ball.shape, rays[i].origin - ball.centre, rays[i].direction);
        });
        for_each_test(kBox, [&](std::uint32_t i, std::uint32_t body) {
            const Box& box = boxes_[slots_[body].index];
            return ray_hit(box.shape, box.turn * (rays[i].origin - box.centre),
                           box.turn * rays[i].direction);
        });
        // Sphere tracing gains from every limit that is found on the way.
        for (std::size_t k = 0; k < counts[kOther]; ++k) {
            const std::uint32_t i = tests[kOther][k].ray(), body = tests[kOther][k].body();
            take(i, body, distance(i, body));
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

bool RayScene::is_blocked(const Ray& ray, FrameStats& stats) const {
    bool blocked = false;
    const auto clears = [&](std::uint32_t body) {
        blocked = body != ray.on && hit_distance(placed_, body, ray, settings_, stats) < kMiss;
        return !blocked;
    };
    for (const std::uint32_t body : tree_.unbounded())
        if (!clears(body)) return true;
    tree_.for_each_on_ray(ray, clears);
    return blocked;
}

}  // namespace tesserae::render

#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "render/path.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {

/// A scene made ready for rays from the world's origin.
struct TracedScene {
    TestScene scene;
    Picture picture;
    PlacedBodies placed;
    BodyTree tree;
    LightSet lights;
    RoughReflections rough;
    Shading shading;
    LightTransport transport;
    mutable FrameStats stats;

    explicit TracedScene(const TestScene& s)
        : scene(s),
          picture(scene.picture()),
          placed(place_bodies(picture, Vec4::Zero())),
          tree(placed),
          lights(scene.lights, Vec4::Zero()),
          rough(picture.materials),
          shading(picture, placed, tree, lights, rough),
          transport(picture, placed, tree, lights, shading) {}
    TracedScene(const TracedScene&) = delete;

    /// The nearest body, tried one by one.
    Hit nearest(const Vec4& origin, const Vec4& direction, std::uint32_t on) const {
        Hit hit;
        for (std::uint32_t b = 0; b < placed.bodies.size(); ++b) {
            if (b == on) continue;
            const double t =
                hit_distance(placed, b, origin, direction, kMiss, scene.settings, stats);
            if (t < hit.distance) hit = {t, b};
        }
        return hit;
    }

    std::optional<Surface> first(const Vec4& direction) const {
        const Hit hit = nearest(Vec4::Zero(), direction, RayScene::kNoBody);
        if (!hit) return std::nullopt;
        return shading.surface(hit, Vec4::Zero(), direction);
    }

    Color radiance(const Vec4& direction, const Sampler& sampler) const {
        const std::optional<Surface> met = first(direction);
        const LightTransport::Start start = {met ? &*met : nullptr, Vec4::Zero(), direction,
                                             sampler};
        Color color;
        transport.radiance({&start, 1}, {&color, 1}, stats);
        return color;
    }
};

/// Mean and its deviation, a colour channel at a time.
struct Mean {
    Color sum = Color::Zero(), square = Color::Zero();
    int count = 0;

    void add(const Color& c) { sum += c, square += c * c, ++count; }
    Color mean() const { return sum / count; }
    Color sigma() const { return ((square / count - mean() * mean()).max(0) / (count - 1)).sqrt(); }
};

/// The mean of independent samples along one ray: the first sample of that many pixels, since a
/// pixel's own samples are stratified.
inline Mean mean_radiance(const TracedScene& traced, const Vec4& direction, int count) {
    Mean mean;
    for (int i = 0; i < count; ++i)
        mean.add(traced.radiance(direction, Sampler(i % 1024, i / 1024, 0)));
    return mean;
}

/// Path traced, bodies by their closed forms.
inline TestScene path_scene(int bounces) {
    TestScene scene;
    scene.settings.integrator = Integrator::kPath;
    scene.settings.bounces = bounces;
    scene.settings.intersector = Intersector::kAnalytic;
    return scene;
}

/// Within 5 deviations, and those small enough to mean something.
inline void expect_near(const Mean& found, double expected, double most_sigma,
                        const std::string& what) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_LE(found.sigma()[c], most_sigma) << what;
        EXPECT_NEAR(found.mean()[c], expected, 5 * found.sigma()[c] + 1e-12) << what;
    }
}

}  // namespace tesserae::render

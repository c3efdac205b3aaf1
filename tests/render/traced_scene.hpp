// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "render/integrator/integrator.hpp"
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
    std::unique_ptr<const LightIntegrator> integrator;
    mutable FrameStats stats;

    explicit TracedScene(const TestScene& s)
        : scene(s),
          picture(scene.picture()),
          placed(place_bodies(picture, Vec4::Zero())),
          tree(placed),
          lights(scene.lights, Vec4::Zero()),
          rough(picture.materials),
          shading(picture, placed, tree, lights, rough),
          integrator(make_integrator(picture, placed, tree, lights, shading)) {}
    TracedScene(const TracedScene&) = delete;

    /// The surface that a ray meets outside of glass.
    std::optional<Surface> first(const Ray& ray) const {
        const Hit hit = nearest_of_all(placed, ray, scene.settings, stats);
        return hit ? std::optional(shading.surface(hit, ray)) : std::nullopt;
    }

    Color radiance(const Vec4& direction, const Sampler& sampler) const {
        const Ray ray = {Vec4::Zero(), direction, kNoBody, scene.settings.ray_limit()};
        const GlassBodies& glass = integrator->glass();
        const std::uint32_t medium = glass.medium_at(ray.origin, glass.about(ray.origin, 0));
        const GlassBodies::Event event =
            medium == GlassBodies::kNone
                ? GlassBodies::Event{glass.ruling(
                      nearest_of_all(placed, ray, scene.settings, stats), ray)}
                : glass.next(medium, ray, stats);
        std::optional<Surface> met;
        if (event.hit) met = shading.surface(event.hit, ray);
        const ViewSample sample = {met ? &*met : nullptr, ray, sampler, {medium, event.is_exit}};
        Color color;
        PathWave wave;
        integrator->radiance({&sample, 1}, {&color, 1}, wave, stats);
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

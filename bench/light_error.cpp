// SPDX-License-Identifier: Apache-2.0
// Error of the traced light against the number of samples: CSV on standard output.
//   light_error [SCENE...]   these scenes only

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "render/integrator/integrator.hpp"

namespace tesserae::bench {
namespace {

using render::Color;

constexpr int kRays = 16 * 16;
constexpr int kMostSamples = 4096;
/// Of the reference where there is no closed form, at pixels that the measured ones are not near.
constexpr int kReferenceSamples = 1 << 16;
constexpr int kFarPixel = 1 << 20;

/// A white floor seen from above, lit by one light; the rays are fixed, so that only the light's
/// sampling makes the error, not the pixel's. Light and ball stand outside the slice that the rays
/// stay in: they are not seen, but light and shade the floor.
struct Setting {
    std::string_view name;
    bool has_closed_form;  ///< the direct picture's, exact without bodies in the way
    Bodies bodies;
    render::Lights lights;
    int bounces = 0;
};

void add_body(Bodies& bodies, const Shape& shape, const Vec4& position) {
    BodyType type;
    type.shape = shape;
    bodies.types.push_back(type);
    bodies.type.push_back(static_cast<std::uint32_t>(bodies.types.size() - 1));
    bodies.position.push_back(position);
    bodies.rotor.push_back({});
    bodies.velocity.push_back(Vec4::Zero());
    bodies.angular_velocity.push_back({});
}

std::vector<Setting> settings() {
    Setting smooth = {"open", true, {}, {}, 0};
    add_body(smooth.bodies, Hyperplane{Vec4::UnitY(), -3}, Vec4::Zero());
    smooth.lights.spheres = {{Vec4(0.5, -0.5, 0.3, 1.3), 0.8, Color::Ones()}};

    Setting shadowed = smooth;
    shadowed.name = "shadowed", shadowed.has_closed_form = false;
    add_body(shadowed.bodies, Hypersphere{0.4}, Vec4(0.2, -2, 0.1, 0.7));

    Setting sky = shadowed;
    sky.name = "sky and three bounces", sky.bounces = 3;
    sky.lights.sky = Color::Constant(0.3);
    return {smooth, shadowed, sky};
}

/// The light of a setting along its rays.
class Rays {
  public:
    Rays(const Setting& s, render::Integrator integrator)
        : settings_(settings_of(s, integrator)),
          picture_{s.bodies, appearance_of(s), materials_, camera_, s.lights, settings_},
          placed_(render::place_bodies(picture_, Vec4::Zero())),
          tree_(placed_),
          lights_(s.lights, Vec4::Zero()),
          rough_(picture_.materials),
          shading_(picture_, placed_, tree_, lights_, rough_),
          integrator_(render::make_integrator(picture_, placed_, tree_, lights_, shading_)),
          scene_(placed_, tree_, settings_) {
        for (int i = 0; i < kRays; ++i)
            directions_.push_back(
                Vec4(-0.7 + 1.4 * (i % 16) / 15, -1, -0.7 + 1.4 * (i / 16) / 15, 0).normalized());
        for (const Vec4& d : directions_) {
            const render::Ray ray = {Vec4::Zero(), d};
            const auto hit = scene_.nearest(ray, stats_);
            surfaces_.push_back(hit ? std::optional(shading_.surface(hit, ray)) : std::nullopt);
        }
    }
    Rays(const Rays&) = delete;

    double sample(int ray, int x, int y, int index) {
        const auto i = static_cast<std::size_t>(ray);
        const render::Sampler sampler(x, y, static_cast<std::uint32_t>(index));
        const render::ViewSample from = {
            surfaces_[i] ? &*surfaces_[i] : nullptr, {Vec4::Zero(), directions_[i]}, sampler};
        render::Color color;
        integrator_->radiance({&from, 1}, {&color, 1}, wave_, stats_);
        return color[0];
    }

    /// The mean of a pixel's samples, or of the first samples of as many pixels: independent ones.
    double mean(int ray, int pixel, int count, bool stratified) {
        double sum = 0;
        for (int i = 0; i < count; ++i)
            sum += stratified ? sample(ray, pixel, 0, i) : sample(ray, pixel, 1 + i, 0);
        return sum / count;
    }

  private:
    static render::Settings settings_of(const Setting& s, render::Integrator integrator) {
        render::Settings settings;
        settings.integrator = integrator;
        settings.bounces = s.bounces;
        return settings;
    }
    const std::vector<render::Appearance>& appearance_of(const Setting& s) {
        appearance_.resize(s.bodies.types.size());
        return appearance_;
    }

    std::vector<render::Appearance> appearance_;
    std::vector<render::Material> materials_ = {render::Material{}};
    render::CameraDescription camera_;
    render::Settings settings_;
    render::Picture picture_;
    render::PlacedBodies placed_;
    render::BodyTree tree_;
    render::LightSet lights_;
    render::RoughReflections rough_;
    render::Shading shading_;
    std::unique_ptr<const render::LightIntegrator> integrator_;
    render::RayScene scene_;
    std::vector<Vec4> directions_;
    std::vector<std::optional<render::Surface>> surfaces_;
    render::FrameStats stats_;
    render::PathWave wave_;
};

std::vector<double> exact_values(const Setting& setting) {
    Rays rays(setting,
              setting.has_closed_form ? render::Integrator::kDirect : render::Integrator::kPath);
    std::vector<double> exact;
    for (int i = 0; i < kRays; ++i)
        exact.push_back(
            rays.mean(i, kFarPixel + i, setting.has_closed_form ? 1 : kReferenceSamples, true));
    return exact;
}

/// Root mean square error of the direct picture's closed forms.
double error_of_direct(const Setting& setting, const std::vector<double>& exact) {
    Rays direct(setting, render::Integrator::kDirect);
    double square = 0;
    for (int i = 0; i < kRays; ++i) {
        const double error = direct.mean(i, i, 1, true) - exact[static_cast<std::size_t>(i)];
        square += error * error / kRays;
    }
    return std::sqrt(square);
}

void measure(const Setting& setting) {
    const std::vector<double> exact = exact_values(setting);
    double mean = 0;
    for (const double e : exact) mean += e / kRays;
    if (!setting.has_closed_form && setting.bounces == 0)
        fmt::print("{},closed form,1,{:.3e},\n", setting.name,
                   error_of_direct(setting, exact) / mean);
    Rays rays(setting, render::Integrator::kPath);
    for (const bool stratified : {true, false})
        for (int samples = 1; samples <= kMostSamples; samples *= 4) {
            const auto begin = std::chrono::steady_clock::now();
            double square = 0;
            for (int i = 0; i < kRays; ++i) {
                const double error =
                    rays.mean(i, i, samples, stratified) - exact[static_cast<std::size_t>(i)];
                square += error * error / kRays;
            }
            const std::chrono::duration<double, std::nano> time =
                std::chrono::steady_clock::now() - begin;
            fmt::print("{},{},{},{:.3e},{:.0f}\n", setting.name,
                       stratified ? "sobol" : "independent", samples, std::sqrt(square) / mean,
                       time.count() / (1.0 * kRays * samples));
        }
}

}  // namespace
}  // namespace tesserae::bench

int main(int argc, char** argv) {
    const std::vector<std::string_view> names(argv + 1, argv + argc);
    fmt::print("scene,sampler,samples,relative_rmse,ns_per_sample\n");
    for (const auto& setting : tesserae::bench::settings())
        if (names.empty() || std::find(names.begin(), names.end(), setting.name) != names.end())
            tesserae::bench::measure(setting);
}

// SPDX-License-Identifier: Apache-2.0
#include "render/material/rough.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tesserae::render {
namespace {

using std::numbers::pi;
constexpr double kHemisphere = 4 * pi / 3;  ///< integral of the cosine

/// E: the mean over the mirrors that are seen of what is not masked on the way back. For a
/// direction in the plane of the first and the last axis it does not matter where points of the
/// 3-ball turn about the first one: they are (rim sin a, sin b, 0) here, rim = cos b.
double single_part_by_quadrature(const Microfacet& facets, double cosine) {
    constexpr int kSteps = 48;
    const Vec4 out(std::sqrt(1 - cosine * cosine), 0, 0, cosine);
    const double alone = facets.visible_part(out);
    double sum = 0, all = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double b = 0.5 * pi * (i + 0.5) / kSteps, rim = std::cos(b);
        for (int j = 0; j < kSteps; ++j) {
            const double a = pi * ((j + 0.5) / kSteps - 0.5);
            const double weight = std::sin(b) * rim * rim * std::cos(a);
            all += weight;
            const Vec4 mirror = facets.visible_normal(out, {rim * std::sin(a), std::sin(b), 0});
            const Vec4 in = 2 * out.dot(mirror) * mirror - out;
            if (in[3] > 0) sum += weight * facets.visible_part(out, in) / alone;
        }
    }
    return sum / all;
}

}  // namespace

RoughReflection::RoughReflection(double roughness) : facets_(roughness) {
    constexpr double kGrazing = 1e-6;  // instead of 0
    for (int k = 0; k <= kNodes; ++k) {
        const double root = static_cast<double>(k) / kNodes;
        lost_[k] = 1 - single_part_by_quadrature(facets_, std::max(kGrazing, root * root));
    }
    constexpr int kSteps = 1000;
    mean_lost_ = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double angle = 0.5 * pi * (i + 0.5) / kSteps, sine = std::sin(angle);
        mean_lost_ += lost_part(std::cos(angle)) * sine * sine * std::cos(angle);
    }
    mean_lost_ *= 1.5 * pi / kSteps;
}

double RoughReflection::lost_part(double cosine) const {
    const double place = kNodes * std::sqrt(std::clamp(cosine, 0.0, 1.0));
    const int k = std::min(static_cast<int>(place), kNodes - 1);
    return lost_[k] + (place - k) * (lost_[k + 1] - lost_[k]);
}

Color RoughReflection::brdf(const Color& albedo, const Vec4& out, const Vec4& in) const {
    if (!(out[3] > 0 && in[3] > 0)) return Color::Zero();
    const Color once = facets_.brdf(out, in) * albedo;
    if (!(mean_lost_ > 0)) return once;
    const double rest = lost_part(out[3]) * lost_part(in[3]) / (kHemisphere * mean_lost_);
    return once + rest * (1 - mean_lost_) * albedo.square() / (1 - mean_lost_ * albedo);
}

Vec4 RoughReflection::sample(const Vec4& out, const Uniform3& u) const {
    const double single = single_choice(out[3]);
    if (u[0] < single) return facets_.sample(out, {u[0] / single, u[1], u[2]});
    return cosine_direction({(u[0] - single) / (1 - single), u[1], u[2]});
}

double RoughReflection::density(const Vec4& out, const Vec4& in) const {
    const double single = single_choice(out[3]);
    return single * facets_.density(out, in) + (1 - single) * std::max(0.0, in[3]) / kHemisphere;
}

RoughReflections::RoughReflections(std::span<const Material> materials) {
    for (const Material& m : materials)
        if (m.kind == MaterialKind::kRough && m.roughness > 0)
            by_roughness_.try_emplace(m.roughness, m.roughness);
}

const RoughReflection* RoughReflections::of(const Material& material) const {
    if (material.kind != MaterialKind::kRough) return nullptr;
    const auto found = by_roughness_.find(material.roughness);
    return found == by_roughness_.end() ? nullptr : &found->second;
}

}  // namespace tesserae::render

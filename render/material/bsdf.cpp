#include "render/material/bsdf.hpp"

#include <algorithm>
#include <numbers>

#include "render/material/rough.hpp"

namespace tesserae::render {
namespace {

constexpr double kLambert = 3 / (4 * std::numbers::pi);

}  // namespace

bool is_specular(const Material& m) {
    return m.kind == MaterialKind::kMirror || m.kind == MaterialKind::kGlass ||
           (m.kind == MaterialKind::kRough && m.roughness == 0);
}

Bsdf::Bsdf(const Surface& surface, const Vec4& out) : surface_(surface), out_(out) {
    if (surface.rough == nullptr) return;
    frame_.emplace(surface.normal);
    out_ = frame_->to_local(out);
}

Color Bsdf::value(const Vec4& in) const {
    if (!frame_) return kLambert * surface_.albedo;
    return surface_.rough->brdf(surface_.albedo, out_, frame_->to_local(in));
}

double Bsdf::density(const Vec4& in) const {
    if (!frame_) return kLambert * std::max(0.0, surface_.normal.dot(in));
    return surface_.rough->density(out_, frame_->to_local(in));
}

Bsdf::Sample Bsdf::sample(const Uniform3& u) const {
    if (!frame_) {
        const Vec4 in = cosine_direction(u);
        return {TangentFrame(surface_.normal).to_world(in), surface_.albedo, kLambert * in[3]};
    }
    const Vec4 in = out_[3] > 0 ? surface_.rough->sample(out_, u) : Vec4(-Vec4::UnitW());
    Sample sample = {frame_->to_world(in), Color::Zero(), 0};
    if (!(in[3] > 0)) return sample;
    sample.density = surface_.rough->density(out_, in);
    if (sample.density > 0)
        sample.weight = surface_.rough->brdf(surface_.albedo, out_, in) * (in[3] / sample.density);
    return sample;
}

}  // namespace tesserae::render

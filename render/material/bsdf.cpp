// SPDX-License-Identifier: Apache-2.0
#include "render/material/bsdf.hpp"

#include "render/material/rough.hpp"

namespace tesserae::render {

void Bsdf::enter_frame() {
    frame_.emplace(surface_.normal);
    out_ = frame_->to_local(out_);
}

Color Bsdf::value_of_rough(const Vec4& in) const {
    return surface_.rough->brdf(surface_.albedo, out_, frame_->to_local(in));
}

double Bsdf::density_of_rough(const Vec4& in) const {
    return surface_.rough->density(out_, frame_->to_local(in));
}

Bsdf::Sample Bsdf::sample_of_rough(const Uniform3& u) const {
    const Vec4 in = out_[3] > 0 ? surface_.rough->sample(out_, u) : Vec4(-Vec4::UnitW());
    Sample sample = {frame_->to_world(in), Color::Zero(), 0};
    if (!(in[3] > 0)) return sample;
    sample.density = surface_.rough->density(out_, in);
    if (sample.density > 0)
        sample.weight = surface_.rough->brdf(surface_.albedo, out_, in) * (in[3] / sample.density);
    return sample;
}

}  // namespace tesserae::render

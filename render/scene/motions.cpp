// SPDX-License-Identifier: Apache-2.0
#include "render/scene/motions.hpp"

#include <algorithm>

namespace tesserae::render {
namespace {

bool moves(const Picture& picture, BodyId id, bool is_turned) {
    const Bodies& opening = picture.bodies;
    return std::any_of(picture.path.begin(), picture.path.end(), [&](const ShutterMoment& m) {
        return m.bodies.position[id] != opening.position[id] ||
               (is_turned && !(m.bodies.rotor[id] == opening.rotor[id]));
    });
}

}  // namespace

bool looks_turned(const Picture& picture, std::uint32_t type) {
    const Material& material = picture.materials[picture.appearance[type].material];
    return !std::holds_alternative<Hypersphere>(picture.bodies.types[type].shape) ||
           material.pattern != Pattern::kNone;
}

Motions::Motions(const Picture& picture, const Vec4& origin) {
    for (const ShutterMoment& moment : picture.path) ends_.push_back(moment.time);
    const Bodies& opening = picture.bodies;
    for (BodyId id = 0; id < opening.size() && !ends_.empty(); ++id) {
        const std::uint32_t type = opening.type[id];
        const Shape& shape = opening.types[type].shape;
        const bool is_turned = looks_turned(picture, type);
        if (!picture.appearance[type].visible || !is_bounded(shape) ||
            !moves(picture, id, is_turned))
            continue;
        if (of_.empty()) of_.assign(opening.size(), kStill);
        of_[id] = static_cast<std::uint32_t>(bodies_.size());
        bodies_.push_back({bounding_radius(shape), is_turned});
        for (std::size_t i = 0; i < ends_.size(); ++i) {
            const Bodies& before = i == 0 ? opening : picture.path[i - 1].bodies;
            const Bodies& after = picture.path[i].bodies;
            const double length = ends_[i] - (i == 0 ? 0 : ends_[i - 1]);
            const auto turn = turning(before, after, length, id);
            parts_.push_back({before.position[id] - origin,
                              after.position[id] - before.position[id],
                              turn.value_or(Turning{before.rotor[id], {}, {}}), turn.has_value()});
        }
    }
}

Motions::Place Motions::place(double time) const {
    std::size_t i = 0;
    while (i + 1 < ends_.size() && time >= ends_[i]) ++i;
    const double begin = i == 0 ? 0 : ends_[i - 1];
    return {i, (time - begin) / (ends_[i] - begin)};
}

Pose Motions::pose(std::uint32_t motion, double time) const {
    const Place at = place(time);
    const Part& part = part_of(motion, at.part);
    Pose pose = {part.from + at.done * part.by, Mat4::Identity()};
    if (bodies_[motion].is_turned)
        pose.turn =
            to_matrix(part.turns ? part.turning.at(at.done) : part.turning.begin).transpose();
    return pose;
}

Vec4 Motions::centre(std::uint32_t motion, double time) const {
    const Place at = place(time);
    const Part& part = part_of(motion, at.part);
    return part.from + at.done * part.by;
}

Motions::Sweep Motions::sweep(std::uint32_t motion, double begin, double end) const {
    // Between moments a centre moves straight: what holds the corners of its way holds all of it.
    std::vector<Vec4> corners = {centre(motion, begin), centre(motion, end)};
    for (std::size_t i = 0; i + 1 < ends_.size(); ++i)
        if (begin < ends_[i] && ends_[i] < end) corners.push_back(part_of(motion, i + 1).from);
    Vec4 low = corners[0], high = corners[0];
    for (const Vec4& corner : corners) low = low.cwiseMin(corner), high = high.cwiseMax(corner);
    const Vec4 middle = 0.5 * (low + high);
    double reach = 0;
    for (const Vec4& corner : corners) reach = std::max(reach, (corner - middle).norm());
    return {middle, bodies_[motion].radius + reach};
}

double Motions::most_travel() const {
    double most = 0;
    for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
        double length = 0;
        for (std::size_t k = 0; k < ends_.size(); ++k) length += part_of(i, k).by.norm();
        most = std::max(most, length / bodies_[i].radius);
    }
    return most;
}

}  // namespace tesserae::render

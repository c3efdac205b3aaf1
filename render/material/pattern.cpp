// SPDX-License-Identifier: Apache-2.0
#include "render/material/pattern.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "render/tint.hpp"

namespace tesserae::render {
namespace {

/// Patterns are read this part of pattern_size below the surface. Without it a face that lies on a
/// boundary of cells would take either cell's colour, as rounding has it.
constexpr double kPatternDepth = 1e-4;

bool is_odd(double cell) { return cell - 2 * std::floor(0.5 * cell) != 0; }

/// Where patterns have their origin: the body's, or for an infinite plane its point nearest to the
/// world's.
Vec4 pattern_origin(const Shape& shape) {
    if (const auto* plane = std::get_if<Hyperplane>(&shape)) return plane->offset * plane->normal;
    return Vec4::Zero();
}

Color mixed(const Color& a, const Color& b, double part) { return a + part * (b - a); }

/// A cell's number, modulo 2^32.
std::uint32_t wrapped(double cell) {
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::fmod(cell, 4294967296.0)));
}

/// A random number in [0, 1) for a point of the integer lattice. The page of view has it too.
double random_at(const std::array<std::uint32_t, 4>& corner) {
    std::uint32_t bits = 0;
    for (const std::uint32_t index : corner) {
        bits = (bits + index) * 0x9e3779b1u;
        bits ^= bits >> 15;
        bits *= 0x85ebca77u;
        bits ^= bits >> 13;
    }
    return (bits >> 8) * 0x1p-24;
}

/// Random values at the integers, in between smooth (K. Perlin's fade, 2002).
double smooth_random(const Vec4& at) {
    const Vec4 floor = at.array().floor().matrix();
    const Vec4 t = at - floor;
    const Vec4 fade = (t.array().cube() * (t.array() * (6 * t.array() - 15) + 10)).matrix();
    std::array<double, 16> values;
    for (std::size_t i = 0; i < values.size(); ++i) {
        std::array<std::uint32_t, 4> corner;
        for (std::size_t axis = 0; axis < 4; ++axis)
            corner[axis] = wrapped(floor[static_cast<int>(axis)]) + (i >> axis & 1);
        values[i] = random_at(corner);
    }
    for (int axis = 3; axis >= 0; --axis)
        for (std::size_t i = 0; i < std::size_t{1} << axis; ++i)
            values[i] += fade[axis] * (values[i + (std::size_t{1} << axis)] - values[i]);
    return values[0];
}

/// How much of the second colour noise has.
double noise_at(const Vec4& at) {
    double sum = 0, weight = 1;
    Vec4 point = at;
    for (int octave = 0; octave < 3; ++octave) {
        sum += weight * smooth_random(point);
        weight *= 0.5, point *= 2;
    }
    // The mean of three octaves seldom leaves the middle half.
    const double part = std::clamp(2 * (sum / 1.75) - 0.5, 0.0, 1.0);
    return part * part * (3 - 2 * part);
}

bool is_on_grid(const Material& m, const Vec4& point, const Vec4& normal) {
    for (int axis = 0; axis < 4; ++axis) {
        const double off = point[axis] - m.pattern_size * std::round(point[axis] / m.pattern_size);
        // Along the surface the hyperplane x_i = const is farther away.
        const double slope = std::sqrt(std::max(0.0, 1 - normal[axis] * normal[axis]));
        if (std::abs(off) < 0.5 * m.line_width * slope) return true;
    }
    return false;
}

Color by_w(double w, double scale) {
    const double part = std::clamp(w / scale, -1.0, 1.0);
    return mixed(Color::Ones(), kSideColors[part > 0 ? 1 : 0], std::abs(part));
}

/// Neighbours in number differ: the hue turns by the golden ratio.
Color cell_color(const Color& albedo, int cell) {
    if (cell < 0) return albedo;
    constexpr double kGoldenRatio = 0.6180339887498949;
    return albedo * turned_hue({1.0, 0.25, 0.2}, kGoldenRatio * cell);
}

double to_edge(const Hyperbox& box, const Vec4& point, const Vec4& normal) {
    Eigen::Index own;
    normal.cwiseAbs().maxCoeff(&own);
    Vec4 away = 0.5 * box.size - point.cwiseAbs();
    away[own] = kMiss;
    return away.minCoeff();
}
double to_edge(const HullShape& shape, const Vec4& point, const Vec4& normal) {
    const HullBody& body = *shape.body;
    const std::size_t own = body.normals.largest_at(normal).number;
    const Vec4 n = body.hull.cells[own].plane.normal;
    double nearest = kMiss;
    for (const HullCell& cell : body.hull.cells) {
        const double sine = (cell.plane.normal - n.dot(cell.plane.normal) * n).norm();
        // The own cell, and one on the other side, which is parallel.
        if (sine < 1e-9) continue;
        nearest = std::min(nearest, (cell.plane.offset - cell.plane.normal.dot(point)) / sine);
    }
    return nearest;
}
}  // namespace

int cell_number(const Shape& shape, const Vec4& normal) {
    return std::visit(
        [&]<class S>(const S& s) {
            if constexpr (std::is_base_of_v<Hyperbox, S>) {
                Eigen::Index axis;
                normal.cwiseAbs().maxCoeff(&axis);
                return 2 * static_cast<int>(axis) + (normal[axis] > 0 ? 1 : 0);
            } else if constexpr (std::is_base_of_v<HullShape, S>) {
                return static_cast<int>(s.body->normals.largest_at(normal).number);
            } else {
                return -1;
            }
        },
        shape);
}

double distance_to_edge(const Shape& shape, const Vec4& point, const Vec4& normal) {
    return std::visit(
        [&]<class S>(const S& s) {
            if constexpr (std::is_base_of_v<Hyperbox, S> || std::is_base_of_v<HullShape, S>)
                return to_edge(s, point, normal);
            else
                return kMiss;
        },
        shape);
}

Color colour_in_space(const Material& m, const Vec4& point) {
    if (m.pattern == Pattern::kNoise)
        return mixed(m.albedo, m.pattern_albedo, noise_at(point / m.pattern_size));
    const Vec4 cell = (point.array() / m.pattern_size + 0.5).floor().matrix();
    const double sum = m.pattern == Pattern::kChecker ? cell.sum() : cell.x();
    return is_odd(sum) ? m.pattern_albedo : m.albedo;
}

Color pattern_albedo(const Material& m, const PatternPoint& at) {
    const auto lines = [&](bool is_line) { return is_line ? m.pattern_albedo : m.albedo; };
    switch (m.pattern) {
        case Pattern::kNone:
            return m.albedo;
        case Pattern::kChecker:
        case Pattern::kStripes:
        case Pattern::kNoise:
            return colour_in_space(m, at.local - pattern_origin(at.shape) -
                                          kPatternDepth * m.pattern_size * at.normal);
        case Pattern::kGrid:
            return lines(is_on_grid(m, at.local - pattern_origin(at.shape), at.normal));
        case Pattern::kEdges:
            return lines(distance_to_edge(at.shape, at.local, at.normal) < 0.5 * m.line_width);
        case Pattern::kCells:
            return cell_color(m.albedo, cell_number(at.shape, at.normal));
        case Pattern::kW:
            return m.albedo * by_w(m.w_of == WOf::kBody ? at.body_w : at.w, m.pattern_size);
    }
    return m.albedo;
}

}  // namespace tesserae::render

// SPDX-License-Identifier: Apache-2.0
#include "render/light/overlap.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/simd/simd.hpp"

namespace tesserae::render {
namespace {

using simd::Float8, simd::Unsigned8, simd::all_lanes, simd::kLanes, simd::larger, simd::smaller,
    simd::square_root;

/// Lines through the disc. Usual 16, half of it is seen as noise at shadows' edges.
constexpr std::size_t kLines = 16, kGroups = kLines / kLanes;
/// Parts of a line, each a bit; one less than a number has, so that no shift is by all its bits.
constexpr int kParts = 31;
/// Below this rim the second cover counts in full, and the first one's flat rim no longer.
constexpr double kFull = 0.5;

using Lines = std::array<Unsigned8, kGroups>;
/// CPUs make these of floats in one instruction, not unsigned ones.
using Signed8 = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

/// Eight lines along the last axis.
struct EightLines {
    Float8 x, y, square;  ///< where they pass the middle plane, and x^2 + y^2
    Float8 scale;         ///< parts to a unit of length
    Float8 offset;        ///< rounds the ends of a cover up at some lines and down at others
};

/// Spread evenly over the disc, each turned from the one before by the golden angle.
struct AllLines {
    std::array<EightLines, kGroups> groups;
    std::array<double, kLines> length;  ///< of a part of them

    AllLines() {
        constexpr double kCosine = -0.7373688780783197, kSine = 0.6754902942615238;
        constexpr double kGolden = 0.6180339887498949;
        double cosine = 1, sine = 0, offset = 0.5;
        for (std::size_t i = 0; i < kLines; ++i) {
            const double square = (static_cast<double>(i) + 0.5) / kLines;
            const double radius = std::sqrt(square), half = std::sqrt(1 - square);
            EightLines& group = groups[i / kLanes];
            const std::size_t lane = i % kLanes;
            group.x[lane] = static_cast<float>(radius * cosine);
            group.y[lane] = static_cast<float>(radius * sine);
            group.square[lane] = static_cast<float>(square);
            group.scale[lane] = static_cast<float>(0.5 * kParts / half);
            group.offset[lane] = static_cast<float>(0.5 * kParts + offset);
            length[i] = half / kParts;
            const double turned = cosine * kCosine - sine * kSine;
            sine = sine * kCosine + cosine * kSine;
            cosine = turned;
            offset += kGolden - (offset + kGolden >= 1 ? 1 : 0);
        }
    }
};
const AllLines& all_lines() {
    static const AllLines lines;
    return lines;
}

/// The parts of eight lines that a cover holds. Of a line the ends are the roots of z^2 - 2 radius
/// m z + radius k, the nearer one as a quotient: a cover may be almost flat.
Unsigned8 held(const DiscCover& cover, const EightLines& line) {
    const auto of = [](double x) { return all_lanes(static_cast<float>(x)); };
    const double bend = 1 / cover.radius, rim = cover.rim, centre = 1 + rim * bend;
    const Float8 k =
        of(bend) * line.square -
        (of(2 * centre * cover.toward[0]) * line.x + of(2 * centre * cover.toward[1]) * line.y) +
        of(2 * rim + rim * rim * bend);
    const Float8 m = of(centre * cover.toward[2]);
    const Float8 square = m * m - k * of(bend);
    const Float8 root = square_root(larger(square, all_lanes(0)));
    const Float8 farther = m + (m < 0 ? -root : root);
    const Float8 a = k / farther, b = farther * of(cover.radius);
    const auto part = [&](Float8 z) {
        const Float8 at = z * line.scale + line.offset;
        const Float8 within = larger(smaller(at, all_lanes(kParts)), all_lanes(0));
        return simd::same_bits<Unsigned8>(__builtin_convertvector(within, Signed8));
    };
    const Unsigned8 all = Unsigned8{} - 1;
    const Unsigned8 parts = (all << part(smaller(a, b))) & ~(all << part(larger(a, b)));
    return square > 0 ? parts : Unsigned8{};
}

Lines held(const DiscCover& cover) {
    Lines lines;
    for (std::size_t g = 0; g < kGroups; ++g) lines[g] = held(cover, all_lines().groups[g]);
    return lines;
}

/// The part of the disc that lies in no part of lines that is held.
double clear_of(const Lines& lines) {
    double clear = 0, whole = 0;
    for (std::size_t i = 0; i < kLines; ++i) {
        const double length = all_lines().length[i];
        clear += length * (kParts - std::popcount(lines[i / kLanes][i % kLanes]));
        whole += length * kParts;
    }
    return clear / whole;
}

}  // namespace

double visible_part(double x) {
    if (x <= -1) return 0;
    if (x >= 1) return 1;
    return 0.25 * (2 + 3 * x - x * x * x);
}

double clear_part(std::span<const DiscCover> covers) {
    // The two that reach farthest.
    const auto is_before = [](const DiscCover& a, const DiscCover& b) {
        return a.rim != b.rim ? a.rim < b.rim : a.body < b.body;
    };
    const DiscCover* first = &covers[0];
    double second = 1;
    Lines lines{};
    for (const DiscCover& cover : covers) {
        if (is_before(cover, *first))
            second = first->rim, first = &cover;
        else if (&cover != first)
            second = std::min(second, cover.rim);
        const Lines own = held(cover);
        for (std::size_t g = 0; g < kGroups; ++g) lines[g] |= own[g];
    }
    const double clear = clear_of(lines);
    if (second <= kFull || clear == 0) return clear;
    const double begun = (1 - second) / (1 - kFull);
    const double flat = visible_part(first->rim) / clear_of(held(*first));
    return clear * std::lerp(flat, 1.0, visible_part(2 * begun - 1));
}

}  // namespace tesserae::render

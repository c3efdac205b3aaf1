// SPDX-License-Identifier: Apache-2.0
#include "scenes/view/pose_tracks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/error.hpp"

namespace tesserae::scenes {
namespace {

static_assert(std::endian::native == std::endian::little, "pages are little-endian");

/// A body that the camera touches or is in is seen from no nearer than this part of its radius:
/// pixels have no smallest size there.
constexpr double kNearest = 1.0 / 16;

/// Bytes a body, before the stream of bits.
constexpr std::uint64_t kTrackBytes = 4 * 8 + 8 * 4 + 2 * 4 + 4 + 4 + 12;

/// The rotation of a body shows but for a plane, and for a sphere of one colour.
bool shows_turning(const BodyType& type, const render::Material& material) {
    if (!is_bounded(type.shape)) return false;
    return !std::holds_alternative<Hypersphere>(type.shape) ||
           material.pattern != render::Pattern::kNone;
}

int bits_for(double range, double step) {
    if (!(range > 0)) return 0;
    const double largest = std::round(range / step);
    return largest < 1 ? 0 : static_cast<int>(std::bit_width(static_cast<std::uint64_t>(largest)));
}

/// The step wanted, or what the most bits allow; as a float that is no larger.
float step_for(double wanted, double widest_range) {
    const double least = widest_range / static_cast<double>((1u << kMostTrackBits) - 1);
    const double step = std::max(wanted, least * (1 + 1e-6));
    if (!(step < 1e30)) return 0;  // nothing moves
    return std::nextafter(static_cast<float>(step), 0.0f);
}

std::uint64_t bits_a_moment(const TrackGrid& grid) {
    std::uint64_t sum = 0;
    for (const std::uint8_t bits : grid.bits) sum += bits;
    return sum;
}

template <class T>
void append_values(std::string& bytes, const T* values, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

}  // namespace

PoseNumbers pose_numbers(const Vec4& position, const Rotor& r, const PoseNumbers& last) {
    PoseNumbers numbers = {position[0], position[1],     position[2],     position[3],
                           r.s + r.p,   r.b.xy - r.b.zw, r.b.xz + r.b.yw, r.b.xw - r.b.yz,
                           r.s - r.p,   r.b.xy + r.b.zw, r.b.xz - r.b.yw, r.b.xw + r.b.yz};
    double along = 0;
    for (std::size_t i = kPositionNumbers; i < 12; ++i) along += numbers[i] * last[i];
    if (along < 0)
        for (std::size_t i = kPositionNumbers; i < 12; ++i) numbers[i] = -numbers[i];
    return numbers;
}

PoseRanges::PoseRanges(const Bodies& bodies, const std::vector<render::Appearance>& appearance,
                       const std::vector<render::Material>& materials) {
    for (BodyId id = 0; id < bodies.size(); ++id) {
        const render::Appearance& looks = appearance[bodies.type[id]];
        if (!looks.visible) continue;
        const BodyType& type = bodies.type_of(id);
        BodyTrack track;
        track.id = id;
        track.radius = track.reach = bounding_radius(type.shape);
        track.turns = shows_turning(type, materials[looks.material]);
        track.last = pose_numbers(Vec4::Zero(), Rotor{}, {});
        track.tolerance = track.from_slice = kMiss;
        tracks_.push_back(track);
    }
}

void PoseRanges::show_point(BodyId id, double distance) {
    const auto track =
        std::lower_bound(tracks_.begin(), tracks_.end(), id,
                         [](const BodyTrack& other, BodyId wanted) { return other.id < wanted; });
    if (track == tracks_.end() || track->id != id || !(distance > 0)) return;
    track->turns = true;
    track->reach = std::max(track->reach, distance);
}

void PoseRanges::add(const Bodies& bodies, const render::Camera& camera) {
    for (BodyTrack& track : tracks_) {
        const Vec4 &position = bodies.position[track.id], from = position - camera.origin();
        track.last =
            pose_numbers(position, track.turns ? bodies.rotor[track.id] : Rotor{}, track.last);
        if (!track.has_moments) track.low = track.high = track.last;
        track.has_moments = true;
        for (std::size_t i = 0; i < 12; ++i) {
            track.low[i] = std::min(track.low[i], track.last[i]);
            track.high[i] = std::max(track.high[i], track.last[i]);
        }
        track.from_slice =
            std::min(track.from_slice, std::abs(from.dot(camera.fourth())) - track.radius);
        const double distance = std::max(from.norm() - track.radius, kNearest * track.radius);
        track.tolerance = std::min(track.tolerance, kPoseAccuracy * camera.pixel_size() * distance);
    }
}

void PoseRanges::keep_near_slice(double distance) {
    std::erase_if(tracks_, [&](const BodyTrack& track) { return track.from_slice > distance; });
}

/// Half of the tolerance is the position's: four numbers that are each off by half a step move a
/// body by a step at most. The other half is the rotation's: two quaternions that are off by a step
/// each turn it by two steps at most [rad].
TrackGrid grid_of(const BodyTrack& track) {
    double range[2] = {0, 0};
    for (std::size_t i = 0; i < 12; ++i) {
        double& widest = range[i < kPositionNumbers ? 0 : 1];
        widest = std::max(widest, track.high[i] - track.low[i]);
    }
    TrackGrid grid;
    grid.position_step = step_for(0.5 * track.tolerance, range[0]);
    grid.turn_step = step_for(0.25 * track.tolerance / track.reach, range[1]);
    for (std::size_t i = 0; i < 12; ++i) {
        if (i < kPositionNumbers)
            grid.position_low[i] = track.low[i];
        else
            grid.turn_low[i - kPositionNumbers] = static_cast<float>(track.low[i]);
        const int bits = bits_for(track.high[i] - grid.low(i), grid.step(i));
        grid.bits[i] = static_cast<std::uint8_t>(bits);
        // One that keeps within a step stands in the middle of its range.
        const double middle = 0.5 * (track.low[i] + track.high[i]);
        if (bits > 0) continue;
        if (i < kPositionNumbers)
            grid.position_low[i] = middle;
        else
            grid.turn_low[i - kPositionNumbers] = static_cast<float>(middle);
    }
    return grid;
}

PosePacker::PosePacker(const PoseRanges& ranges, std::size_t moments) : moments_(moments) {
    std::uint64_t bits = 0;
    for (const BodyTrack& track : ranges.tracks()) {
        tracks_.push_back({track, grid_of(track), bits});
        // From the start again, so that signs are chosen as they were in the first pass.
        tracks_.back().body.last = pose_numbers(Vec4::Zero(), Rotor{}, {});
        bits += moments * bits_a_moment(tracks_.back().grid);
    }
    // A word more, so that a reader may always take two.
    words_.resize(bits / 32 + 2);
}

std::uint64_t PosePacker::bytes_of(const PoseRanges& ranges, std::size_t moments) {
    std::uint64_t bits = 0;
    for (const BodyTrack& track : ranges.tracks()) bits += moments * bits_a_moment(grid_of(track));
    return 8 + kTrackBytes * ranges.tracks().size() + 4 * (bits / 32 + 2);
}

void PosePacker::store(std::uint64_t bit, int count, std::uint32_t value) {
    const std::uint64_t shifted = std::uint64_t{value} << (bit % 32);
    words_[bit / 32] |= static_cast<std::uint32_t>(shifted);
    if (bit % 32 + count > 32) words_[bit / 32 + 1] |= static_cast<std::uint32_t>(shifted >> 32);
}

void PosePacker::add(const Bodies& bodies) {
    TSR_ASSERT(moment_ < moments_);
    for (Track& track : tracks_) {
        BodyTrack& body = track.body;
        body.last = pose_numbers(bodies.position[body.id],
                                 body.turns ? bodies.rotor[body.id] : Rotor{}, body.last);
        std::uint64_t first = track.first_bit;
        for (std::size_t i = 0; i < 12; ++i) {
            const int bits = track.grid.bits[i];
            if (bits == 0) continue;
            const double most = static_cast<double>((std::uint64_t{1} << bits) - 1);
            const double k = std::round((body.last[i] - track.grid.low(i)) / track.grid.step(i));
            store(first + moment_ * bits, bits,
                  static_cast<std::uint32_t>(std::clamp(k, 0.0, most)));
            first += moments_ * bits;
        }
    }
    ++moment_;
}

std::string PosePacker::take_bytes(const Bodies& bodies) {
    TSR_ASSERT(moment_ == moments_);
    std::string bytes;
    bytes.reserve(kTrackBytes * tracks_.size() + 4 * words_.size());
    const std::uint32_t counts[2] = {static_cast<std::uint32_t>(tracks_.size()),
                                     static_cast<std::uint32_t>(moments_)};
    append_values(bytes, counts, 2);
    for (const Track& t : tracks_) append_values(bytes, t.grid.position_low, 4);
    for (const Track& t : tracks_) append_values(bytes, t.grid.turn_low, 8);
    for (const Track& t : tracks_) {
        append_values(bytes, &t.grid.position_step, 1);
        append_values(bytes, &t.grid.turn_step, 1);
    }
    for (const Track& t : tracks_) append_values(bytes, &t.body.id, 1);
    for (const Track& t : tracks_) append_values(bytes, &bodies.type[t.body.id], 1);
    for (const Track& t : tracks_) append_values(bytes, t.grid.bits, 12);
    append_values(bytes, words_.data(), words_.size());
    return bytes;
}

}  // namespace tesserae::scenes

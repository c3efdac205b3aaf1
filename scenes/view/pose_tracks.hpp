// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/dynamics/bodies/bodies.hpp"
#include "render/camera/camera.hpp"
#include "render/description.hpp"

// How bodies move, in as few bits as a picture needs: what a page carries instead of a trajectory.
namespace tesserae::scenes {

/// A pose as numbers that change smoothly: the position [m], then the rotor as the two unit
/// quaternions (s, x, y, z) of its two ideals, by which to_matrix() turns one after the other.
using PoseNumbers = std::array<double, 12>;
constexpr std::size_t kPositionNumbers = 4;

/// @param last   a pose before it: of R and -R, which are one rotation, the one nearer to it is
///               taken
PoseNumbers pose_numbers(const Vec4& position, const Rotor& rotor, const PoseNumbers& last);

/// No number of a pose has more bits than this.
constexpr int kMostTrackBits = 30;
/// How far a stored pose may move any point of its body in the film's picture [pixels].
constexpr double kPoseAccuracy = 0.25;

/// What is known of a body's way once all moments were seen.
struct BodyTrack {
    BodyId id = 0;
    double radius = 0;   ///< of its bounding sphere [m]
    double reach = 0;    ///< how far from its centre points of it are shown [m]
    bool turns = false;  ///< its rotation shows
    PoseNumbers low, high, last;
    double tolerance = 0;      ///< by how much any of its points may be off [m]
    double from_slice = 0;     ///< how near it comes to the film's slice [m], <= 0: meets it
    bool has_moments = false;  ///< low, high and last are set
};

/// The grid on which a body's numbers are stored: low + k step, k below 2^bits.
struct TrackGrid {
    double position_low[kPositionNumbers];
    float turn_low[8];
    float position_step, turn_step;
    std::uint8_t bits[12];

    double low(std::size_t number) const {
        return number < kPositionNumbers ? position_low[number]
                                         : static_cast<double>(turn_low[number - kPositionNumbers]);
    }
    double step(std::size_t number) const {
        return static_cast<double>(number < kPositionNumbers ? position_step : turn_step);
    }
};

/// Each number of a pose has the fewest bits with which the pose is right to the tolerance; one
/// that never changes has none.
TrackGrid grid_of(const BodyTrack& track);

/// First pass over all moments: what range each visible body's pose has, and how finely a picture
/// shows it.
class PoseRanges {
  public:
    PoseRanges(const Bodies& bodies, const std::vector<render::Appearance>& appearance,
               const std::vector<render::Material>& materials);

    /// Has a point of a body shown, so far from its centre [m]: how the body turns is stored for
    /// it. Nothing is done for bodies that are not visible. To be called before add().
    void show_point(BodyId id, double distance);

    /// @param camera   the film's at that moment
    void add(const Bodies& bodies, const render::Camera& camera);

    const std::vector<BodyTrack>& tracks() const { return tracks_; }
    /// Leaves out bodies that never come as near as this to the film's slice [m].
    void keep_near_slice(double distance);

  private:
    std::vector<BodyTrack> tracks_;
};

/// Second pass: the poses as bytes, little-endian: the numbers of bodies and moments u32; then of
/// the bodies
///   position_low f64[4], all bodies' one after the other; then likewise turn_low f32[8],
///   position_step and turn_step f32[2], id u32, type u32, bits u8[12]; then a stream of bits in
///   u32 words: for each body, for each of its 12 numbers, that number's k at all moments.
class PosePacker {
  public:
    PosePacker(const PoseRanges& ranges, std::size_t moments);

    /// The bytes that packing will take.
    static std::uint64_t bytes_of(const PoseRanges& ranges, std::size_t moments);

    /// The next moment.
    void add(const Bodies& bodies);

    std::string take_bytes(const Bodies& bodies);

  private:
    void store(std::uint64_t bit, int count, std::uint32_t value);

    struct Track {
        BodyTrack body;
        TrackGrid grid;
        std::uint64_t first_bit;
    };
    std::vector<Track> tracks_;
    std::vector<std::uint32_t> words_;
    std::size_t moments_, moment_ = 0;
};

}  // namespace tesserae::scenes

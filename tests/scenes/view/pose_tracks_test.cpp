// SPDX-License-Identifier: Apache-2.0
// A page's poses are those of the trajectory, to a quarter of a pixel, in few bits.
#include "scenes/view/pose_tracks.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace tesserae::scenes {
namespace {

constexpr int kWidth = 1280, kHeight = 720;

/// Reads the bytes as poses.js does.
class PackedPoses {
  public:
    explicit PackedPoses(std::string bytes) : bytes_(std::move(bytes)) {
        bodies_ = number<std::uint32_t>(0), moments_ = number<std::uint32_t>(4);
    }
    std::size_t bodies() const { return bodies_; }
    BodyId id(std::size_t body) const { return number<std::uint32_t>(8 + 72 * bodies_ + 4 * body); }
    int bits(std::size_t body, std::size_t i) const {
        return number<std::uint8_t>(8 + 80 * bodies_ + 12 * body + i);
    }
    PoseNumbers pose(std::size_t body, std::size_t moment) const {
        std::uint64_t bit = 0;
        for (std::size_t b = 0; b < body; ++b)
            for (std::size_t i = 0; i < 12; ++i) bit += moments_ * bits(b, i);
        PoseNumbers numbers;
        for (std::size_t i = 0; i < 12; ++i) {
            const bool turns = i >= kPositionNumbers;
            numbers[i] = turns ? static_cast<double>(number<float>(8 + 32 * bodies_ + 32 * body +
                                                                   4 * (i - kPositionNumbers)))
                               : number<double>(8 + 32 * body + 8 * i);
            const double step =
                static_cast<double>(number<float>(8 + 64 * bodies_ + 8 * body + (turns ? 4 : 0)));
            numbers[i] +=
                step * static_cast<double>(bits_at(bit + moment * bits(body, i), bits(body, i)));
            bit += moments_ * bits(body, i);
        }
        return numbers;
    }

  private:
    template <class T>
    T number(std::size_t at) const {
        T value;
        std::memcpy(&value, bytes_.data() + at, sizeof value);
        return value;
    }
    std::uint64_t bits_at(std::uint64_t bit, int count) const {
        std::uint64_t value = 0;
        for (int k = 0; k < count; ++k) {
            const std::uint64_t at = bit + k;
            const auto word = number<std::uint32_t>(8 + 92 * bodies_ + 4 * (at / 32));
            value |= std::uint64_t{word >> (at % 32) & 1u} << k;
        }
        return value;
    }

    std::string bytes_;
    std::size_t bodies_, moments_;
};

/// A rotor of two quaternions as they are packed.
Rotor rotor_of(const PoseNumbers& n) {
    const Rotor r = {0.5 * (n[4] + n[8]),
                     {0.5 * (n[5] + n[9]), 0.5 * (n[6] + n[10]), 0.5 * (n[7] + n[11]),
                      0.5 * (n[11] - n[7]), 0.5 * (n[6] - n[10]), 0.5 * (n[9] - n[5])},
                     0.5 * (n[4] - n[8])};
    return projected_to_spin4(r);
}

/// Boxes that fly and whirl about a place, each its own way.
class Whirl {
  public:
    Whirl(const Vec4& place, std::size_t bodies) : random_(7) {
        bodies_.types = {{Hyperbox{{0.6, 0.8, 1.0, 1.2}}}};
        for (std::size_t i = 0; i < bodies; ++i) {
            bodies_.type.push_back(0);
            bodies_.position.push_back(place + Vec4::NullaryExpr([&] { return within(4); }));
            bodies_.rotor.push_back(exp(turn(3)));
            bodies_.velocity.push_back(Vec4::NullaryExpr([&] { return within(2); }));
            bodies_.angular_velocity.push_back(turn(4));
        }
    }
    const Bodies& bodies() const { return bodies_; }
    void move(double time) {
        for (BodyId id = 0; id < bodies_.size(); ++id) {
            bodies_.position[id] += time * bodies_.velocity[id];
            bodies_.rotor[id] = exp(-0.5 * time * bodies_.angular_velocity[id]) * bodies_.rotor[id];
        }
    }

  private:
    double within(double most) {
        return std::uniform_real_distribution<double>(-most, most)(random_);
    }
    Bivector turn(double most) {
        return {within(most), within(most), within(most), within(most), within(most), within(most)};
    }

    std::mt19937_64 random_;
    Bodies bodies_;
};

const std::vector<render::Appearance> kLooks = {{0, true}};
const std::vector<render::Material> kPlain(1);

render::Camera whirl_camera(const Vec4& place) {
    render::CameraDescription camera;
    camera.position = place + Vec4(0, 2, -9, 0);
    camera.look_at = place;
    return {camera, kWidth, kHeight};
}

/// Packs so many moments of a whirl, a thirtieth of a second apart.
PackedPoses packed(Whirl whirl, const render::Camera& camera, std::size_t moments) {
    PoseRanges ranges(whirl.bodies(), kLooks, kPlain);
    Whirl again = whirl;
    for (std::size_t m = 0; m < moments; ++m)
        ranges.add(whirl.bodies(), camera), whirl.move(1.0 / 30);
    PosePacker packer(ranges, moments);
    for (std::size_t m = 0; m < moments; ++m) packer.add(again.bodies()), again.move(1.0 / 30);
    const std::string bytes = packer.take_bytes(again.bodies());
    EXPECT_EQ(bytes.size(), PosePacker::bytes_of(ranges, moments));
    return PackedPoses(bytes);
}

TEST(PoseTracks, PointsOfBodiesAreOffByAQuarterPixelAtMost) {
    for (const double far : {0.0, 1000.0, 1e6}) {
        const Vec4 place = Vec4::Constant(far);
        const render::Camera camera = whirl_camera(place);
        constexpr std::size_t kMoments = 40;
        Whirl whirl(place, 20);
        const PackedPoses poses = packed(whirl, camera, kMoments);
        double worst = 0;
        for (std::size_t m = 0; m < kMoments; ++m, whirl.move(1.0 / 30))
            for (BodyId id = 0; id < 20; ++id) {
                const Vec4& centre = whirl.bodies().position[id];
                const PoseNumbers numbers = poses.pose(id, m);
                const Mat4 turn = to_matrix(whirl.bodies().rotor[id]);
                const Mat4 turned = to_matrix(rotor_of(numbers));
                const Vec4 there(numbers[0], numbers[1], numbers[2], numbers[3]);
                for (const double side : {-1.0, 1.0}) {
                    const Vec4 corner = side * Vec4(0.3, 0.4, -0.5, 0.6);
                    const Vec4 point = centre + turn * corner;
                    const double off = (there + turned * corner - point).norm();
                    worst = std::max(
                        worst, off / ((point - camera.origin()).norm() * camera.pixel_size()));
                }
            }
        EXPECT_LT(worst, kPoseAccuracy) << far;
        EXPECT_GT(worst, 0.02 * kPoseAccuracy) << "more bits than are needed";
    }
}

TEST(PoseTracks, WhatDoesNotChangeTakesNoBits) {
    const render::Camera camera = whirl_camera(Vec4::Zero());
    Bodies bodies;
    bodies.types = {{Hyperbox{}}, {Hypersphere{}}, {Hyperplane{}}};
    for (const std::uint32_t type : {0u, 1u, 2u}) {
        bodies.type.push_back(type);
        bodies.position.push_back(Vec4(1.0 / 3, 2, 1e4, 0) * (type == 2 ? 0 : 1));
        bodies.rotor.emplace_back();
    }
    const std::vector<render::Appearance> looks(3);
    PoseRanges ranges(bodies, looks, kPlain);
    ranges.add(bodies, camera);
    // A sphere of one colour may turn.
    bodies.rotor[1] = exp({1, 2, 3, 0, 0, 0});
    ranges.add(bodies, camera);
    PosePacker packer(ranges, 2);
    packer.add(bodies), packer.add(bodies);
    const PackedPoses poses(packer.take_bytes(bodies));
    ASSERT_EQ(poses.bodies(), 3u);
    for (std::size_t body = 0; body < 3; ++body)
        for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(poses.bits(body, i), 0) << body << ' ' << i;
    // Positions exactly.
    EXPECT_EQ(poses.pose(0, 1)[0], 1.0 / 3);
    EXPECT_EQ(poses.pose(0, 1)[2], 1e4);
}

TEST(PoseTracks, LeavesOutWhatIsInvisibleOrNeverNearTheSlice) {
    const render::Camera camera = whirl_camera(Vec4::Zero());
    Bodies bodies;
    bodies.types = {{Hypersphere{0.5}}, {Hypersphere{0.5}}};
    for (const auto& [type, w] : {std::pair{0u, 0.0}, {1u, 0.0}, {0u, 2.0}, {0u, -3.0}}) {
        bodies.type.push_back(type);
        bodies.position.push_back({0, 0, 0, w});
        bodies.rotor.emplace_back();
    }
    PoseRanges ranges(bodies, {{0, true}, {0, false}}, kPlain);
    ranges.add(bodies, camera);
    EXPECT_EQ(ranges.tracks().size(), 3u);
    bodies.position[3][3] = 1.2;  // it comes near later
    ranges.add(bodies, camera);
    ranges.keep_near_slice(1);
    ASSERT_EQ(ranges.tracks().size(), 2u);
    EXPECT_EQ(ranges.tracks()[0].id, 0u);
    EXPECT_EQ(ranges.tracks()[1].id, 3u);
}

/// The page's promise: 500 bodies at 250 moments in 4 MB, of which base64 takes a third more.
TEST(PoseTracks, FiveHundredBodiesTakeLessThanThreeMegabytes) {
    const render::Camera camera = whirl_camera(Vec4::Zero());
    Whirl whirl(Vec4::Zero(), 500);
    PoseRanges ranges(whirl.bodies(), kLooks, kPlain);
    for (int m = 0; m < 250; ++m) ranges.add(whirl.bodies(), camera), whirl.move(1.0 / 30);
    EXPECT_LT(PosePacker::bytes_of(ranges, 250), 2'900'000u);
}

}  // namespace
}  // namespace tesserae::scenes

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "scenes/camera_motion.hpp"
#include "scenes/camera_orbit.hpp"
#include "scenes/load/rules.hpp"

// The keys by which the camera moves, beside those that say what it is like (picture_keys.hpp).
namespace tesserae::scenes {

// In the order of kPlaneAxes and of Ease.
constexpr std::string_view kPlaneNames[] = {"xy", "xz", "xw", "yz", "yw", "zw"};
constexpr std::string_view kEases[] = {"linear", "in", "out", "in-out"};
/// A thousand turns [degrees].
constexpr double kMostAngle = 360'000;

constexpr Flag<FollowAxes> kFollowAxes[] = {
    {"x", &FollowAxes::x}, {"y", &FollowAxes::y}, {"z", &FollowAxes::z}, {"w", &FollowAxes::w}};
/// All of them are not written.
struct AxesOrUnwritten : Flags<FollowAxes> {
    void write(EffectiveWriter& out, const char* key, const FollowAxes& axes) const {
        if (axes != FollowAxes()) Flags::write(out, key, axes);
    }
};

/// [camera]: how it moves beside its keys
void camera_motion_keys(auto& self, const auto& visit) {
    visit({"closed", "",
           "The path of the keys goes on round: the last is as the first, and the camera passes it "
           "without a kink."},
          self.closed, FalseOrUnwritten{});
    visit({"follow", "",
           "The camera and the point that it looks at move as this body moves from where it is at "
           "time 0.",
           "none"},
          self.follow, BodyName{});
    visit({"follow_axes", "", "It follows along these of the world's axes.",
           R"(`["x", "y", "z", "w"]`)"},
          self.follow_axes, AxesOrUnwritten{{kFollowAxes, "expected at least one axis"}});
    visit({"follow_lag", "s",
           "It follows the mean of where the body was during so long a time before."},
          self.follow_lag, RealOrUnwritten{interval_of(Rule::kNonNegative)});
}

/// orbit = { ... } of a [[camera.key]]
void orbit_keys(auto& self, const auto& visit) {
    visit({"about", "m", "The camera goes round this point."}, self.about,
          Required{"expected four numbers: the point to go round", Rule::kFinite});
    visit({"plane", "", "The circle lies in this plane of the world's axes."}, self.plane,
          Required{R"(expected the plane to turn in, such as "xz")", Names{kPlaneNames}});
    visit({"angle", "deg",
           "The camera turns by so much, the plane's first axis toward its second; more than 360 "
           "are several turns."},
          self.angle, Required{"expected an angle in degrees", Interval{-kMostAngle, kMostAngle}});
}

/// An orbit, whose keys stand in a table of their own.
struct OrbitTable {
    static constexpr const char* kType = "table";
    static constexpr const char* kAllowed = "see below; not beside a position";

    void read(TableReader& reader, const char* key, CameraOrbit& orbit) const {
        reader.read_inside(key, R"({ about = [0, 0, 0, 0], plane = "xz", angle = 90 })",
                           [&](TableReader& inside) { orbit_keys(orbit, ReadKeys{inside}); });
    }
    void write(EffectiveWriter& out, const char* key, const CameraOrbit& orbit) const {
        EffectiveWriter lines;
        orbit_keys(orbit, WriteKeys{lines});
        out.line(key, inline_table(lines));
    }
};

}  // namespace tesserae::scenes

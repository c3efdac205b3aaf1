#pragma once

#include <string>
#include <string_view>

#include "scenes/camera_orbit.hpp"
#include "scenes/load/rules.hpp"

// The keys by which the camera moves, beside those that say what it is like (picture_keys.hpp).
namespace tesserae::scenes {

// In the order of kPlaneAxes and of Ease.
constexpr std::string_view kPlaneNames[] = {"xy", "xz", "xw", "yz", "yw", "zw"};
constexpr std::string_view kEases[] = {"linear", "in", "out", "in-out"};
/// A thousand turns [degrees].
constexpr double kMostAngle = 360'000;

/// [camera]: how it moves beside its keys
void camera_motion_keys(auto& self, const auto& visit) {
    visit({"closed", "",
           "The path of the keys goes on round: the last is as the first, and the camera passes it "
           "without a kink."},
          self.closed, FalseOrUnwritten{});
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
        std::string text = lines.take_text();
        text.pop_back();
        for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos;)
            text.replace(at, 1, ", ");
        out.line(key, "{ " + text + " }");
    }
};

}  // namespace tesserae::scenes

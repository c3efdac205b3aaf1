#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "scenes/camera_path.hpp"
#include "scenes/load/rules.hpp"

// The keys of the tables that make the picture, one list a table (see rules.hpp). A list in parts
// is written in another order than it is read.
namespace tesserae::scenes {

constexpr Interval kUnit{0, 1};
constexpr Interval kNotNegative{0, kLargest};
constexpr Interval kFieldOfView{0, 180, true, true};

// In the order of the enumerations in render/description.hpp.
constexpr std::string_view kMaterialKinds[] = {"diffuse", "mirror", "glass", "rough"};
constexpr std::string_view kPatterns[] = {"none", "checker", "stripes"};
constexpr std::string_view kPictureIntegrators[] = {"direct", "path"};
constexpr std::string_view kIntersectors[] = {"trace", "analytic"};
constexpr std::string_view kFilters[] = {"box", "triangle", "gaussian", "blackman-harris"};
constexpr std::string_view kCompressions[] = {"none", "rle", "zips", "zip", "piz"};
constexpr std::string_view kSkies[] = {"opaque", "transparent"};
constexpr Flag<render::Channels> kChannels[] = {{"color", &render::Channels::color},
                                                {"depth", &render::Channels::depth},
                                                {"normal", &render::Channels::normal},
                                                {"albedo", &render::Channels::albedo},
                                                {"id", &render::Channels::id},
                                                {"position", &render::Channels::position},
                                                {"variance", &render::Channels::variance},
                                                {"samples", &render::Channels::samples},
                                                {"motion", &render::Channels::motion},
                                                {"zplanar", &render::Channels::zplanar},
                                                {"normal3", &render::Channels::normal3},
                                                {"light", &render::Channels::light},
                                                {"cryptomatte", &render::Channels::cryptomatte}};

struct NotEmpty {
    void read(TableReader& reader, const char* key, std::string& value) const {
        if (reader.read(key, value) && value.empty())
            reader.fail(key, "expected a name that is not empty");
    }
};

/// [[material]]
void material_keys(auto& self, const auto& visit) {
    visit("name", self.name, Required{"expected a string", NotEmpty{}});
    visit("kind", self.kind, Names{kMaterialKinds});
    visit("albedo", self.albedo, kUnit);
    visit("pattern", self.pattern, Names{kPatterns});
    visit("pattern_albedo", self.pattern_albedo, kUnit);
    visit("pattern_size", self.pattern_size, Rule::kPositive);
    visit("albedo_variation", self.albedo_variation, RealOrUnwritten{kUnit});
    visit("ior", self.ior, Interval{1, kLargest, true});
    visit("roughness", self.roughness, kUnit);
    visit("emission", self.emission, kNotNegative);
}

enum class LightType { kSun, kPoint, kSphere, kSky };
constexpr std::string_view kLightTypes[] = {"sun", "point", "sphere", "sky"};

/// A [[light]], checked. The defaults are the light of scenes that have none.
struct LightTable {
    LightType type = LightType::kSky;
    render::Color color = render::Color::Ones();
    double strength = 1;
    Vec4 direction = -Vec4::UnitY();  ///< of a sun, as written
    double angle = 1;                 ///< of a sun
    Vec4 position = Vec4::Zero();     ///< of a point and a sphere
    double radius = 1;                ///< of a sphere
};

void light_type_keys(auto& self, const auto& visit) {
    visit("type", self.type,
          Required{R"(expected "sun", "point", "sphere" or "sky")", Names{kLightTypes}});
}
void light_color_keys(auto& self, const auto& visit) {
    visit("color", self.color, kNotNegative);
    visit("strength", self.strength, kNotNegative);
}
/// Those of the light's type.
void light_place_keys(auto& self, const auto& visit) {
    if (self.type == LightType::kSun) {
        visit("direction", self.direction,
              Required{"expected four numbers: the way that the light travels", Rule::kNonZero});
        visit("angle", self.angle, Interval{0, 30});
    }
    if (self.type == LightType::kPoint || self.type == LightType::kSphere)
        visit("position", self.position, Required{"expected four numbers", Rule::kFinite});
    if (self.type == LightType::kSphere)
        visit("radius", self.radius, Required{"expected a number > 0", Rule::kPositive});
}

/// [camera], but for its [[camera.key]]
void camera_keys(auto& self, const auto& visit) {
    visit("position", self.position, Rule::kFinite);
    visit("look_at", self.look_at, Rule::kFinite);
    visit("up", self.up, Rule::kNonZero);
    visit("fourth", self.fourth, Rule::kNonZero);
    visit("field_of_view", self.field_of_view, kFieldOfView);
    visit("aperture", self.aperture, Rule::kNonNegative);
    visit("focus_distance", self.focus_distance, Rule::kNonNegative);
    visit("shutter", self.shutter, kUnit);
    visit("slice_thickness", self.slice_thickness, Rule::kNonNegative);
    visit("slices", self.slices, IntegerRange{1, 1000});
}

/// Sine of the angle below which camera directions count as parallel; Camera's own bound is lower.
constexpr double kParallel = 1e-7;

/// The time of a camera key: later than the last one's.
struct NextTime {
    std::span<const CameraKey> before;

    void read(TableReader& reader, const char* key, double& time) const {
        reader.read(key, time, Interval{});
        if (!before.empty() && !(time > before.back().time))
            reader.fail(key, fmt::format("expected a time after the last key's, {} s",
                                         toml_text(before.back().time)));
    }
};
/// The direction as a unit vector. One that is unit to rounding stays as it is, so that what was
/// made unit once is itself again when the canonical text is read.
inline Vec4 unit_direction(const Vec4& direction) {
    constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
    if (std::abs(direction.squaredNorm() - 1) <= kRounding) return direction;
    return stable_normalized(direction);
}

/// A direction, made unit, that the camera can turn to from the last key's in one way only.
struct Turn {
    std::span<const CameraKey> before;
    std::optional<Vec4> CameraKey::*part;

    void read(TableReader& reader, const char* key, Vec4& direction) const {
        reader.read(key, direction, Rule::kNonZero);
        direction = unit_direction(direction);
        const auto last = std::find_if(before.rbegin(), before.rend(),
                                       [&](const CameraKey& k) { return (k.*part).has_value(); });
        if (last != before.rend() && !((*(*last.*part) + direction).norm() > kParallel))
            reader.fail(key,
                        "is opposite to the last key's; expected another direction, or a "
                        "key between them that says which way to turn");
    }
};

/// [[camera.key]]
/// @param before   the keys before it
void camera_key_keys(auto& self, const auto& visit, std::span<const CameraKey> before) {
    visit("time", self.time, Required{"expected a time in s", NextTime{before}});
    visit("position", self.position, Rule::kFinite);
    visit("look_at", self.look_at, Rule::kFinite);
    visit("up", self.up, Turn{before, &CameraKey::up});
    visit("fourth", self.fourth, Turn{before, &CameraKey::fourth});
    visit("field_of_view", self.field_of_view, kFieldOfView);
}

constexpr int kMaxSize = 65536;
/// A path of a million bounces, a sphere trace of a million steps is stuck.
constexpr int kMaxBounces = 1'000'000, kMaxSteps = 1'000'000;
constexpr IntegerRange kSampleCounts{1, 1 << 20};

/// Width and height, kept in two members.
struct FrameSize {
    void read(TableReader& reader, const char* key, render::Settings& s) const {
        std::array<std::int64_t, 2> size = {s.width, s.height};
        reader.read(key, size, {1, kMaxSize});
        s.width = static_cast<int>(size[0]);
        s.height = static_cast<int>(size[1]);
    }
    void write(EffectiveWriter& out, const char* key, const render::Settings& s) const {
        out.line(key, fmt::format("[{}, {}]", s.width, s.height));
    }
};
/// What --crop sets. Scene files may have it too: the canonical text does, which is read again from
/// trajectories and folders of frames.
struct CropOf {
    int width, height;

    void read(TableReader& reader, const char* key, render::Crop& crop) const {
        std::array<std::int64_t, 4> c = {};
        reader.read(key, c, {0, kMaxSize});
        if (c[0] >= c[2] || c[1] >= c[3] || c[2] > width || c[3] > height)
            reader.fail(key, fmt::format("expected [x0, y0, x1, y1] with x0 < x1 <= {} and "
                                         "y0 < y1 <= {}",
                                         width, height));
        crop = {static_cast<int>(c[0]), static_cast<int>(c[1]), static_cast<int>(c[2]),
                static_cast<int>(c[3])};
    }
    void write(EffectiveWriter& out, const char* key, const render::Crop& c) const {
        out.line(key, fmt::format("[{}, {}, {}, {}]", c.x0, c.y0, c.x1, c.y1));
    }
};

/// [render]: the frames
void frame_keys(auto& self, const auto& visit) {
    visit("size", self, FrameSize{});
    visit("frames_per_second", self.frames_per_second, Rule::kPositive);
    visit("samples", self.samples, kSampleCounts);
}
/// [render]: a pixel
void pixel_keys(auto& self, const auto& visit) {
    visit("filter", self.filter, Names{kFilters});
    visit("filter_width", self.filter_width, Interval{0, 100, true});
    visit("noise_target", self.noise_target, Rule::kNonNegative);
    visit("max_samples", self.max_samples, kSampleCounts);
    visit("seed", self.seed, IntegerOrUnwritten{});
    visit("lock_noise", self.lock_noise, FalseOrUnwritten{});
}
/// [render]: the rays
void ray_keys(auto& self, const auto& visit) {
    visit("integrator", self.integrator, Names{kPictureIntegrators});
    visit("bounces", self.bounces, IntegerRange{0, kMaxBounces});
    visit("clamp_indirect", self.clamp_indirect, Rule::kNonNegative);
    visit("intersector", self.intersector, Names{kIntersectors});
    visit("max_steps", self.max_steps, IntegerRange{1, kMaxSteps});
    visit("max_distance", self.max_distance, Rule::kNonNegative);
    visit("sky", self.sky, NamesOrUnwritten{{kSkies}});
    visit("tile", self.tile, IntegerRange{8, 512});
}
/// [render]: the files
void file_keys(auto& self, const auto& visit) {
    visit("channels", self.channels,
          Flags<render::Channels>{kChannels, "expected at least one channel"});
    visit("compression", self.compression, Names{kCompressions});
    visit("exposure", self.exposure, Interval{-1000, 1000});
    visit("crop", self.crop, CropOf{self.width, self.height});
}

}  // namespace tesserae::scenes

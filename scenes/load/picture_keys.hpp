// SPDX-License-Identifier: Apache-2.0
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
#include "scenes/load/camera_keys.hpp"
#include "scenes/load/rules.hpp"

// The keys of the tables that make the picture, one list a table (see rules.hpp). A list in parts
// is written in another order than it is read.
namespace tesserae::scenes {

constexpr Interval kUnit{0, 1};
constexpr Interval kNotNegative{0, kLargest};
constexpr Interval kFieldOfView{0, 180, true, true};

// In the order of the enumerations in render/description.hpp.
constexpr std::string_view kMaterialKinds[] = {"diffuse", "mirror", "glass", "rough"};
constexpr std::string_view kPatterns[] = {"none", "checker", "stripes", "noise",
                                          "grid", "edges",   "cells",   "w"};
constexpr std::string_view kWOf[] = {"point", "body"};
constexpr std::string_view kPictureIntegrators[] = {"direct", "path"};
constexpr std::string_view kIntersectors[] = {"trace", "analytic"};
constexpr std::string_view kFilters[] = {"box", "triangle", "gaussian", "blackman-harris"};
constexpr std::string_view kCompressions[] = {"none", "rle", "zips", "zip", "piz"};
constexpr std::string_view kGhostsIn[] = {"layer", "over"};
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
    static constexpr const char* kAllowed = "not empty";

    void read(TableReader& reader, const char* key, std::string& value) const {
        if (reader.read(key, value) && value.empty())
            reader.fail(key, "expected a name that is not empty");
    }
};

/// Glass takes no light where nothing else is said.
struct AlbedoOf {
    static constexpr const char* kAllowed = "0 to 1";
    render::MaterialKind kind;

    void read(TableReader& reader, const char* key, render::Color& albedo) const {
        if (kind == render::MaterialKind::kGlass) albedo.setOnes();
        reader.read(key, albedo, kUnit);
    }
    void write(EffectiveWriter& out, const char* key, const render::Color& albedo) const {
        out.key(key, albedo);
    }
};

/// [[material]]
void material_keys(auto& self, const auto& visit) {
    visit({"name", "", "A body names its material by this."}, self.name,
          Required{"expected a string", NotEmpty{}});
    visit({"kind", "", "The surface is matt, a mirror, clear glass or a blurred mirror."},
          self.kind, Names{kMaterialKinds});
    visit({"albedo", "",
           "The surface sends this part of red, green and blue light back; glass lets this part "
           "through at each surface.",
           "`[0.8, 0.8, 0.8]`, of glass `[1.0, 1.0, 1.0]`"},
          self.albedo, AlbedoOf{self.kind});
    visit(
        {"pattern", "",
         "The albedo changes over the body: checker, stripes, noise and grid lie in its own four "
         "axes, and the slice cuts them as it cuts the body; edges are lines where two cells of a "
         "box or a polytope meet, cells gives each of them a hue; w shows where in the world's w "
         "the body is, blue on the negative side, white at 0, orange on the positive side."},
        self.pattern, Names{kPatterns});
    visit(
        {"pattern_albedo", "",
         "Every second cell or stripe, the lines, or the other colour of noise have this albedo."},
        self.pattern_albedo, kUnit);
    visit({"pattern_size", "m",
           "A cell of the pattern has this edge, a stripe this width; w has its full colours this "
           "far from 0."},
          self.pattern_size, Rule::kPositive);
    visit({"line_width", "m", "Lines of grid and edges are this wide."}, self.line_width,
          RealOrUnwritten{Interval{0, kLargest, true}, render::Material{}.line_width});
    visit({"w_of", "", "Pattern w shows where each point of the surface is, or the body's centre."},
          self.w_of, NamesOrUnwritten{{kWOf}});
    visit({"albedo_variation", "",
           "Bodies of this material differ in brightness and hue by up to this part."},
          self.albedo_variation, RealOrUnwritten{kUnit});
    visit({"ior", "", "Glass has this index of refraction against empty space."}, self.ior,
          Interval{1, kLargest, true});
    visit({"roughness", "", "A rough mirror is blurred by this much; 0 is a perfect mirror."},
          self.roughness, kUnit);
    visit({"emission", "",
           "The surface itself sends this radiance to every side; it lights other bodies where "
           "integrator is path."},
          self.emission, kNotNegative);
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
    visit({"type", "",
           "The light comes from far away, from a point, from a ball, or from everywhere."},
          self.type, Required{R"(expected "sun", "point", "sphere" or "sky")", Names{kLightTypes}});
}
void light_color_keys(auto& self, const auto& visit) {
    visit({"color", "", "Red, green and blue have these parts of the strength."}, self.color,
          kNotNegative);
    visit({"strength", "",
           "This times the color is the irradiance of a sun on a surface that faces it, the flux "
           "of a point, the radiance of a sphere and of the sky."},
          self.strength, kNotNegative);
}
/// Those of the light's type.
void light_place_keys(auto& self, const auto& visit) {
    if (self.type == LightType::kSun) {
        visit({"direction", "", "The light travels this way; the length does not matter."},
              self.direction,
              Required{"expected four numbers: the way that the light travels", Rule::kNonZero});
        visit({"angle", "deg",
               "The sun's disc has this half-angle, seen from the scene; 0 makes hard shadows."},
              self.angle, Interval{0, 30});
    }
    if (self.type == LightType::kPoint || self.type == LightType::kSphere)
        visit({"position", "m",
               "The light's centre is here; its light falls off with the cube of the distance."},
              self.position, Required{"expected four numbers", Rule::kFinite});
    if (self.type == LightType::kSphere)
        visit({"radius", "m",
               "The ball of light has this radius; it is seen and makes soft shadows, and nothing "
               "collides with it."},
              self.radius, Required{"expected a number > 0", Rule::kPositive});
}

/// [camera], but for its [[camera.key]]
void camera_keys(auto& self, const auto& visit) {
    visit({"position", "m", "The camera is here; the slice goes through it."}, self.position,
          Rule::kFinite);
    visit({"look_at", "m", "This point is in the middle of the picture."}, self.look_at,
          Rule::kFinite);
    visit({"up", "", "This direction is up in the picture."}, self.up, Rule::kNonZero);
    visit({"fourth", "",
           "The camera does not see along this direction; the slice is orthogonal to it."},
          self.fourth, Rule::kNonZero);
    visit({"field_of_view", "deg", "The picture spans this angle from its bottom to its top."},
          self.field_of_view, kFieldOfView);
    visit({"aperture", "m",
           "The lens has this radius and blurs what is out of focus; 0 is a pinhole."},
          self.aperture, Rule::kNonNegative);
    visit(
        {"focus_distance", "m",
         "What lies this far along the forward direction is sharp; 0 is the distance of look_at."},
        self.focus_distance, Rule::kNonNegative);
    visit({"shutter", "frames",
           "The shutter is open for this part of a frame, from the frame's time on; it blurs what "
           "moves."},
          self.shutter, kUnit);
    visit({"slice_thickness", "m",
           "The picture shows this range along fourth, centred on the slice."},
          self.slice_thickness, Rule::kNonNegative);
    visit(
        {"slices", "",
         "So many sharp slices of the range are shown side by side; 1 averages the range instead."},
        self.slices, IntegerRange{1, 1000});
}

/// Sine of the angle below which camera directions count as parallel; Camera's own bound is lower.
constexpr double kParallel = 1e-7;

/// The time of a camera key: later than the last one's.
struct NextTime {
    static constexpr const char* kAllowed = "after the last key's";

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
    static constexpr const char* kAllowed = "not opposite to the last key's";

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
    visit({"time", "s", "The camera is so at this time, which is later than the key before."},
          self.time, Required{"expected a time in s", NextTime{before}});
    visit({"position", "m", "The camera is here at this time.", "as other keys say"}, self.position,
          Rule::kFinite);
    visit({"look_at", "m", "This point is in the middle of the picture at this time.",
           "as other keys say"},
          self.look_at, Rule::kFinite);
    visit({"up", "", "This direction is up in the picture at this time.", "as other keys say"},
          self.up, Turn{before, &CameraKey::up});
    visit({"fourth", "",
           "The camera does not see along this direction at this time; a change turns the slice.",
           "as other keys say"},
          self.fourth, Turn{before, &CameraKey::fourth});
    visit({"field_of_view", "deg",
           "The picture spans this angle from its bottom to its top at this time.",
           "as other keys say"},
          self.field_of_view, kFieldOfView);
    visit({"orbit", "",
           "The camera comes here on a circle, from where it is at the key before, or at 0 s if "
           "this is the first.",
           "as other keys say"},
          self.orbit, OrbitTable{});
    visit({"ease", "",
           "The orbit goes at the same speed all the time, begins at rest, ends at rest, or both."},
          self.ease, NamesOrUnwritten{{kEases}});
}

constexpr int kMaxSize = 65536;
/// A path of a million bounces, a sphere trace of a million steps is stuck.
constexpr int kMaxBounces = 1'000'000, kMaxSteps = 1'000'000;
constexpr IntegerRange kSampleCounts{1, 1 << 20};

/// Width and height, kept in two members.
struct FrameSize {
    static constexpr const char* kType = "[width, height]";
    static constexpr const char* kAllowed = "1 to 65536 each";

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
    static constexpr const char* kType = "[x0, y0, x1, y1]";
    static constexpr const char* kAllowed = "inside the frame";

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

/// Of previews, kept as 0 where it is what they have anyway.
struct PreviewWidth {
    static constexpr const char* kAllowed = "1 to the frame's width";

    int frame_width;

    void read(TableReader& reader, const char* key, int& width) const {
        reader.read(key, width, {1, kMaxSize});
        if (width > frame_width)
            reader.fail(key, fmt::format("expected an integer from 1 to {}, the frame's width; "
                                         "leave it out, or set size",
                                         frame_width));
        if (width == std::min(frame_width, render::kPreviewWidth)) width = 0;
    }
    void write(EffectiveWriter& out, const char* key, int width) const {
        if (width != 0) out.key(key, width);
    }
};

/// [render]: the frames
void frame_keys(auto& self, const auto& visit) {
    visit({"size", "pixels", "The frames have this width and height."}, self, FrameSize{});
    visit({"frames_per_second", "1/s",
           "A second of the motion has so many frames; the film plays at this rate."},
          self.frames_per_second, Rule::kPositive);
    visit({"samples", "",
           "A pixel has so many samples; more of them make edges, shadows and traced light less "
           "noisy."},
          self.samples, kSampleCounts);
}
/// [render]: a pixel
void pixel_keys(auto& self, const auto& visit) {
    visit({"filter", "", "The samples in and around a pixel are weighted by this function."},
          self.filter, Names{kFilters});
    visit({"filter_width", "pixels", "The filter is this wide."}, self.filter_width,
          Interval{0, 100, true});
    visit({"noise_target", "",
           "A pixel whose standard error is above this part of white gets more samples; 0 gives "
           "every pixel the same."},
          self.noise_target, Rule::kNonNegative);
    visit({"max_samples", "", "A pixel has at most so many samples where there is a noise_target.",
           "samples"},
          self.max_samples, kSampleCounts);
    visit({"seed", "", "This number chooses the random numbers of the samples."}, self.seed,
          IntegerOrUnwritten{});
    visit({"lock_noise", "", "Every frame has the random numbers of frame 0."}, self.lock_noise,
          FalseOrUnwritten{});
}
/// [render]: the rays
void ray_keys(auto& self, const auto& visit) {
    visit({"integrator", "",
           "Light is found in closed form from lamps and an even sky, or by paths through the "
           "scene."},
          self.integrator, Names{kPictureIntegrators});
    visit(
        {"bounces", "",
         "With path light is followed by way of so many surfaces, mirrors and glass not counted."},
        self.bounces, IntegerRange{0, kMaxBounces});
    visit({"specular_bounces", "",
           "Light is followed by way of so many mirrors and surfaces of glass; what is left of it "
           "is black."},
          self.specular_bounces,
          IntegerOrUnwritten{{0, kMaxBounces}, render::kUsualSpecularBounces});
    visit({"clamp_indirect", "",
           "A sample gets at most this radiance by way of two surfaces or more, which removes "
           "bright specks; 0 is no limit."},
          self.clamp_indirect, Rule::kNonNegative);
    visit({"intersector", "", "Rays meet bodies by sphere tracing or in closed form."},
          self.intersector, Names{kIntersectors});
    visit({"max_steps", "", "A sphere trace gives up after so many steps."}, self.max_steps,
          IntegerRange{1, kMaxSteps});
    visit({"max_distance", "m",
           "Nothing farther than this along a ray is met, but for lights; 0 is no limit."},
          self.max_distance, Rule::kNonNegative);
    visit({"sky", "",
           "The picture shows the sky itself, or leaves it out, so that it can be laid over "
           "another."},
          self.sky, NamesOrUnwritten{{kSkies}});
    visit({"tile", "pixels",
           "Threads take and EXR files store tiles of this edge; it changes no pixel."},
          self.tile, IntegerRange{8, 512});
}
/// [render]: bodies beside the slice
void ghost_keys(auto& self, const auto& visit) {
    visit({"ghost_depth", "m",
           "Bodies that the slice misses by less than this are drawn as ghosts, the paler the "
           "farther; the EXR files hold them as layer `ghost`; 0 draws none."},
          self.ghost_depth, RealOrUnwritten{kNotNegative});
    visit({"ghosts", "",
           "Ghosts are a layer of the EXR files only, or laid over previews and films as well."},
          self.ghosts, NamesOrUnwritten{{kGhostsIn}});
    visit({"ghost_minus", "", "Ghosts on the negative side of the fourth axis have this color."},
          self.ghost_colors[0], ColorOrUnwritten{kUnit, render::kSideColors[0]});
    visit({"ghost_plus", "", "Ghosts on the positive side of the fourth axis have this color."},
          self.ghost_colors[1], ColorOrUnwritten{kUnit, render::kSideColors[1]});
}
/// [render]: the files
void file_keys(auto& self, const auto& visit) {
    visit({"channels", "", "The EXR files hold these channels."}, self.channels,
          Flags<render::Channels>{kChannels, "expected at least one channel"});
    visit({"compression", "", "The EXR files are compressed so; all kinds are lossless."},
          self.compression, Names{kCompressions});
    visit({"exposure", "stops",
           "Previews and film are brighter by a factor of two a stop; the EXR files stay."},
          self.exposure, Interval{-1000, 1000});
    visit({"preview_size", "pixels",
           "Previews and film are so wide; their height follows from the frame's.",
           "1920, or the frame's width where that is less"},
          self.preview_size, PreviewWidth{self.width});
    visit({"crop", "pixels",
           "Only the pixels from x0 to x1 and y0 to y1 are rendered, counted from the top left, x1 "
           "and y1 left out.",
           "the whole frame"},
          self.crop, CropOf{self.width, self.height});
}

}  // namespace tesserae::scenes

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/algebra/vector.hpp"

// What a scene says about its picture, checked, with the defaults of the scene format. A list of
// plain structs: loaders fill them, the renderer reads them.
namespace tesserae::render {

/// Linear Rec. 709.
using Color = Eigen::Array3d;

/// What lies towards the negative and the positive side of the fourth axis is shown in these.
inline const std::array<Color, 2> kSideColors = {Color(0.08, 0.3, 0.95), Color(1.0, 0.42, 0.06)};

/// In the order of the scene format's names.
enum class Pattern { kNone, kChecker, kStripes, kNoise, kGrid, kEdges, kCells, kW };
/// Whose place along the world's w the pattern kW shows.
enum class WOf { kPoint, kBody };

/// In the order of the scene format's names.
enum class MaterialKind { kDiffuse, kMirror, kGlass, kRough };

struct Material {
    std::string name;
    MaterialKind kind = MaterialKind::kDiffuse;
    Color albedo = Color::Constant(0.8);  ///< each 0 to 1
    Pattern pattern = Pattern::kNone;
    Color pattern_albedo = Color::Constant(0.2);
    double pattern_size = 0.5;  ///< see pattern_albedo() [m], > 0
    double line_width = 0.03;   ///< the same
    WOf w_of = WOf::kPoint;
    double albedo_variation = 0;     ///< see tint_of(), 0 to 1
    double ior = 1.5;                ///< of glass against empty space, > 1
    double roughness = 0.3;          ///< of rough, 0 to 1; 0 is a mirror
    Color emission = Color::Zero();  ///< radiance toward every side, >= 0, of any kind
};

/// How the bodies of a type look.
struct Appearance {
    std::uint32_t material = 0;  ///< index into the materials
    bool visible = true;         ///< to the camera, and casting shadows
    double hue_jitter = 0;       ///< see hue_turn_of(), 0 to 1

    friend bool operator==(const Appearance&, const Appearance&) = default;
};

/// Directional light of irradiance color * strength on a facing surface; its disc is a 3-ball of
/// half-angle `angle` around -direction.
struct Sun {
    Vec4 direction = -Vec4::UnitY();  ///< unit: the way that the light travels
    Color irradiance = Color::Ones();
    double angle = 1;  ///< half-angle [degrees], 0 to 30; 0 is a hard shadow
};

/// Sends its flux equally to all sides: irradiance flux cos/(2 pi^2 r^3) at distance r.
struct PointLight {
    Vec4 position = Vec4::Zero();  ///< world [m]
    Color flux = Color::Ones();
};

/// A ball of light: the same radiance from every point of its surface toward every side. It is seen
/// by the camera and by all other rays, and is no body.
struct SphereLight {
    Vec4 position = Vec4::Zero();  ///< of the centre, world [m]
    double radius = 1;             ///< [m], > 0
    Color radiance = Color::Ones();
};

struct Lights {
    std::vector<Sun> suns;
    std::vector<PointLight> points;
    std::vector<SphereLight> spheres;
    Color sky = Color::Zero();  ///< radiance from everywhere, the sum of all skies
};

/// Position and orientation as written; Camera makes the orthonormal frame.
struct CameraDescription {
    Vec4 position = {0, 2, -8, 0};
    Vec4 look_at = Vec4::Zero();
    Vec4 up = Vec4::UnitY();
    Vec4 fourth = Vec4::UnitW();  ///< the axis that the camera does not see
    double field_of_view = 50;    ///< vertical [degrees]
    double aperture = 0;          ///< radius of the lens [m]; 0 is a pinhole
    double focus_distance = 0;    ///< along the forward axis [m]; 0 is that of look_at
    double shutter = 0;           ///< how long it is open, from the frame's time on [frames]
    double slice_thickness = 0;   ///< range along the fourth axis, about the slice [m]
    int slices = 1;               ///< 1: the range is averaged; more: so many slices side by side

    friend bool operator==(const CameraDescription&, const CameraDescription&) = default;
};

/// Which integrator makes the light: DirectIntegrator, Lambert and soft shadows in closed form; or
/// PathIntegrator, global illumination.
enum class Integrator { kDirect, kPath };
enum class Intersector { kTrace, kAnalytic };

/// See PixelFilter.
enum class FilterKind { kBox, kTriangle, kGaussian, kBlackmanHarris };

/// Of image files; all lossless.
enum class Compression { kNone, kRle, kZips, kZip, kPiz };

/// Half open, in pixels from the top left.
struct Crop {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct Channels {
    bool color = true, depth = true, normal = true, albedo = true, id = true, position = false;
    bool variance = false, samples = false;
    bool motion = false, zplanar = false, normal3 = false, light = false;
    bool cryptomatte = false;
};

/// Whether ghosts are a layer of the image only, or laid over previews and films too.
enum class GhostsIn { kLayer, kOver };

/// Width of previews where a scene does not say it, of pictures that are as wide or wider: what a
/// screen shows [pixels].
constexpr int kPreviewWidth = 1920;

/// Whether view rays that meet nothing bring the sky's light.
enum class Sky { kOpaque, kTransparent };

/// Mirrors and surfaces of glass that a path meets at most. Usual 128: clear polychora in an even
/// sky lose less than a hundredth of it (ClearGlass, path_glass_test.cpp). Fewer: they darken.
/// More: only light that is long caught costs more.
constexpr int kUsualSpecularBounces = 128;

struct Settings {
    int width = 1280, height = 720;
    double frames_per_second = 30;
    int samples = 16;
    Integrator integrator = Integrator::kDirect;
    int bounces = 4;                               ///< 0: emitted and direct light only
    int specular_bounces = kUsualSpecularBounces;  ///< beside them, by mirrors and glass
    double clamp_indirect = 0;  ///< of a sample, see PathIntegrator; 0: no bound [radiance]
    Intersector intersector = Intersector::kTrace;
    int max_steps = 200;
    /// What is farther along a ray of any kind is not met, but for lights [m]; 0: no limit.
    double max_distance = 0;
    int tile = 32;
    FilterKind filter = FilterKind::kBox;
    double filter_width = 1;  ///< of its support [pixels]
    double noise_target = 0;  ///< see sample_adaptively(); 0: every pixel has `samples`
    int max_samples = 16;     ///< with a noise target
    std::uint64_t seed = 0;   ///< of the samples' random numbers
    bool lock_noise = false;  ///< every frame has the random numbers of frame 0
    Channels channels;
    Compression compression = Compression::kZip;
    int preview_size = 0;  ///< width of previews [pixels]; 0: kPreviewWidth, or the picture's
    double exposure = 0;   ///< previews only [stops]
    /// Bodies that the slice misses by less than this are ghosts, see Ghosts [m]; 0: none.
    double ghost_depth = 0;
    GhostsIn ghosts = GhostsIn::kLayer;
    std::array<Color, 2> ghost_colors = kSideColors;  ///< on the negative and the positive side
    Sky sky = Sky::kOpaque;
    std::optional<Crop> crop;

    double ray_limit() const {
        return max_distance > 0 ? max_distance : std::numeric_limits<double>::infinity();
    }
    /// The pixels that are rendered: all, or the crop.
    Crop window() const { return crop.value_or(Crop{0, 0, width, height}); }
    bool has_ghosts() const { return ghost_depth > 0; }
    /// Any channel is asked for that LayerPixel holds.
    bool has_layers() const {
        const Channels& c = channels;
        return c.motion || c.zplanar || c.normal3 || c.light || has_ghosts();
    }
    /// Of a pixel. With a noise target a pixel has 8 at least: fewer tell nothing of its noise.
    int least_samples() const {
        return noise_target > 0 ? std::min(std::max(samples, 8), most_samples()) : samples;
    }
    int most_samples() const { return noise_target > 0 ? std::max(samples, max_samples) : samples; }
};

}  // namespace tesserae::render

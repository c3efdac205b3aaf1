// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "render/picture.hpp"
#include "render/scene/intersect.hpp"
#include "tests/content.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::render {

/// A picture that owns its parts. Every body has its own type, and by default material 0.
struct TestScene {
    Bodies bodies;
    std::vector<Appearance> appearance;
    std::vector<Material> materials = {Material{}};
    CameraDescription camera;
    Lights lights;
    Settings settings;
    std::optional<Bodies> closing;                 ///< poses when the shutter closes, after 1 s
    mutable std::vector<ShutterMoment> path = {};  ///< or what the shutter sees
    int frame = 0;
    std::optional<Neighbour> next = {}, last = {};
    std::optional<Mattes> mattes = {};

    /// Asks for Cryptomattes: bodies are "body 0", "body 1", ... and materials "material 0", ...
    void add_mattes();
    BodyId add(const Shape& shape, const Vec4& position, const Rotor& rotor = {},
               std::uint32_t material = 0);
    Picture picture() const {
        Picture picture = {bodies, appearance, materials, camera, lights, settings};
        picture.frame = frame;
        if (closing) path = {{1, *closing, camera}};
        picture.path = path;
        picture.next = next ? &*next : nullptr;
        picture.last = last ? &*last : nullptr;
        picture.mattes = mattes ? &*mattes : nullptr;
        return picture;
    }
};

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high);
Vec4 random_vector(Random& random, double half_side);
Vec4 random_direction(Random& random);
Rotor random_rotor(Random& random);

constexpr int kShapeKinds = 8;
/// kind 0 hypersphere, 1 hypercapsule, 2 hyperbox, 3 polychoron, 4 duoprism, 5 spherinder, 6
/// cubinder, 7 duocylinder, of about the given size.
Shape random_shape(Random& random, int kind, double size);

/// Bodies of all bounded shapes in turn, anywhere in a cube and any way round, of sizes `least` to
/// `largest`, small and large as often.
TestScene cloud(std::uint64_t seed, int count, double spread, double least, double largest);

/// A camera anywhere and any way round, `distance` from a point near the origin that it looks at.
CameraDescription random_camera(Random& random, double distance);

/// What every search for a hit promises, by trying one body after the other.
Hit nearest_of_all(const PlacedBodies& placed, const Ray& ray, const Settings& settings,
                   FrameStats& stats);

/// A folder of the test's own, removed at the end.
class Folder : public tesserae::testing::TemporaryFolder {
  public:
    Folder() : TemporaryFolder("render") {}
    std::size_t count() const;  ///< of the entries
};

using tesserae::testing::content;

/// An EXR file as OpenEXR's own reader sees it.
struct Image {
    int x0, y0, width, height;                         ///< data window
    std::map<std::string, std::vector<float>> planes;  ///< half and float channels
    std::vector<std::uint32_t> ids;                    ///< empty without objectid

    float at(const std::string& channel, int x, int y) const {
        return planes.at(channel)[index(x, y)];
    }
    std::uint32_t id(int x, int y) const { return ids[index(x, y)]; }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x - x0);
    }
};
Image read_exr(const std::filesystem::path& file);

/// render_frame in an arena of `threads`.
FrameStats render(const TestScene& scene, const std::filesystem::path& exr,
                  const std::filesystem::path& preview = {}, int threads = 2);
/// render_frame into a file of its own, read back.
Image picture_of(const TestScene& scene);

}  // namespace tesserae::render

// SPDX-License-Identifier: Apache-2.0
#include "tests/render/test_scene.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "render/frame.hpp"

namespace tesserae::render {

BodyId TestScene::add(const Shape& shape, const Vec4& position, const Rotor& rotor,
                      std::uint32_t material) {
    BodyType type;
    type.shape = shape;
    bodies.types.push_back(type);
    bodies.type.push_back(static_cast<std::uint32_t>(bodies.types.size() - 1));
    bodies.position.push_back(position);
    bodies.rotor.push_back(rotor);
    bodies.velocity.push_back(Vec4::Zero());
    bodies.angular_velocity.push_back({});
    appearance.push_back({material, true});
    return static_cast<BodyId>(bodies.size() - 1);
}

double uniform(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

Vec4 random_vector(Random& random, double half_side) {
    Vec4 v;
    for (int i = 0; i < 4; ++i) v[i] = uniform(random, -half_side, half_side);
    return v;
}

Vec4 random_direction(Random& random) {
    std::normal_distribution<double> normal;
    Vec4 v;
    for (int i = 0; i < 4; ++i) v[i] = normal(random);
    return v.normalized();
}

Rotor random_rotor(Random& random) {
    const auto angle = [&] { return uniform(random, -2, 2); };
    return exp(Bivector{angle(), angle(), angle(), angle(), angle(), angle()});
}

namespace {

template <class S>
Shape completed(S shape) {
    complete(shape);
    return shape;
}

Shape random_convex(Random& random, int kind, double size) {
    const auto side = [&] { return size * uniform(random, 0.3, 1.5); };
    if (kind == 3) {
        Polychoron shape;
        shape.regular = static_cast<RegularPolychoron>(uniform(random, 1, 5));
        shape.radius = side();
        return completed(shape);
    }
    if (kind == 4) {
        Duoprism shape;
        for (auto& sides : shape.polygons) sides = static_cast<std::int64_t>(uniform(random, 3, 6));
        for (double& radius : shape.radii) radius = side();
        return completed(shape);
    }
    if (kind == 5) {
        Spherinder shape;
        shape.radius = side();
        shape.height = 2 * side();
        return completed(shape);
    }
    if (kind == 6) {
        Cubinder shape;
        shape.radius = side();
        for (double& full : shape.size) full = 2 * side();
        return completed(shape);
    }
    Duocylinder shape;
    for (double& radius : shape.radii) radius = side();
    return completed(shape);
}

}  // namespace

Shape random_shape(Random& random, int kind, double size) {
    const auto side = [&] { return size * uniform(random, 0.3, 1.5); };
    if (kind == 0) return Hypersphere{side()};
    if (kind == 1) return Hypercapsule{0.5 * side(), 2 * side()};
    if (kind > 2) return random_convex(random, kind, size);
    // As g++ draws the arguments of a call: the last one first.
    Vec4 sides;
    for (int axis = 3; axis >= 0; --axis) sides[axis] = side();
    return Hyperbox{2 * sides};
}

TestScene cloud(std::uint64_t seed, int count, double spread, double least, double largest) {
    Random random(seed);
    TestScene scene;
    for (int i = 0; i < count; ++i) {
        const double size = std::exp(uniform(random, std::log(least), std::log(largest)));
        scene.add(random_shape(random, i % kShapeKinds, size), random_vector(random, spread),
                  random_rotor(random));
    }
    return scene;
}

CameraDescription random_camera(Random& random, double distance) {
    CameraDescription camera;
    camera.look_at = random_vector(random, 0.5);
    camera.position = camera.look_at + distance * random_direction(random);
    camera.up = random_direction(random);
    camera.fourth = random_direction(random);
    return camera;
}

Hit nearest_of_all(const PlacedBodies& placed, const Ray& ray, const Settings& settings,
                   FrameStats& stats) {
    Hit best;
    for (std::uint32_t b = 0; b < placed.bodies.size(); ++b) {
        if (b == ray.on) continue;
        const double t = hit_distance(placed, b, ray, settings, stats);
        if (t < best.distance) best = {t, b};
    }
    return best;
}

std::size_t Folder::count() const {
    std::size_t n = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path())) ++n;
    return n;
}

Image read_exr(const std::filesystem::path& path) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    Image image = {window.min.x,
                   window.min.y,
                   window.max.x - window.min.x + 1,
                   window.max.y - window.min.y + 1,
                   {},
                   {}};
    const std::size_t count =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    Imf::FrameBuffer buffer;
    const auto attach = [&](const char* name, Imf::PixelType type, void* data) {
        buffer.insert(name, Imf::Slice::Make(type, data, window.min, image.width, image.height));
    };
    const Imf::ChannelList& channels = file.header().channels();
    for (auto c = channels.begin(); c != channels.end(); ++c) {
        if (std::string(c.name()) == "objectid") {
            image.ids.resize(count);
            attach(c.name(), Imf::UINT, image.ids.data());
        } else {
            auto& plane = image.planes[c.name()];
            plane.resize(count);
            attach(c.name(), Imf::FLOAT, plane.data());
        }
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return image;
}

void TestScene::add_mattes() {
    settings.channels.cryptomatte = true;
    mattes.emplace();
    for (BodyId id = 0; id < bodies.size(); ++id)
        mattes->objects.push_back(matte_id("body " + std::to_string(id)));
    for (std::size_t i = 0; i < materials.size(); ++i)
        mattes->materials.push_back(matte_id("material " + std::to_string(i)));
}

FrameStats render(const TestScene& scene, const std::filesystem::path& exr,
                  const std::filesystem::path& preview, int threads) {
    const tbb::global_control more_than_cores(tbb::global_control::max_allowed_parallelism,
                                              static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    const std::atomic<bool> stop = false;
    FrameInfo info;
    info.scene_name = "test";
    return arena.execute([&] { return render_frame(scene.picture(), info, exr, preview, stop); });
}

Image picture_of(const TestScene& scene) {
    const Folder folder;
    render(scene, folder / "picture.exr");
    return read_exr(folder / "picture.exr");
}

}  // namespace tesserae::render

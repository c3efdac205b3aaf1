// SPDX-License-Identifier: Apache-2.0
#include "tests/scenes/properties/small_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/core/shape/oracle.hpp"

namespace tesserae::scenes::properties {
namespace {

/// Draws one scene. Lengths are parts of `size_`, times of a step, so that what happens in a few
/// steps does not depend on either.
class Drawing {
  public:
    explicit Drawing(std::uint64_t seed) : random_(seed) { scene_.seed = seed; }

    SmallScene scene() {
        size_ = random_.log_uniform(0.05, 5);
        draw_physics();
        const double spread = random_.uniform(0, 1);
        const int count = 2 + static_cast<int>(11 * spread * spread);
        arrangement_ = static_cast<Arrangement>(random_.uniform(0, 5));
        half_ = Vec4::Constant(0.8 * size_ * std::pow(count, 0.25));
        if (chance(0.7)) add_planes();
        for (int i = 0; i < count; ++i) add_body(i);
        return std::move(scene_);
    }

  private:
    enum class Arrangement { kCloud, kTurnedCloud, kCrowd, kStack, kTurnedStack };

    bool chance(double part) { return random_.uniform(0, 1) < part; }
    bool is_stack() const {
        return arrangement_ == Arrangement::kStack || arrangement_ == Arrangement::kTurnedStack;
    }

    void draw_physics() {
        PhysicsSettings& physics = scene_.physics;
        constexpr double kRates[] = {60, 120, 240, 480};
        constexpr int kIterations[] = {10, 10, 10, 4, 30};
        physics.steps_per_second = kRates[static_cast<int>(random_.uniform(0, 4))];
        physics.iterations = kIterations[static_cast<int>(random_.uniform(0, 5))];
        physics.substeps = chance(0.8) ? 1 : static_cast<int>(random_.uniform(2, 5));
        if (chance(0.1)) physics.tolerance = 0;
        if (chance(0.15)) physics.integrator = RotationIntegrator::kEuler;
        physics.sleeping = chance(0.2);
        step_ = 1 / physics.steps_per_second;
        const double g = chance(0.25) ? 0 : random_.log_uniform(1, 20) * std::min(1.0, size_);
        physics.gravity = {0, -g, 0, 0};
        if (chance(0.2)) physics.gravity = g * random_.direction();
        rolling_friction_ = chance(0.15) ? 0.02 * size_ : 0;
        scene_.steps = static_cast<int>(random_.log_uniform(8, 60));
        physics.duration = scene_.steps * step_;
    }

    void add_planes() {
        Hyperplane ground;
        ground.offset = -half_[1] - (is_stack() ? 0 : random_.uniform(0, 0.5) * size_);
        if (chance(0.3)) ground.normal += 0.3 * random_.direction();
        add_plane(ground);
        while (chance(0.2)) {
            Hyperplane wall;
            wall.normal = random_.direction();
            wall.offset = -half_[0] - random_.uniform(0, 1) * size_;
            add_plane(wall);
        }
    }
    void add_plane(Hyperplane plane) {
        BodyTable table;
        table.shape = plane;
        complete(plane);
        table.type.shape = plane;
        set_surface(table.type);
        add(std::move(table));
    }

    void set_surface(BodyType& type) {
        type.friction = chance(0.25) ? 0 : chance(0.05) ? 3 : random_.uniform(0, 1);
        type.restitution = chance(0.5) ? 0 : chance(0.1) ? 1 : random_.uniform(0, 1);
        type.rolling_friction = chance(0.7) ? rolling_friction_ : 0;
    }

    void add(BodyTable table) {
        table.name = fmt::format("body-{}", scene_.tables.size());
        scene_.tables.push_back(std::move(table));
    }

    void add_body(int number) {
        BodyTable table;
        const bool again = number > 0 && chance(0.3) && is_bounded(scene_.tables.back().shape);
        if (again) {
            table.shape = scene_.tables.back().shape;
            table.type = scene_.tables.back().type;
        } else {
            table.type.shape = drawn_shape();
            table.shape = table.type.shape;
            const double content =
                std::visit([](const auto& s) { return volume(s); }, table.type.shape);
            table.type.mass =
                1000 * content *
                (chance(0.1) ? random_.log_uniform(1e-3, 1e3) : random_.log_uniform(0.3, 3));
            set_surface(table.type);
            table.type.fixed_position = chance(0.1);
            table.type.fixed_rotation = chance(table.type.fixed_position ? 0.7 : 0.03);
        }
        const bool straight =
            arrangement_ == Arrangement::kCloud ? chance(0.3) : arrangement_ == Arrangement::kStack;
        if (!straight) table.rotation.front() = random_bivector(180);
        is_stack() ? put_on_stack(table) : put_into_cloud(table);
        set_motion(table);
        add(std::move(table));
    }

    Bivector random_bivector(double most) {
        const auto one = [&] { return random_.uniform(-most, most); };
        Bivector b;
        b.xy = one(), b.xz = one(), b.xw = one(), b.yz = one(), b.yw = one(), b.zw = one();
        return b;
    }

    double length() { return size_ * random_.log_uniform(0.5, 1.6); }
    /// One of a thin shape.
    double width() { return chance(0.1) ? 0.03 * size_ : 0.5 * length(); }

    Shape drawn_shape() {
        const auto completed = [](auto shape) -> Shape {
            if constexpr (requires { complete(shape); }) complete(shape);
            return shape;
        };
        switch (static_cast<int>(random_.uniform(0, 9))) {
            case 0:
                return completed(Hypersphere{0.5 * length()});
            case 1:
                return completed(Hypercapsule{0.5 * width(), chance(0.1) ? 0 : length()});
            case 2:
                return completed(Hyperbox{{length(), 2 * width(), length(), length()}});
            case 3:
                return completed(drawn_regular());
            case 4:
                return drawn_hull();
            case 5: {
                Duoprism shape;
                for (auto& sides : shape.polygons)
                    sides = static_cast<std::int64_t>(random_.uniform(3, 7));
                shape.radii = {0.6 * length(), width()};
                return completed(shape);
            }
            case 6: {
                Spherinder shape;
                shape.radius = 0.5 * length(), shape.height = 2 * width();
                return completed(shape);
            }
            case 7: {
                Cubinder shape;
                shape.radius = 0.5 * length(), shape.size = {length(), 2 * width()};
                return completed(shape);
            }
            default: {
                Duocylinder shape;
                shape.radii = {0.5 * length(), width()};
                return completed(shape);
            }
        }
    }
    Polychoron drawn_regular() {
        Polychoron shape;
        shape.regular = static_cast<RegularPolychoron>(random_.uniform(1, chance(0.03) ? 7 : 5));
        shape.radius = 0.7 * length();
        return shape;
    }
    /// Of points that are not all near one plane.
    Shape drawn_hull() {
        for (;;) {
            Polychoron shape;
            shape.regular = RegularPolychoron::kNone;
            const Vec4 half = 0.7 * Vec4(length(), 2 * width(), length(), length());
            shape.vertices.resize(static_cast<std::size_t>(random_.uniform(6, 15)));
            for (Vec4& vertex : shape.vertices) vertex = random_.in_box(half);
            complete(shape);
            if (volume(shape) > 1e-4 * std::pow(bounding_radius(shape), 4)) return shape;
        }
    }

    /// Apart from what is there already if that can be had, else anywhere.
    void put_into_cloud(BodyTable& table) {
        for (int attempt = 0; attempt < 30; ++attempt) {
            table.position = random_.in_box(half_);
            if (arrangement_ == Arrangement::kCrowd || is_free(table)) return;
        }
    }
    bool is_free(const BodyTable& table) const {
        const double radius = bounding_radius(table.type.shape);
        return std::all_of(scene_.tables.begin(), scene_.tables.end(), [&](const BodyTable& other) {
            if (!is_bounded(other.shape)) {
                const auto& plane = std::get<Hyperplane>(other.type.shape);
                return signed_distance(plane, table.position) > radius;
            }
            const double apart = (other.position - table.position).norm();
            return apart > 0.7 * (radius + bounding_radius(other.type.shape));
        });
    }
    /// Upon the last one, along y.
    void put_on_stack(BodyTable& table) {
        const Rotor rotor = rotor_of(table.rotation.front());
        const double half = std::visit(
            [&](const auto& s) { return half_extents(s, to_matrix(rotor))[1]; }, table.type.shape);
        if (top_ == 0) top_ = -half_[1];
        table.position = 0.05 * random_.in_box(half_);
        table.position[1] = top_ + half;
        top_ += 2 * half + (chance(0.5) ? 0 : random_.uniform(-0.001, 0.01) * size_);
    }

    void set_motion(BodyTable& table) {
        const bool is_fixed = table.type.fixed_position && table.type.fixed_rotation;
        if (is_fixed && chance(0.6)) return;
        if (is_stack() && chance(0.7)) return;
        // Towards the middle, in some steps, or right through it.
        const double speed = size_ / step_ / random_.log_uniform(10, 300);
        table.velocity = speed * random_.direction();
        if (table.position.norm() > 0 && chance(0.6))
            table.velocity -= speed * table.position.normalized();
        if (chance(0.03)) table.velocity *= 100;
        if (chance(0.7)) table.angular_velocity = random_bivector(random_.log_uniform(0.1, 20));
        if (chance(0.03)) table.angular_velocity = 30 * table.angular_velocity;
    }

    static Rotor rotor_of(const Bivector& degrees) {
        return exp(-0.5 * std::numbers::pi / 180 * degrees);
    }

    RandomGeometry random_;
    SmallScene scene_;
    Arrangement arrangement_ = Arrangement::kCloud;
    double size_ = 1;  ///< [m]
    double step_ = 1;  ///< [s]
    double top_ = 0;   ///< of a stack [m]
    double rolling_friction_ = 0;
    Vec4 half_;  ///< of the box in which bodies start [m]
};

}  // namespace

SmallScene draw_small_scene(std::uint64_t seed) { return Drawing(seed).scene(); }

std::string text_of(const SmallScene& scene) {
    const MaterialNumbers none;
    EffectiveWriter out;
    const WriteKeys write{out};
    out.table("[physics]");
    physics_keys(scene.physics, write);
    for (const BodyTable& table : scene.tables) {
        out.table("[[body]]");
        name_keys(table, write);
        if (is_bounded(table.shape)) placing_keys(table, write);
        shape_keys(table, write);
        if (is_bounded(table.shape)) mass_keys(table, write);
        surface_keys(table, write, none);
    }
    return out.take_text();
}

Bodies bodies_of(const SmallScene& scene) {
    Bodies bodies;
    for (const BodyTable& table : scene.tables) {
        bodies.type.push_back(static_cast<std::uint32_t>(bodies.types.size()));
        bodies.types.push_back(table.type);
        bodies.position.push_back(table.position);
        bodies.rotor.push_back(exp(-0.5 * std::numbers::pi / 180 * table.rotation.front()));
        bodies.velocity.push_back(table.velocity);
        bodies.angular_velocity.push_back(table.angular_velocity);
    }
    return bodies;
}

std::size_t bounded_count(const SmallScene& scene) {
    return static_cast<std::size_t>(
        std::count_if(scene.tables.begin(), scene.tables.end(),
                      [](const BodyTable& table) { return is_bounded(table.shape); }));
}

}  // namespace tesserae::scenes::properties

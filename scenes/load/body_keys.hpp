#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/dynamics/state/bodies.hpp"
#include "core/error.hpp"
#include "scenes/load/lattice.hpp"
#include "scenes/load/load_parts.hpp"
#include "scenes/load/nearest_name.hpp"
#include "scenes/load/rules.hpp"

// The keys of the tables that make bodies and their motion, one list a table (see rules.hpp). A
// list in parts is written in another order than it is read.
namespace tesserae::scenes {

constexpr std::uint64_t kMaxBodies = 10'000'000;
/// Masses [kg] whose inertia and inverse inertia stay inside the range of double for all sizes.
constexpr double kLeastMass = 1e-60, kLargestMass = 1e60;

// In the order of the enumerations in core/dynamics/state/settings.hpp.
constexpr std::string_view kSolvers[] = {"impulse", "soft"};
constexpr std::string_view kRotationIntegrators[] = {"euler", "midpoint"};
constexpr Flag<BodyType> kFixed[] = {{"position", &BodyType::fixed_position},
                                     {"rotation", &BodyType::fixed_rotation}};

/// A name that frames can have.
struct FileName {
    static constexpr const char* kExpected =
        "expected 1 to 64 of A-Z a-z 0-9 . _ -, not starting with a dot";
    static bool accepts(std::string_view name) {
        return !name.empty() && name.size() <= 64 && name.front() != '.' &&
               std::all_of(name.begin(), name.end(), [](char c) {
                   return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                          (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
               });
    }
    void read(TableReader& reader, const char* key, std::string& name) const {
        if (reader.read(key, name) && !accepts(name)) reader.fail(key, kExpected);
    }
};

/// [scene]
void scene_keys(auto& self, const auto& visit) { visit("name", self.name, FileName{}); }

/// [physics]
void physics_keys(auto& self, const auto& visit) {
    visit("gravity", self.gravity, Rule::kFinite);
    visit("duration", self.duration, Rule::kNonNegative);
    visit("steps_per_second", self.steps_per_second, Rule::kPositive);
    visit("iterations", self.iterations, IntegerRange{1, 10000});
    visit("tolerance", self.tolerance,
          RealOrUnwritten{interval_of(Rule::kNonNegative), PhysicsSettings{}.tolerance});
    visit("substeps", self.substeps, IntegerRange{1, 1000});
    visit("solver", self.solver, Names{kSolvers});
    visit("integrator", self.integrator, Names{kRotationIntegrators});
    visit("sleeping", self.sleeping);
    visit("seed", self.seed, IntegerRange{});
}

/// A [[body]] or [[lattice]] table, checked.
struct BodyTable {
    std::string name;
    Shape shape;  ///< as written: before complete()
    BodyType type;
    render::Appearance appearance;
    std::string material;  ///< empty: none was named
    Vec4 position = Vec4::Zero(), velocity = Vec4::Zero();
    Bivector rotation, angular_velocity;  ///< [degrees], [rad/s]
    double density = 1000;                ///< [kg/m^4]
    bool has_mass = false;
    std::optional<Lattice> lattice;
    std::uint64_t count = 1;
};

/// A shape's name, and the parameters that its room lists.
struct AnyShape {
    void read(TableReader& reader, const char* key, Shape& shape) const;
    void write(EffectiveWriter& out, const char* key, const Shape& shape) const;
};
struct MassOfBody {
    void read(TableReader& reader, const char* key, BodyTable& body) const {
        body.has_mass = reader.read(key, body.type.mass, Interval{kLeastMass, kLargestMass});
    }
    void write(EffectiveWriter& out, const char* key, const BodyTable& body) const {
        out.key(key, body.type.mass);
    }
};
/// Instead of a mass; the mass is written.
struct DensityOfBody {
    void read(TableReader& reader, const char* key, BodyTable& body) const {
        if (reader.read(key, body.density, Rule::kPositive) && body.has_mass)
            reader.fail(key, "there is a mass too; expected only one of them");
    }
    void write(EffectiveWriter&, const char*, const BodyTable&) const {}
};
struct MaterialName {
    const MaterialNumbers& materials;

    void read(TableReader& reader, const char* key, std::string& name) const {
        if (!reader.read(key, name) || materials.contains(name)) return;
        std::vector<std::string_view> names;
        for (const auto& [known, number] : materials) names.push_back(known);
        std::sort(names.begin(), names.end());
        reader.fail(key, "no material is called that" + did_you_mean(name, names));
    }
    void write(EffectiveWriter& out, const char* key, const std::string& name) const {
        if (!name.empty()) out.key(key, name);
    }
};

/// [[body]] and [[lattice]]: what they are called and their shape
void name_keys(auto& self, const auto& visit) { visit("name", self.name); }
void shape_keys(auto& self, const auto& visit) { visit("shape", self.shape, AnyShape{}); }
/// [[body]] and [[lattice]], if bounded: where they are
void placing_keys(auto& self, const auto& visit) {
    visit("position", self.position, Rule::kFinite);
    visit("rotation", self.rotation);
    visit("velocity", self.velocity, Rule::kFinite);
    visit("angular_velocity", self.angular_velocity);
}
/// [[body]] and [[lattice]], if bounded: how heavy they are
void mass_keys(auto& self, const auto& visit) {
    visit("mass", self, MassOfBody{});
    visit("density", self, DensityOfBody{});
}
/// [[body]] and [[lattice]]: how they touch and look
void surface_keys(auto& self, const auto& visit, const MaterialNumbers& materials) {
    visit("friction", self.type.friction, Rule::kNonNegative);
    visit("rolling_friction", self.type.rolling_friction,
          RealOrUnwritten{interval_of(Rule::kNonNegative)});
    visit("restitution", self.type.restitution, Interval{0, 1});
    visit("fixed", self.type, Flags<BodyType>{kFixed});
    visit("material", self.material, MaterialName{materials});
    visit("visible", self.appearance.visible);
}

struct LatticeCount {
    std::uint64_t most;  ///< bodies that the scene may still have

    void read(TableReader& reader, const char* key, std::array<std::uint32_t, 4>& count) const {
        std::array<std::int64_t, 4> given = {};
        reader.read(key, given, {1});
        std::uint64_t bodies = 1;
        for (std::size_t axis = 0; axis < 4; ++axis) {
            const auto n = static_cast<std::uint64_t>(given[axis]);
            if (n > most / bodies)
                reader.fail(
                    key, fmt::format("too many bodies; a scene has at most {} in all", kMaxBodies));
            bodies *= n;
            count[axis] = static_cast<std::uint32_t>(n);
        }
    }
    void write(EffectiveWriter& out, const char* key, const std::array<std::uint32_t, 4>& c) const {
        out.line(key, fmt::format("[{}, {}, {}, {}]", c[0], c[1], c[2], c[3]));
    }
};
/// One distance for all axes, or four.
struct Spacing {
    void read(TableReader& reader, const char* key, Vec4& spacing) const {
        if (reader.is_array(key)) {
            reader.read(key, spacing, Rule::kNonNegative);
        } else {
            double same = 0;
            reader.read(key, same, Rule::kNonNegative);
            spacing.setConstant(same);
        }
    }
};

/// [[lattice]]: what a [[body]] has not
void lattice_keys(auto& self, const auto& visit, std::uint64_t most_bodies) {
    visit("count", self.count, Required{"expected four integers >= 1", LatticeCount{most_bodies}});
    visit("spacing", self.spacing, Required{"expected a distance or four, >= 0", Spacing{}});
    visit("jitter", self.jitter, Rule::kNonNegative);
    visit("seed", self.seed, IntegerRange{});
}

}  // namespace tesserae::scenes

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/error.hpp"
#include "scenes/load/lattice.hpp"
#include "scenes/load/load_parts.hpp"
#include "scenes/load/nearest_name.hpp"
#include "scenes/load/rules.hpp"

// The keys of the tables that make bodies and their motion, one list a table (see rules.hpp). A
// list in parts is written in another order than it is read.
namespace tesserae::scenes {

constexpr std::uint64_t kMaxBodies = 10'000'000;

// In the order of the enumerations in core/dynamics/step/settings.hpp.
constexpr std::string_view kRotationIntegrators[] = {"euler", "midpoint"};
constexpr Flag<BodyType> kFixed[] = {{"position", &BodyType::fixed_position},
                                     {"rotation", &BodyType::fixed_rotation}};

/// A name that frames can have.
struct FileName {
    static constexpr const char* kAllowed = "1 to 64 of A-Z a-z 0-9 . _ -";

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

/// There is one way to solve contacts. Scenes may still name it; it is not written.
struct OnlySolver {
    static constexpr const char* kAllowed = "`\"impulse\"`";

    void read(TableReader& reader, const char* key, std::string& name) const {
        if (!reader.read(key, name) || name == "impulse") return;
        reader.fail(key, name == "soft" ? "this solver was removed; remove the key: what rests "
                                          "stands as still or stiller without it"
                                        : "expected \"impulse\", the only solver");
    }
    void write(EffectiveWriter&, const char*, const std::string&) const {}
};

/// [scene]
void scene_keys(auto& self, const auto& visit) {
    visit({"name", "", "The frames' files begin with this name.", "the file's name"}, self.name,
          FileName{});
}

/// [physics]
void physics_keys(auto& self, const auto& visit) {
    visit({"gravity", "m/s^2", "All that may move is accelerated by this."}, self.gravity,
          Rule::kFinite);
    visit({"duration", "s", "The motion, and so the film, lasts this long."}, self.duration,
          Rule::kNonNegative);
    visit({"steps_per_second", "1/s",
           "The motion has so many time steps a second; more cost time and make it more accurate."},
          self.steps_per_second, Rule::kPositive);
    visit(
        {"iterations", "",
         "A solve of a group of touching bodies takes at most so many sweeps; large groups take a "
         "part of them."},
        self.iterations, IntegerRange{1, 10000});
    visit(
        {"tolerance", "m/s",
         "A solve ends once a sweep has changed no velocity by more than this; 0 makes every solve "
         "take `iterations` sweeps."},
        self.tolerance,
        RealOrUnwritten{interval_of(Rule::kNonNegative), PhysicsSettings{}.tolerance});
    visit({"substeps", "",
           "A step is solved in so many parts; pairs that touch are looked for once a step."},
          self.substeps, IntegerRange{1, 1000});
    std::string solver = "impulse";
    visit({"solver", "", "There is one solver, which scenes need not name."}, solver, OnlySolver{});
    visit({"integrator", "",
           "A body turns freely with its angular momentum kept (euler), or its energy too "
           "(midpoint)."},
          self.integrator, Names{kRotationIntegrators});
    visit({"sleeping", "",
           "Groups of bodies at rest cost next to nothing until something touches them."},
          self.sleeping);
    visit({"seed", "", "This number changes no motion; it only counts for the hash of the scene."},
          self.seed, IntegerRange{});
}

/// A [[body]] or [[lattice]] table, checked.
struct BodyTable {
    std::string name;
    Shape shape;  ///< as written: before complete()
    BodyType type;
    render::Appearance appearance;
    std::string material;  ///< empty: none was named
    std::string group;
    std::optional<std::vector<std::string>> collides_with;
    Vec4 position = Vec4::Zero(), velocity = Vec4::Zero();
    std::vector<Bivector> rotation{1};  ///< turns, one after the other [degrees]
    Bivector angular_velocity;          ///< [rad/s]
    double density = 1000;              ///< [kg/m^4]
    bool has_mass = false;
    std::optional<Lattice> lattice;
    std::uint64_t count = 1;
};

/// How a body is turned: one turn in several planes at once, or several turns one after the other.
struct Turns {
    static constexpr const char* kType = "planes, or an array of them";
    static constexpr const char* kAllowed = "";

    void read(TableReader& reader, const char* key, std::vector<Bivector>& turns) const {
        reader.read(key, turns,
                    "{ xy = 30, zw = 15 }, in degrees, or an array of them: turns one after the "
                    "other");
    }
    void write(EffectiveWriter& out, const char* key, const std::vector<Bivector>& turns) const {
        std::string text;
        for (const Bivector& turn : turns) text += (text.empty() ? "" : ", ") + toml_text(turn);
        out.line(key, turns.size() == 1 ? text : "[" + text + "]");
    }
};
/// Returns the rotor of turns about the world's axes, one after the other [degrees].
Rotor rotor_of(std::span<const Bivector> turns);

struct TurningPlanes {
    static constexpr const char* kAllowed = "";

    void read(TableReader& reader, const char* key, Bivector& value) const {
        reader.read(key, value, "{ xw = 2.0 }, in rad/s");
    }
    void write(EffectiveWriter& out, const char* key, const Bivector& value) const {
        out.key(key, value);
    }
};

/// A shape's name, and the parameters that its room lists.
struct AnyShape {
    static constexpr const char* kType = "string";
    static constexpr const char* kAllowed = "see below";

    void read(TableReader& reader, const char* key, Shape& shape) const;
    void write(EffectiveWriter& out, const char* key, const Shape& shape) const;
};
struct MassOfBody {
    static constexpr const char* kType = "real";
    static constexpr const char* kAllowed = "1e-60 to 1e60";

    void read(TableReader& reader, const char* key, BodyTable& body) const {
        body.has_mass = reader.read(key, body.type.mass, Interval{kLeastMass, kLargestMass});
    }
    void write(EffectiveWriter& out, const char* key, const BodyTable& body) const {
        out.key(key, body.type.mass);
    }
};
/// Instead of a mass; the mass is written.
struct DensityOfBody {
    static constexpr const char* kType = "real";
    static constexpr const char* kAllowed = "> 0";

    void read(TableReader& reader, const char* key, BodyTable& body) const {
        if (reader.read(key, body.density, Rule::kPositive) && body.has_mass)
            reader.fail(key, "there is a mass too; expected only one of them");
    }
    void write(EffectiveWriter&, const char*, const BodyTable&) const {}
};
struct MaterialName {
    static constexpr const char* kAllowed = "name of a [[material]]";

    const MaterialNumbers& materials;

    void read(TableReader& reader, const char* key, std::string& name) const {
        if (!reader.read(key, name) || materials.contains(name) || !materials.is_complete) return;
        std::vector<std::string_view> names;
        for (const auto& [known, number] : materials) names.push_back(known);
        std::sort(names.begin(), names.end());
        reader.fail(key, "no material is called that" + did_you_mean(name, names));
    }
    void write(EffectiveWriter& out, const char* key, const std::string& name) const {
        if (!name.empty()) out.key(key, name);
    }
};

struct GroupName {
    static constexpr const char* kAllowed = "any name";

    void read(TableReader& reader, const char* key, std::string& name) const {
        reader.read(key, name);
    }
    void write(EffectiveWriter& out, const char* key, const std::string& name) const {
        if (!name.empty()) out.key(key, name);
    }
};
struct GroupNames {
    static constexpr const char* kType = "array of strings";
    static constexpr const char* kAllowed = "names of groups; \"\" is that of bodies without one";

    void read(TableReader& reader, const char* key, std::vector<std::string>& names) const {
        reader.read(key, names, {});
    }
    void write(EffectiveWriter& out, const char* key, std::vector<std::string> names) const {
        std::sort(names.begin(), names.end());
        std::string text;
        for (const std::string_view name : names)
            text += (text.empty() ? "" : ", ") + toml_text(name);
        out.line(key, "[" + text + "]");
    }
};

/// [[body]] and [[lattice]]: what they are called and their shape
void name_keys(auto& self, const auto& visit) {
    visit({"name", "",
           "Reports, meshes, mattes and --set call the body by this; no two have the same.",
           "body- and its number"},
          self.name);
}
void shape_keys(auto& self, const auto& visit) {
    visit({"shape", "", "The body has this shape; each shape has sizes of its own.", "required"},
          self.shape, AnyShape{});
}
/// [[body]] and [[lattice]], if bounded: where they are
void placing_keys(auto& self, const auto& visit) {
    visit({"position", "m", "The centre of mass, or a lattice's centre, is here at time 0."},
          self.position, Rule::kFinite);
    visit({"rotation", "deg",
           "The body is turned by these angles at time 0; a table is one turn in all its planes, "
           "an array of tables is one turn after the other; positive xy turns x toward y."},
          self.rotation, Turns{});
    visit({"velocity", "m/s", "The centre of mass moves so at time 0."}, self.velocity,
          Rule::kFinite);
    visit({"angular_velocity", "rad/s",
           "The body turns so fast in the planes of the world's axes at time 0."},
          self.angular_velocity, TurningPlanes{});
}
/// [[body]] and [[lattice]], if bounded: how heavy they are
void mass_keys(auto& self, const auto& visit) {
    visit({"mass", "kg", "The body has this mass; it stands instead of a density.",
           "density times content"},
          self, MassOfBody{});
    visit({"density", "kg/m^4",
           "A unit of the body's four-dimensional content has this mass; it stands instead of a "
           "mass.",
           "`1000.0`"},
          self, DensityOfBody{});
}
/// [[body]] and [[lattice]], if bounded: what else than contacts changes their motion
void moving_keys(auto& self, const auto& visit) {
    visit({"gravity_scale", "", "This part of gravity acts on the body; -1 makes it rise."},
          self.type.gravity_scale, RealOrUnwritten{interval_of(Rule::kFinite), 1});
    visit({"damping", "1/s",
           "The body loses this part of its velocity and of its angular velocity a second, as if "
           "in a viscous medium: alone it slows down as exp(-damping t)."},
          self.type.damping, RealOrUnwritten{interval_of(Rule::kNonNegative)});
}
/// [[body]] and [[lattice]]: how they touch and look
void surface_keys(auto& self, const auto& visit, const MaterialNumbers& materials) {
    visit({"friction", "",
           "The body resists sliding this strongly; two that touch have the geometric mean of "
           "theirs."},
          self.type.friction, Rule::kNonNegative);
    visit({"rolling_friction", "m",
           "The body resists rolling and twisting this strongly; two that touch have the larger of "
           "theirs."},
          self.type.rolling_friction, RealOrUnwritten{interval_of(Rule::kNonNegative)});
    visit({"restitution", "",
           "The body bounces back at this part of its speed; two that touch have the larger of "
           "theirs."},
          self.type.restitution, Interval{0, 1});
    visit({"fixed", "",
           "Contacts cannot change what is named here; with a velocity the body moves at it, and "
           "nothing stops it."},
          self.type, Flags<BodyType>{kFixed});
    visit({"group", "", "The body is of the group of this name; see collides_with."}, self.group,
          GroupName{});
    visit({"collides_with", "",
           "The body has contacts with bodies of these groups only, and only if they have contacts "
           "with its own.",
           "all groups"},
          self.collides_with, GroupNames{});
    visit({"material", "", "The body looks as the material of this name says.", "a grey of 0.8"},
          self.material, MaterialName{materials});
    visit({"visible", "", "The body is seen and casts shadows."}, self.appearance.visible);
    visit({"hue_jitter", "",
           "The hue of each body is turned at random by up to half this part of the colour circle "
           "to either side."},
          self.appearance.hue_jitter, RealOrUnwritten{Interval{0, 1}});
}

struct LatticeCount {
    static constexpr const char* kType = "4 integers";
    static constexpr const char* kAllowed = ">= 1 each, at most 10^7 bodies in all";

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
    static constexpr const char* kType = "real or 4 reals";
    static constexpr const char* kAllowed = ">= 0";

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
    visit({"count", "", "The grid has so many bodies along x, y, z and w."}, self.count,
          Required{"expected four integers >= 1", LatticeCount{most_bodies}});
    visit({"spacing", "m",
           "Neighbouring centres are this far apart: one number for all four axes, or four."},
          self.spacing, Required{"expected a distance or four, >= 0", Spacing{}});
    visit({"jitter", "m", "Each body is moved at random along each axis by at most this."},
          self.jitter, Rule::kNonNegative);
    visit({"seed", "", "This number chooses the random numbers of jitter."}, self.seed,
          IntegerRange{});
}

}  // namespace tesserae::scenes

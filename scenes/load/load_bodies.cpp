#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <unordered_set>

#include "core/error.hpp"
#include "scenes/load/hash.hpp"
#include "scenes/load/lattice.hpp"
#include "scenes/load/load_parts.hpp"
#include "scenes/load/nearest_name.hpp"
#include "scenes/process/memory.hpp"

namespace tesserae::scenes {
namespace {

constexpr std::uint64_t kMaxBodies = 10'000'000;
constexpr std::size_t kMaxNameBytes = 256;
/// Bodies' states, and for a [[body]] of its own also its name and canonical text.
constexpr std::uint64_t kBytesPerBody = 250;
constexpr std::uint64_t kBytesPerTable = 1000;
/// Masses [kg] whose inertia and inverse inertia stay inside the range of double for all sizes.
constexpr double kLeastMass = 1e-60, kLargestMass = 1e60;

constexpr std::size_t kShapes = std::variant_size_v<Shape>;

template <std::size_t... I>
constexpr std::array<std::string_view, kShapes> shape_names(std::index_sequence<I...>) {
    return {std::variant_alternative_t<I, Shape>::kName...};
}
constexpr auto kShapeNames = shape_names(std::make_index_sequence<kShapes>());

template <std::size_t... I>
Shape shape_of_kind(std::size_t kind, std::index_sequence<I...>) {
    Shape shape;
    ((kind == I ? void(shape.emplace<I>()) : void()), ...);
    return shape;
}

const char* expected_of(Rule rule) {
    if (rule == Rule::kPositive) return "expected a size > 0";
    if (rule == Rule::kNonNegative) return "expected a size >= 0";
    return "expected a direction, four numbers";
}

/// A [[body]] or [[lattice]] table, checked.
struct BodyTable {
    std::string name;
    BodyType type;
    Shape shape_as_written;  ///< before complete()
    render::Appearance appearance;
    std::string material;
    Vec4 position = Vec4::Zero(), velocity = Vec4::Zero();
    Bivector rotation, angular_velocity;  ///< [degrees], [rad/s]
    double density = 1000;                ///< [kg/m^4]
    bool has_mass = false;
    std::optional<Lattice> lattice;
    std::uint64_t count = 1;
};

void read_shape(TableReader& reader, Shape& shape) {
    std::string expected = "expected one of";
    for (std::string_view name : kShapeNames) expected += fmt::format(" \"{}\"", name);
    std::size_t kind = 0;
    if (!reader.require("shape", expected)) {
        // Any shape's keys may be there: a misspelt "shape" is what must be found.
        for (std::size_t i = 0; i < kShapes; ++i)
            std::visit(
                [&](auto s) {
                    s.parameters(s, [&](const char* key, auto&, Rule) { reader.has(key); });
                },
                shape_of_kind(i, std::make_index_sequence<kShapes>()));
        return;
    }
    reader.read("shape", kind, kShapeNames);
    shape = shape_of_kind(kind, std::make_index_sequence<kShapes>());
    std::visit(
        [&](auto& s) {
            s.parameters(s, [&](const char* key, auto& member, Rule rule) {
                // A plain number, such as a hyperplane's offset, is 0 where it is not given.
                if (rule != Rule::kFinite) reader.require(key, expected_of(rule));
                reader.read(key, member, rule);
            });
        },
        shape);
}

void read_motion(TableReader& reader, BodyTable& body) {
    reader.read("position", body.position, Rule::kFinite);
    reader.read("rotation", body.rotation);
    reader.read("velocity", body.velocity, Rule::kFinite);
    reader.read("angular_velocity", body.angular_velocity);
    body.has_mass = reader.read("mass", body.type.mass, Interval{kLeastMass, kLargestMass});
    if (reader.read("density", body.density, Rule::kPositive) && body.has_mass)
        reader.fail("density", "there is a mass too; expected only one of them");
}

/// A body without bounds never moves.
void refuse_motion(TableReader& reader, const Shape& shape) {
    for (const char* key :
         {"position", "rotation", "velocity", "angular_velocity", "mass", "density"})
        if (reader.has(key))
            reader.fail(key, fmt::format("a {} never moves and has no {}", name_of(shape), key));
}

void read_surface(TableReader& reader, const MaterialNumbers& materials, BodyTable& body) {
    reader.read("friction", body.type.friction, Rule::kNonNegative);
    reader.read("restitution", body.type.restitution, Interval{0, 1});
    constexpr std::string_view kFixed[] = {"position", "rotation"};
    std::vector<std::string> fixed;
    reader.read("fixed", fixed, kFixed);
    for (const std::string& part : fixed)
        (part == kFixed[0] ? body.type.fixed_position : body.type.fixed_rotation) = true;
    if (reader.read("material", body.material)) {
        const auto found = materials.find(body.material);
        if (found == materials.end()) {
            std::vector<std::string_view> names;
            for (const auto& [name, number] : materials) names.push_back(name);
            std::sort(names.begin(), names.end());
            reader.fail("material",
                        "no material is called that" + did_you_mean(body.material, names));
        }
        body.appearance.material = found->second;
    }
    reader.read("visible", body.appearance.visible);
}

/// @param room   bodies that the scene may still have
void read_lattice(TableReader& reader, std::uint64_t room, BodyTable& body) {
    Lattice lattice;
    std::array<std::int64_t, 4> count = {1, 1, 1, 1};
    if (reader.require("count", "expected four integers >= 1"))
        reader.read("count", count.data(), count.size(), 1,
                    std::numeric_limits<std::int64_t>::max());
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const auto n = static_cast<std::uint64_t>(count[axis]);
        if (n > room / body.count)
            reader.fail("count",
                        fmt::format("too many bodies; a scene has at most {} in all", kMaxBodies));
        body.count *= n;
        lattice.count[axis] = static_cast<std::uint32_t>(n);
    }
    if (reader.require("spacing", "expected a distance or four, >= 0")) {
        double same = 0;
        if (reader.is_array("spacing")) {
            reader.read("spacing", lattice.spacing, Rule::kNonNegative);
        } else {
            reader.read("spacing", same, Rule::kNonNegative);
            lattice.spacing.setConstant(same);
        }
    }
    reader.read("jitter", lattice.jitter, Rule::kNonNegative);
    auto seed = static_cast<std::int64_t>(lattice.seed);
    reader.read("seed", seed, 0, std::numeric_limits<std::int64_t>::max());
    lattice.seed = static_cast<std::uint64_t>(seed);
    body.lattice = lattice;
}

void set_mass(TableReader& reader, BodyTable& body) {
    if (body.has_mass) return;
    const double content = std::visit([](const auto& s) { return volume(s); }, body.type.shape);
    body.type.mass = body.density * content;
    if (body.type.mass >= kLeastMass && body.type.mass <= kLargestMass) return;
    std::string sizes;
    std::visit(
        [&](auto& s) {
            s.parameters(s, [&](const char* key, const auto& value, Rule) {
                sizes += fmt::format("{} = {}, ", key, toml_text(value));
            });
        },
        body.shape_as_written);
    const std::string what =
        fmt::format("{}density = {} kg/m^4: the mass would be {} kg; expected {} to {}", sizes,
                    toml_text(body.density), toml_text(body.type.mass), toml_text(kLeastMass),
                    toml_text(kLargestMass));
    reader.fail("shape", what);
}

void write_type(BodyTable& body, EffectiveWriter& out) {
    out.key("shape", name_of(body.type.shape));
    std::visit(
        [&](auto& s) {
            s.parameters(s, [&](const char* key, const auto& value, Rule) { out.key(key, value); });
        },
        body.shape_as_written);
    const bool bounded = is_bounded(body.type.shape);
    if (bounded) out.key("mass", body.type.mass);
    out.key("friction", body.type.friction);
    out.key("restitution", body.type.restitution);
    const bool position = body.type.fixed_position, rotation = body.type.fixed_rotation;
    out.line("fixed", position ? (rotation ? R"(["position", "rotation"])" : R"(["position"])")
                               : (rotation ? R"(["rotation"])" : "[]"));
    // The default grey has no name.
    if (body.appearance.material != 0) out.key("material", body.material);
    out.key("visible", body.appearance.visible);
}

void write_placing(const BodyTable& body, EffectiveWriter& out) {
    out.table(body.lattice ? "[[lattice]]" : "[[body]]");
    out.key("name", body.name);
    if (is_bounded(body.type.shape)) {
        out.key("position", body.position);
        out.key("rotation", body.rotation);
        out.key("velocity", body.velocity);
        out.key("angular_velocity", body.angular_velocity);
    }
    if (!body.lattice) return;
    const auto& [count, spacing, jitter, seed] = *body.lattice;
    out.line("count", fmt::format("[{}, {}, {}, {}]", count[0], count[1], count[2], count[3]));
    out.key("spacing", spacing);
    out.key("jitter", jitter);
    out.key("seed", static_cast<std::int64_t>(seed));
}

/// Reads tables one after another into the scene's bodies.
class BodyLoader {
  public:
    BodyLoader(const MaterialNumbers& materials, Scene& scene, EffectiveWriter& out)
        : materials_(materials), scene_(scene), out_(out) {}

    /// @param index   among the tables of its kind; nothing is kept of `origin`
    BodyTable read(const toml::table& table, const Origin& origin, bool is_lattice,
                   std::size_t index) {
        const std::size_t number = names_.size();
        std::string subject = fmt::format("{} {}", is_lattice ? "lattice" : "body", index);
        BodyTable body;
        const bool named = TableReader(table, origin, subject).read("name", body.name);
        if (named) subject += fmt::format(" {}", toml_text(std::string_view(printable(body.name))));
        TableReader reader(table, origin, subject);
        check_name(reader, named, number, body.name);
        read_shape(reader, body.type.shape);
        const bool bounded = is_bounded(body.type.shape);
        if (bounded)
            read_motion(reader, body);
        else
            refuse_motion(reader, body.type.shape);
        read_surface(reader, materials_, body);
        if (is_lattice) read_lattice(reader, kMaxBodies - total_, body);
        if (is_lattice && !bounded)
            reader.fail("shape",
                        fmt::format("a {} cannot be in a lattice", name_of(body.type.shape)));
        reader.finish();

        body.shape_as_written = body.type.shape;
        std::visit([](auto& s) { complete(s); }, body.type.shape);
        if (bounded) set_mass(reader, body);
        total_ += body.count;
        return body;
    }

    /// Bodies of all tables read so far.
    std::uint64_t total() const { return total_; }

    void reserve() {
        Bodies& bodies = scene_.bodies;
        bodies.type.reserve(total_);
        bodies.position.reserve(total_);
        bodies.rotor.reserve(total_);
        bodies.velocity.reserve(total_);
        bodies.angular_velocity.reserve(total_);
    }

    void append(BodyTable& body) {
        write_placing(body, out_);
        const std::size_t start = out_.text().size();
        write_type(body, out_);
        const std::uint32_t type = type_number(body, std::string_view(out_.text()).substr(start));

        Bodies& bodies = scene_.bodies;
        scene_.names.push_back({body.name, static_cast<BodyId>(bodies.size()),
                                static_cast<std::uint32_t>(body.count)});
        const Rotor rotor = exp(-0.5 * std::numbers::pi / 180 * body.rotation);
        for (std::uint64_t i = 0; i < body.count; ++i) {
            bodies.type.push_back(type);
            bodies.position.push_back(body.lattice
                                          ? Vec4(body.position + lattice_point(*body.lattice, i))
                                          : body.position);
            bodies.rotor.push_back(rotor);
            bodies.velocity.push_back(body.velocity);
            bodies.angular_velocity.push_back(body.angular_velocity);
        }
    }

  private:
    void check_name(TableReader& reader, bool named, std::size_t number, std::string& name) {
        reader.has("name");
        if (!named) name = fmt::format("body-{}", number);
        if (name.empty() || name.size() > kMaxNameBytes)
            reader.fail("name", fmt::format("expected 1 to {} bytes", kMaxNameBytes));
        if (names_.insert(name).second) return;
        if (named) reader.fail("name", "another body or lattice has this name");
        reader.fail_here(
            fmt::format("another body is called \"{}\", the default name of this one; "
                        "give it a name",
                        name));
    }

    /// The type with this canonical text. Equal hashes of different types are told apart: the
    /// second of them stays alone.
    std::uint32_t type_number(const BodyTable& body, std::string_view text) {
        auto& types = scene_.bodies.types;
        const auto next = static_cast<std::uint32_t>(types.size());
        const auto [found, is_new] = types_.emplace(hash_of(text), next);
        const std::uint32_t number = found->second;
        if (!is_new && types[number] == body.type && scene_.appearance[number] == body.appearance)
            return number;
        types.push_back(body.type);
        scene_.appearance.push_back(body.appearance);
        return next;
    }

    struct FirstWord {
        std::size_t operator()(const std::array<std::uint64_t, 2>& hash) const { return hash[0]; }
    };

    const MaterialNumbers& materials_;
    Scene& scene_;
    EffectiveWriter& out_;
    std::uint64_t total_ = 0;
    std::unordered_set<std::string> names_;
    std::unordered_map<std::array<std::uint64_t, 2>, std::uint32_t, FirstWord> types_;
};

void require_memory(std::uint64_t bytes, std::uint64_t bodies, const Origin& origin) {
    const std::uint64_t available = available_memory();
    if (bytes > available)
        throw InputError(fmt::format("{}: {} bodies take about {} bytes of memory, {} are free",
                                     origin.place, bodies, bytes, available));
}

}  // namespace

void load_bodies(TableReader& root, const Origin& origin, const SceneText& text,
                 const MaterialNumbers& materials, Overrides& overrides, Scene& scene,
                 EffectiveWriter& out) {
    if (root.has("body") && text.body_count > 0)
        root.fail("body", "expected [[body]] tables, each with its subtables right after it");
    require_memory(text.body_count * kBytesPerTable, text.body_count, origin);
    BodyLoader loader(materials, scene, out);
    std::size_t number = 0;
    const auto load = [&](const toml::table* table, const Origin& place) {
        BodyTable body = loader.read(*table, place, false, number++);
        loader.append(body);
    };
    for (const TextPiece& piece : text.bodies) {
        TomlDocument document(piece.text, {origin.place, piece.lines_before});
        overrides.apply_to_bodies(document.root(), number);
        TableReader tables(document.root(), document.origin(), "scene file");
        const auto bodies = tables.tables("body");
        tables.finish();
        for (const auto* table : bodies) load(table, document.origin());
    }
    // Bodies written as an array of inline tables.
    for (const auto* table : root.tables("body")) load(table, origin);
    overrides.require_all_met(scene.names);

    const auto lattices = root.tables("lattice");
    std::vector<BodyTable> lattice_tables;
    for (std::size_t i = 0; i < lattices.size(); ++i)
        lattice_tables.push_back(loader.read(*lattices[i], origin, true, i));
    require_memory((loader.total() - number) * kBytesPerBody, loader.total(), origin);
    loader.reserve();
    for (BodyTable& body : lattice_tables) loader.append(body);
}

}  // namespace tesserae::scenes

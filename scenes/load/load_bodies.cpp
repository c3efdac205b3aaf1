// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <memory>
#include <numbers>
#include <span>
#include <unordered_map>
#include <unordered_set>

#include "core/error.hpp"
#include "scenes/load/body_keys.hpp"
#include "scenes/load/group_numbers.hpp"
#include "scenes/load/hash.hpp"
#include "scenes/process/memory.hpp"

namespace tesserae::scenes {
namespace {

constexpr std::size_t kMaxNameBytes = 256;
/// Bodies' states, and for a [[body]] of its own also its name and canonical text.
constexpr std::uint64_t kBytesPerBody = 250;
constexpr std::uint64_t kBytesPerTable = 1000;

/// One of every shape, in the order of Shape; and their names.
const auto kShapes = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array{Shape(std::variant_alternative_t<I, Shape>())...};
}
(std::make_index_sequence<std::variant_size_v<Shape>>());
const auto kShapeNames = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array{std::string_view(std::variant_alternative_t<I, Shape>::kName)...};
}
(std::make_index_sequence<std::variant_size_v<Shape>>());

const char* expected_of(Rule rule) {
    if (rule == Rule::kPositive) return "expected a size > 0";
    if (rule == Rule::kNonNegative) return "expected a size >= 0";
    if (rule == Rule::kSides) return "expected the sides of two polygons, >= 3";
    return "expected a direction, four numbers";
}

void visit_parameters(auto& shape, const auto& visit) {
    std::visit([&](auto& s) { s.parameters(s, visit); }, shape);
}

template <class S>
void read_parameters(TableReader& reader, S& shape) {
    shape.parameters(shape, [&](const Key& size, auto& member, Rule rule) {
        // A plain number, such as a hyperplane's offset, is 0 where it is not given.
        if (rule != Rule::kFinite) reader.require(size.name, expected_of(rule));
        reader.collect([&] { reader.read(size.name, member, rule); });
    });
}

/// Where the shape is not known any shape's sizes may be there: it is the shape that is wrong.
void know_all_sizes(TableReader& reader) {
    for (const Shape& any : kShapes)
        visit_parameters(any, [&](const Key& size, auto&, Rule) { reader.has(size.name); });
    reader.has("vertices");
}

/// Points, or a regular one's name and radius.
void read_parameters(TableReader& reader, Polychoron& shape) {
    if (reader.read("vertices", shape.vertices)) {
        shape.regular = RegularPolychoron::kNone;
        for (const char* key : {"regular", "radius"})
            if (reader.has(key))
                reader.collect(
                    [&] { reader.fail(key, "there are vertices too; expected only them"); });
        return;
    }
    constexpr auto kNames = [] {
        std::array<std::string_view, std::size(kRegularNames)> names;
        std::copy(std::begin(kRegularNames), std::end(kRegularNames), names.begin());
        return names;
    }();
    reader.require("regular", "expected vertices, or a regular one's name, as \"24-cell\"");
    auto which = static_cast<std::size_t>(shape.regular) - 1;
    reader.collect([&] { reader.read("regular", which, kNames); });
    shape.regular = static_cast<RegularPolychoron>(which + 1);
    if (reader.has("regular")) reader.require("radius", expected_of(Rule::kPositive));
    reader.collect([&] { reader.read("radius", shape.radius, Rule::kPositive); });
}

}  // namespace

void AnyShape::read(TableReader& reader, const char* key, Shape& shape) const {
    if (!reader.has(key)) {
        std::string expected = "expected one of";
        for (std::string_view name : kShapeNames) expected += fmt::format(" \"{}\"", name);
        reader.require(key, expected);
        know_all_sizes(reader);
        return;
    }
    std::size_t kind = 0;
    try {
        reader.read(key, kind, kShapeNames);
    } catch (const InputError&) {
        know_all_sizes(reader);
        throw;
    }
    shape = kShapes[kind];
    std::visit([&](auto& s) { read_parameters(reader, s); }, shape);
}

void AnyShape::write(EffectiveWriter& out, const char* key, const Shape& shape) const {
    out.key(key, name_of(shape));
    visit_parameters(shape, WriteKeys{out});
}

Rotor rotor_of(std::span<const Bivector> turns) {
    const auto one = [](const Bivector& degrees) {
        return exp(-0.5 * std::numbers::pi / 180 * degrees);
    };
    Rotor rotor = one(turns.front());
    for (const Bivector& turn : turns.subspan(1)) rotor = one(turn) * rotor;
    return rotor;
}

namespace {

/// A body without bounds never moves.
void refuse_motion(TableReader& reader, BodyTable& body) {
    const auto refuse = [&](const Key& key, const auto&...) {
        if (!reader.has(key.name)) return;
        reader.collect([&] {
            reader.fail(key.name, fmt::format("a {} never moves and has no {}", name_of(body.shape),
                                              key.name));
        });
    };
    placing_keys(body, refuse), mass_keys(body, refuse), moving_keys(body, refuse);
}

void set_mass(TableReader& reader, BodyTable& body) {
    if (body.has_mass) return;
    const double content = std::visit([](const auto& s) { return volume(s); }, body.type.shape);
    body.type.mass = body.density * content;
    if (body.type.mass >= kLeastMass && body.type.mass <= kLargestMass) return;
    std::string sizes;
    visit_parameters(body.shape, [&](const Key& key, const auto& value, Rule) {
        sizes += fmt::format("{} = {}, ", key.name, toml_text(value));
    });
    const std::string what =
        fmt::format("{}density = {} kg/m^4: the mass would be {} kg; expected {} to {}", sizes,
                    toml_text(body.density), toml_text(body.type.mass), toml_text(kLeastMass),
                    toml_text(kLargestMass));
    reader.fail("shape", what);
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
        const bool named = is_named(table, origin, subject, body.name);
        if (named) subject += fmt::format(" {}", toml_text(std::string_view(printable(body.name))));
        TableReader reader(table, origin, subject);
        const ReadKeys read{reader};
        name_keys(body, read);
        reader.collect([&] { check_name(reader, named, number, body.name); });
        shape_keys(body, read);
        const bool bounded = is_bounded(body.shape);
        if (bounded)
            placing_keys(body, read), mass_keys(body, read), moving_keys(body, read);
        else
            refuse_motion(reader, body);
        surface_keys(body, read, materials_);
        reader.collect([&] { groups_.set(reader, body.group, body.collides_with, body.type); });
        if (is_lattice) lattice_keys(body.lattice.emplace(), read, kMaxBodies - total_);
        if (is_lattice && !bounded)
            reader.collect([&] {
                reader.fail("shape",
                            fmt::format("a {} cannot be in a lattice", name_of(body.shape)));
            });
        reader.finish();

        // Material 0 is the grey of those that name none.
        if (const auto material = materials_.find(body.material); material != materials_.end())
            body.appearance.material = material->second;
        body.type.shape = completed(reader, body.shape);
        if (bounded) set_mass(reader, body);
        if (is_lattice)
            for (const std::uint32_t n : body.lattice->count) body.count *= n;
        total_ += body.count;
        return body;
    }

    /// @throws InputError   some body collides with a group that no body is of
    void require_groups() const { groups_.require_all_met(); }
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

    void append(const BodyTable& body) {
        const WriteKeys write{out_};
        const bool bounded = is_bounded(body.shape);
        out_.table(body.lattice ? "[[lattice]]" : "[[body]]");
        name_keys(body, write);
        if (bounded) placing_keys(body, write);
        if (body.lattice) lattice_keys(*body.lattice, write, kMaxBodies);
        // What follows is the same for bodies of one type.
        const std::size_t start = out_.text().size();
        shape_keys(body, write);
        if (bounded) mass_keys(body, write), moving_keys(body, write);
        surface_keys(body, write, materials_);
        const std::uint32_t type = type_number(body, std::string_view(out_.text()).substr(start));

        Bodies& bodies = scene_.bodies;
        scene_.names.push_back({body.name, static_cast<BodyId>(bodies.size()),
                                static_cast<std::uint32_t>(body.count), body.lattice.has_value()});
        const Rotor rotor = rotor_of(body.rotation);
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
    /// Whether the table has a name; a wrong one is told later.
    static bool is_named(const toml::table& table, const Origin& origin, const std::string& subject,
                         std::string& name) {
        TableReader reader(table, origin, subject);
        bool is_read = false;
        reader.collect([&] { is_read = reader.read("name", name); });
        return is_read;
    }
    /// Before completed(): clang 14 makes no code of it otherwise.
    template <class S>
    void complete_hull(TableReader& reader, S& shape) {
        try {
            complete(shape);
        } catch (const InputError& error) {
            const char* culprit = nullptr;
            shape.parameters(shape, [&](const Key& key, auto&, Rule) {
                if (culprit == nullptr) culprit = key.name;
            });
            reader.fail(culprit, error.what());
        }
    }
    /// Equal hulls share what was made of them.
    Shape completed(TableReader& reader, Shape shape) {
        EffectiveWriter parameters;
        visit_parameters(shape, WriteKeys{parameters});
        return std::visit(
            [&]<class S>(S& own) -> Shape {
                if constexpr (!std::derived_from<S, HullShape>) {
                    complete(own);
                } else if (const auto& [made, is_new] = hulls_.emplace(
                               own.kName + parameters.text(), std::shared_ptr<const HullBody>());
                           is_new) {
                    complete_hull(reader, own);
                    made->second = own.body;
                } else {
                    own.body = made->second;
                }
                return own;
            },
            shape);
    }
    void check_name(TableReader& reader, bool named, std::size_t number, std::string& name) {
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
    /// By shape and parameters.
    std::unordered_map<std::string, std::shared_ptr<const HullBody>> hulls_;
    std::unordered_set<std::string> names_;
    GroupNumbers groups_;
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
    ErrorList errors;
    std::size_t number = 0;
    const auto load = [&](const toml::table* table, const Origin& place) {
        errors.collect([&] { loader.append(loader.read(*table, place, false, number++)); });
    };
    const auto load_piece = [&](const TextPiece& piece) {
        TomlDocument document(piece.text, {origin.place, piece.lines_before});
        overrides.apply_to_bodies(document.root(), number);
        TableReader tables(document.root(), document.origin(), "scene file");
        const auto bodies = tables.tables("body");
        tables.finish();
        for (const auto* table : bodies) load(table, document.origin());
    };
    for (const TextPiece& piece : text.bodies) errors.collect([&] { load_piece(piece); });
    // Bodies written as an array of inline tables.
    for (const auto* table : root.tables("body")) load(table, origin);
    if (errors.is_empty()) errors.collect([&] { overrides.require_all_met(scene.names); });

    const auto lattices = root.tables("lattice");
    std::vector<BodyTable> lattice_tables;
    for (std::size_t i = 0; i < lattices.size(); ++i)
        errors.collect(
            [&] { lattice_tables.push_back(loader.read(*lattices[i], origin, true, i)); });
    if (errors.is_empty()) errors.collect([&] { loader.require_groups(); });
    errors.require_none();
    require_memory((loader.total() - number) * kBytesPerBody, loader.total(), origin);
    loader.reserve();
    for (const BodyTable& body : lattice_tables) loader.append(body);
}

}  // namespace tesserae::scenes

// SPDX-License-Identifier: Apache-2.0
#include <unordered_set>

#include "core/dynamics/constraints/make_joint.hpp"
#include "core/error.hpp"
#include "scenes/load/body_finder.hpp"
#include "scenes/load/joint_keys.hpp"
#include "scenes/load/load_parts.hpp"
#include "scenes/load/weld_loops.hpp"

namespace tesserae::scenes {
namespace {

constexpr std::size_t kMaxJointName = 256;

/// Where the type is not known any type's keys may be there: it is the type that is wrong.
void know_all_keys(TableReader& reader) {
    JointTable any;
    for (std::size_t i = 0; i < std::size(kJointTypeNames); ++i) {
        any.type = static_cast<JointType>(i);
        joint_type_keys(any, [&](const Key& key, const auto&...) { reader.has(key.name); });
    }
}

/// Reads tables one after another into the scene's joints.
class JointLoader {
  public:
    JointLoader(bool has_bodies, Scene& scene, EffectiveWriter& out)
        : has_bodies_(has_bodies),
          scene_(scene),
          out_(out),
          finder_(scene.names),
          welds_(scene.bodies) {}

    /// @param index   among the [[joint]] tables; nothing is kept of `origin`
    void load(const toml::table& table, const Origin& origin, std::size_t index) {
        std::string name;
        const bool named = has_name(table, origin, name);
        std::string subject = fmt::format("joint {}", index);
        if (named) subject += fmt::format(" {}", toml_text(std::string_view(printable(name))));
        TableReader reader(table, origin, subject);
        JointTable joint = read(reader, named, index);
        const Ends ends = has_bodies_ ? find_ends(reader, joint) : Ends();
        reader.finish();
        if (has_bodies_) append(reader, joint, ends);
    }

  private:
    struct Ends {
        BodyId a = kWorld, b = kWorld;
    };

    /// Whether the table has a name; a wrong one is told later.
    static bool has_name(const toml::table& table, const Origin& origin, std::string& name) {
        TableReader reader(table, origin, "joint");
        bool is_read = false;
        reader.collect([&] { is_read = reader.read("name", name); });
        return is_read;
    }

    JointTable read(TableReader& reader, bool named, std::size_t index) {
        JointTable joint;
        const ReadKeys read{reader};
        joint_keys(joint, read);
        reader.collect([&] { check_name(reader, named, index, joint.name); });
        if (joint.has_type)
            joint_type_keys(joint, read);
        else
            know_all_keys(reader);
        if (joint.has_type && joint.type == JointType::kSpring)
            reader.collect([&] { complete_in(reader, joint.spring); });
        joint_end_keys(joint, read);
        return joint;
    }

    void check_name(TableReader& reader, bool named, std::size_t index, std::string& name) {
        if (!named) name = fmt::format("joint-{}", index);
        if (name.empty() || name.size() > kMaxJointName)
            reader.fail("name", fmt::format("expected 1 to {} bytes", kMaxJointName));
        if (names_.insert(name).second) return;
        if (named) reader.fail("name", "another joint has this name");
        reader.fail_here(
            fmt::format("another joint is called \"{}\", the default name of this one; give it a "
                        "name",
                        name));
    }

    /// Finds the two bodies and checks that they can be joined.
    Ends find_ends(TableReader& reader, const JointTable& joint) const {
        Ends ends;
        bool is_found = !joint.a.empty();
        const auto find = [&](const char* key, const std::string& name, BodyId& body) {
            if (name.empty()) return;
            is_found = false;
            reader.collect([&] {
                if (name == "world" && !finder_.knows(name))
                    reader.fail(key,
                                "no body is called so; a joint without b joins a to the world");
                body = finder_.find(reader, key, name);
                is_found = true;
            });
        };
        find("a", joint.a, ends.a);
        const bool has_a = is_found;
        find("b", joint.b, ends.b);
        if (has_a && is_found) reader.collect([&] { require_movable(reader, ends); });
        if (has_a && is_found) require_anchors(reader, joint, ends);
        return ends;
    }

    void require_movable(TableReader& reader, const Ends& ends) const {
        const Bodies& bodies = scene_.bodies;
        if (ends.a == ends.b)
            reader.fail("b", "is body a too; expected another body, or none for the world");
        if (bodies.is_movable(ends.a) || (ends.b != kWorld && bodies.is_movable(ends.b))) return;
        const auto why = [&](BodyId id) {
            return is_bounded(bodies.type_of(id).shape) ? "is fixed" : "is a hyperplane";
        };
        if (ends.b == kWorld)
            reader.fail("a", fmt::format("{}; expected a body that may move", why(ends.a)));
        reader.fail("b", fmt::format("{}, and a {}; expected that one of them may move",
                                     why(ends.b), why(ends.a)));
    }

    /// What has no centre needs an anchor.
    void require_anchors(TableReader& reader, const JointTable& joint, const Ends& ends) const {
        if (!joint.has_type || !is_line(joint.type)) return;
        const auto has_centre = [&](BodyId id) {
            return id != kWorld && is_bounded(scene_.bodies.type_of(id).shape);
        };
        const char* expected = "expected four numbers: the point where it is tied";
        if (!has_centre(ends.a)) reader.require("anchor_a", expected);
        if (!has_centre(ends.b)) reader.require("anchor_b", expected);
    }

    void append(TableReader& reader, JointTable& table, const Ends& ends) {
        const auto fail = [&](const char* key, std::string_view what) { reader.fail(key, what); };
        set_length(table, scene_.bodies, ends.a, ends.b, fail);
        scene_.joints.push_back(make_joint(in_radians(table), scene_.bodies, ends.a, ends.b, fail));
        scene_.joint_names.push_back(table.name);
        // Welds that break may share a load in any way.
        if (table.type == JointType::kWeld && !table.breaks) require_chain(reader);
        const WriteKeys write{out_};
        out_.table("[[joint]]");
        joint_keys(table, write);
        joint_type_keys(table, write);
        joint_end_keys(table, write);
    }

    void require_chain(TableReader& reader) {
        const std::size_t number = scene_.joints.size() - 1;
        const auto other = welds_.add(scene_.joints.back(), number);
        if (other)
            reader.fail_here(fmt::format(
                "closes a loop of welds, of which joint \"{}\" is another; expected a chain: "
                "leave one of them out, or let them break",
                printable(scene_.joint_names[*other])));
    }

    bool has_bodies_;
    Scene& scene_;
    EffectiveWriter& out_;
    BodyFinder finder_;
    std::unordered_set<std::string> names_;
    WeldLoops welds_;
};

}  // namespace

void load_joints(TableReader& root, const Origin& origin, bool has_bodies, Scene& scene,
                 EffectiveWriter& out) {
    const auto tables = root.tables("joint");
    if (tables.empty()) return;
    JointLoader loader(has_bodies, scene, out);
    ErrorList errors;
    for (std::size_t i = 0; i < tables.size(); ++i)
        errors.collect([&] { loader.load(*tables[i], origin, i); });
    errors.require_none();
}

}  // namespace tesserae::scenes

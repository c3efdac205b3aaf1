#include <charconv>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "scenes/load/load_parts.hpp"
#include "scenes/load/nearest_name.hpp"

namespace tesserae::scenes {
namespace {

/// N of "NAME.N" for a lattice of that name; none: it is another name.
std::optional<std::uint32_t> number_in(const NamedBodies& lattice, std::string_view name) {
    const std::size_t dot = lattice.name.size();
    if (!lattice.is_lattice || name.size() < dot + 2 || !name.starts_with(lattice.name) ||
        name[dot] != '.')
        return {};
    std::uint32_t number = 0;
    const char* const end = name.data() + name.size();
    const auto [next, error] = std::from_chars(name.data() + dot + 1, end, number);
    if (error != std::errc() || next != end) return {};
    return number;
}

}  // namespace

void find_followed(TableReader& root, const Origin& origin, Scene& scene) {
    const std::string& name = scene.camera_motion.follow;
    if (name.empty()) return;
    TableReader reader(*root.table("camera"), origin, "[camera]");
    std::vector<std::string_view> names;
    for (const NamedBodies& bodies : scene.names) {
        names.push_back(bodies.name);
        if (bodies.name == name && !bodies.is_lattice) scene.camera_motion.followed = bodies.first;
    }
    if (scene.camera_motion.followed) return;
    for (const NamedBodies& bodies : scene.names) {
        const std::optional<std::uint32_t> number = number_in(bodies, name);
        if (!number && bodies.name != name) continue;
        if (!number || *number >= bodies.count)
            reader.fail("follow", fmt::format("the lattice has {0} bodies; expected one of them, "
                                              "\"{1}.0\" to \"{1}.{2}\"",
                                              bodies.count, bodies.name, bodies.count - 1));
        scene.camera_motion.followed = bodies.first + *number;
        return;
    }
    reader.fail("follow", "no body is called so" + did_you_mean(name, names));
}

}  // namespace tesserae::scenes

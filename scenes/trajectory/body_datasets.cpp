// SPDX-License-Identifier: Apache-2.0
#include "scenes/trajectory/body_datasets.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

#include "core/error.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/trajectory/entry_datasets.hpp"
#include "scenes/trajectory/trajectory_layout.hpp"

namespace tesserae::scenes {
namespace {

using hdf5::checked;
using hdf5::Handle;

constexpr const char* kName = "name";

std::string size_text(const Shape& shape) {
    std::string text;
    const auto append = [&](const Key& key, const auto& value, Rule) {
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key.name, toml_text(value));
    };
    std::visit([&](const auto& s) { s.parameters(s, append); }, shape);
    return printable(text, kMostSizeBytes);
}

std::string shape_text(const Shape& shape) { return name_of(shape); }

double mass_of(const BodyType& type) {
    return is_bounded(type.shape) ? type.mass : std::numeric_limits<double>::infinity();
}

/// Bytes of the longest text that shapes have.
std::size_t longest_of(const BodyDescriptions& bodies, std::string (*text_of)(const Shape&)) {
    std::size_t most = 1;
    for (const BodyType& type : bodies.types) most = std::max(most, text_of(type.shape).size());
    return most;
}

std::size_t longest_name(const BodyDescriptions& bodies) {
    std::size_t most = 1;
    for (const NamedBodies& named : bodies.names) most = std::max(most, named.name.size());
    return most;
}

/// A text of each body's shape. Bodies of a lattice, one after another, are of one type: only the
/// last text is kept, and no list of a million.
void create_shape_texts(hid_t group, const char* name, const BodyDescriptions& bodies,
                        std::string (*text_of)(const Shape&)) {
    const std::size_t width = longest_of(bodies, text_of);
    const Handle type = hdf5::text_type(width);
    std::optional<std::uint32_t> last;
    std::string text;
    create_entries(group, name, type.get(), width, bodies.type.size(),
                   [&](std::uint64_t body, char* to) {
                       if (last != bodies.type[body]) {
                           last = bodies.type[body];
                           text = text_of(bodies.types[*last].shape);
                       }
                       std::memcpy(to, text.data(), text.size());
                   });
}

Handle create_names(hid_t group, const std::string& name, const BodyDescriptions& bodies) {
    TSR_ASSERT(bodies.type.empty() || !bodies.names.empty());
    const std::size_t width = longest_name(bodies);
    const Handle type = hdf5::text_type(width);
    std::size_t run = 0;
    return create_entries(
        group, name, type.get(), width, bodies.type.size(), [&](std::uint64_t body, char* to) {
            while (run + 1 < bodies.names.size() && bodies.names[run + 1].first <= body) ++run;
            const std::string& text = bodies.names[run].name;
            std::memcpy(to, text.data(), text.size());
        });
}

}  // namespace

void create_body_datasets(const Handle& group, const BodyDescriptions& bodies) {
    const Handle mass = create_entries(group.get(), "mass", H5T_IEEE_F64LE, sizeof(double),
                                       bodies.type.size(), [&](std::uint64_t body, char* to) {
                                           const double value =
                                               mass_of(bodies.types[bodies.type[body]]);
                                           std::memcpy(to, &value, sizeof value);
                                       });
    hdf5::add_text_attribute(mass.get(), "unit", "kg");
    create_shape_texts(group.get(), "shape", bodies, shape_text);
    create_shape_texts(group.get(), "size", bodies, size_text);
    // Last in the group, so that replace_names() finds its place as it was: see
    // trajectory_driver.hpp.
    create_names(group.get(), kName, bodies);
}

void replace_names(const Handle& file, const BodyDescriptions& bodies) {
    const Handle group = hdf5::open_group(file.get(), kBodies);
    if (!hdf5::has_link(group.get(), kName)) return;
    const Handle names = create_names(group.get(), "", bodies);
    checked(H5Fflush(file.get(), H5F_SCOPE_LOCAL));
    hdf5::replace_link(group.get(), kName, names);
    checked(H5Fflush(file.get(), H5F_SCOPE_LOCAL));
}

std::uint64_t description_bytes(const BodyDescriptions& bodies) {
    return sizeof(double) + longest_name(bodies) + longest_of(bodies, shape_text) +
           longest_of(bodies, size_text);
}

}  // namespace tesserae::scenes

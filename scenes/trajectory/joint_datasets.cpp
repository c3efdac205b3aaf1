// SPDX-License-Identifier: Apache-2.0
#include "scenes/trajectory/joint_datasets.hpp"

#include <algorithm>
#include <cstring>

#include "scenes/trajectory/dataset_storage.hpp"
#include "scenes/trajectory/entry_datasets.hpp"

namespace tesserae::scenes {
namespace {

using hdf5::checked;
using hdf5::Handle;

constexpr const char *kJointName = "name", *kPositionUnit = "position/unit";

/// Bytes of a chunk of a row, usual 1 MiB. A chunk never spans rows, as those of bodies' states.
constexpr std::uint64_t kJointChunkBytes = 1 << 20;

/// A text of each joint, of the length of the longest.
/// @param name   empty: nothing leads to it yet
Handle create_joint_texts(hid_t group, const std::string& name,
                          const std::vector<JointDescription>& joints,
                          std::string JointDescription::*text) {
    std::size_t width = 1;
    for (const JointDescription& joint : joints) width = std::max(width, (joint.*text).size());
    const Handle type = hdf5::text_type(width);
    return create_entries(group, name, type.get(), width, joints.size(),
                          [&](std::uint64_t joint, char* to) {
                              const std::string& entry = joints[joint].*text;
                              std::memcpy(to, entry.data(), entry.size());
                          });
}

/// Reads a text of each of so many joints.
void read_joint_texts(const Handle& group, const std::string& name, std::uint64_t file_bytes,
                      std::vector<JointDescription>& joints, std::string JointDescription::*text) {
    std::vector<std::string> texts =
        read_texts(group.get(), name, kJoints, joints.size(), file_bytes);
    for (std::size_t i = 0; i < joints.size(); ++i) joints[i].*text = std::move(texts[i]);
}

template <class Pointer, class Facts>
std::array<Pointer, kJointElements.size()> joint_values_of(Facts& f) {
    return {f.impulse.data(),       f.angular_impulse.data(), f.error.data(),
            f.angular_error.data(), f.position.data(),        f.broken.data()};
}

}  // namespace

std::string joint_element_path(const JointElement& element) {
    return std::string(kJoints) + "/" + element.name;
}

std::array<const void*, kJointElements.size()> joint_values(const JointFacts& facts) {
    return joint_values_of<const void*>(facts);
}

std::array<void*, kJointElements.size()> joint_values(JointFacts& facts) {
    return joint_values_of<void*>(facts);
}

double joint_value(const JointFacts& facts, std::size_t element, std::size_t joint) {
    const void* const values = joint_values(facts)[element];
    return kJointElements[element].is_byte ? static_cast<const std::uint8_t*>(values)[joint]
                                           : static_cast<const double*>(values)[joint];
}

JointFacts room_for_joints(std::uint64_t joints) {
    const std::vector<double> reals(joints);
    return {reals, reals, reals, reals, reals, std::vector<std::uint8_t>(joints)};
}

void create_joint_datasets(const Handle& file, const std::vector<JointDescription>& joints) {
    const Handle group = hdf5::create_group(file.get(), kJoints);
    for (const JointElement& element : kJointElements) {
        const Handle parent = hdf5::create_group(group.get(), element.name);
        const hsize_t chunk =
            std::min<std::uint64_t>(joints.size(), kJointChunkBytes / bytes_of(element));
        const Handle value = hdf5::create_growing(parent.get(), "value",
                                                  element.is_byte ? H5T_STD_U8LE : H5T_IEEE_F64LE,
                                                  {0, joints.size()}, {1, chunk}, true);
        if (*element.unit) hdf5::add_text_attribute(value.get(), "unit", element.unit);
    }
    create_joint_texts(group.get(), kPositionUnit, joints, &JointDescription::unit);
    // Last in the group, so that replace_joint_names() finds its place as it was: see
    // trajectory_driver.hpp.
    create_joint_texts(group.get(), kJointName, joints, &JointDescription::name);
}

void replace_joint_names(const Handle& file, const std::vector<JointDescription>& joints) {
    const Handle group = hdf5::open_group(file.get(), kJoints);
    const Handle names = create_joint_texts(group.get(), "", joints, &JointDescription::name);
    checked(H5Fflush(file.get(), H5F_SCOPE_LOCAL));
    hdf5::replace_link(group.get(), kJointName, names);
    checked(H5Fflush(file.get(), H5F_SCOPE_LOCAL));
}

std::vector<JointDescription> read_joint_descriptions(const Handle& file, std::uint64_t joints,
                                                      std::uint64_t file_bytes) {
    // The scene's text has more than a byte for each.
    if (joints > file_bytes)
        throw hdf5::Failure(std::string(kJoints) + ": are more than the file can hold");
    std::vector<JointDescription> described(joints);
    const Handle group = hdf5::open_group(file.get(), kJoints);
    read_joint_texts(group, kJointName, file_bytes, described, &JointDescription::name);
    read_joint_texts(group, kPositionUnit, file_bytes, described, &JointDescription::unit);
    return described;
}

}  // namespace tesserae::scenes

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/trajectory/hdf5.hpp"
#include "scenes/trajectory/trajectory.hpp"

// What a trajectory says of joints. The group /joints has an H5MD element for each of
// kJointElements, whose values have the shape [stored steps][joints], and two texts for each joint:
//
//   position/unit   that of its position: "m" or "deg"; empty where it has none
//   name            what a scene file calls it
//
// A trajectory of a scene without joints has no such group.
namespace tesserae::scenes {

inline constexpr const char* kJoints = "/joints";

/// A property of joints: an H5MD element of a number for each joint.
struct JointElement {
    const char* name;
    const char* unit;      ///< empty: none, or each joint has its own
    bool is_byte = false;  ///< 0 or 1; else reals
};
inline constexpr std::array<JointElement, 6> kJointElements = {{
    {"impulse", "N s"},
    {"angular_impulse", "N m s"},
    {"error", "m"},
    {"angular_error", "deg"},
    {"position", ""},
    {"broken", "", true},
}};

/// Bytes of a number of an element.
constexpr std::size_t bytes_of(const JointElement& element) { return element.is_byte ? 1 : 8; }

/// Bytes of what a stored step tells of a joint, before compression.
inline constexpr std::uint64_t kJointRowBytes = 5 * 8 + 1;

/// The path of an element's group.
std::string joint_element_path(const JointElement& element);

/// Where the numbers of all joints lie in memory, in the order of kJointElements.
std::array<const void*, kJointElements.size()> joint_values(const JointFacts& facts);
std::array<void*, kJointElements.size()> joint_values(JointFacts& facts);
/// The number that facts have of a joint for an element.
double joint_value(const JointFacts& facts, std::size_t element, std::size_t joint);
/// Facts of so many joints that are not broken, on which nothing acts.
JointFacts room_for_joints(std::uint64_t joints);

/// Creates the group, without the elements' steps and times. Nothing is to be added to it after.
void create_joint_datasets(const hdf5::Handle& file, const std::vector<JointDescription>& joints);

/// Gives the joints other names, which their motion does not depend on. A kill leaves all of the
/// old ones or all of the new ones. Flushes; the file is to be closed before more is written.
void replace_joint_names(const hdf5::Handle& file, const std::vector<JointDescription>& joints);

/// Reads the descriptions of so many joints.
/// @throws hdf5::Failure   there are not so many, or one is no text
std::vector<JointDescription> read_joint_descriptions(const hdf5::Handle& file,
                                                      std::uint64_t joints,
                                                      std::uint64_t file_bytes);

}  // namespace tesserae::scenes

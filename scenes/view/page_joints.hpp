// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.hpp"
#include "scenes/view/pose_tracks.hpp"

// The joints that a page draws as lines: from one body's centre to where the joint is on it, from
// there to where it is on the other body, and on to that one's centre.
namespace tesserae::scenes {

/// In place of a body's number in the page: this end is a point of the world, of a hyperplane, or
/// of an invisible body that stands still.
constexpr std::uint32_t kAtWorld = 0xffffffff;
/// In place of a body's number in the page: the body moves and is not in the page, so nothing is
/// drawn to this end.
constexpr std::uint32_t kNotInPage = 0xfffffffe;

/// A joint of a page. Its end b is always a body of the page.
struct PageJoint {
    std::size_t number = 0;                 ///< in the scene
    std::uint32_t a = kAtWorld, b = 0;      ///< bodies' numbers in the page
    Vec4 on_a = Vec4::Zero();               ///< from a's centre, in its axes; or in the world [m]
    Vec4 on_b = Vec4::Zero();               ///< from b's centre, in its axes [m]
    std::uint32_t broken_at = 0xffffffffU;  ///< first of the page's moments at which it is broken
};

/// Has a page store how bodies turn to which joints are fastened beside their centres, as finely as
/// the picture shows it. It is to be called before poses are added.
void show_anchors(const Scene& scene, PoseRanges& ranges);

/// Returns the joints of a scene that hold at least one of a page's bodies.
/// @param tracks   of the page's bodies
std::vector<PageJoint> page_joints(const Scene& scene, const std::vector<BodyTrack>& tracks);

/// Sets at which moment of a page each joint is broken.
/// @param steps   the last step at or before each moment, ascending; the trajectory has them
/// @throws InputError   the trajectory tells of another number of joints, or cannot be read
void find_broken(std::vector<PageJoint>& joints, const Scene& scene,
                 const std::filesystem::path& trajectory, const std::vector<std::uint64_t>& steps);

/// Bytes that a page takes for a joint, before base64 and without its name.
constexpr std::uint64_t kPageJointBytes = 4 * 8 + 4 * 4 + 3 * 4;

/// Packs joints, little-endian: on_a f64[4] of all joints one after the other, then likewise on_b
/// f32[4], then a, b and broken_at as u32.
std::string joint_bytes(const std::vector<PageJoint>& joints);

}  // namespace tesserae::scenes

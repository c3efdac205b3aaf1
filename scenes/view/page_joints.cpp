// SPDX-License-Identifier: Apache-2.0
#include "scenes/view/page_joints.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "scenes/trajectory/trajectory.hpp"

namespace tesserae::scenes {
namespace {

/// An end of a joint: a body or the world, and the point in its axes.
struct End {
    BodyId body;
    Vec4 on;
};

std::pair<End, End> ends_of(const Joint& joint) {
    return std::visit(
        [&](const auto& kind) {
            return std::pair(End{joint.a, kind.on_a}, End{joint.b, kind.on_b});
        },
        joint.kind);
}

bool stands_still(const Bodies& bodies, BodyId id) {
    return !bodies.is_movable(id) && bodies.velocity[id].isZero(0) &&
           bodies.angular_velocity[id] == Bivector();
}

/// Finds bodies' numbers in a page.
class PageBodies {
  public:
    PageBodies(const Bodies& bodies, const std::vector<BodyTrack>& tracks)
        : bodies_(bodies), tracks_(tracks) {}

    /// Sets the number and the point of a page's joint for one of its ends.
    void place(const End& end, std::uint32_t& number, Vec4& on) const {
        on = end.on;
        number = kAtWorld;
        if (end.body == kWorld || !is_bounded(bodies_.type_of(end.body).shape)) return;
        number = number_of(end.body);
        if (number != kNotInPage || !stands_still(bodies_, end.body)) return;
        number = kAtWorld;
        on = bodies_.position[end.body] + rotate(bodies_.rotor[end.body], end.on);
    }

  private:
    std::uint32_t number_of(BodyId id) const {
        const auto at =
            std::lower_bound(tracks_.begin(), tracks_.end(), id,
                             [](const BodyTrack& track, BodyId other) { return track.id < other; });
        return at != tracks_.end() && at->id == id
                   ? static_cast<std::uint32_t>(at - tracks_.begin())
                   : kNotInPage;
    }

    const Bodies& bodies_;
    const std::vector<BodyTrack>& tracks_;
};

template <class T>
void append_value(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

void show_anchors(const Scene& scene, PoseRanges& ranges) {
    for (const Joint& joint : scene.joints) {
        const auto [a, b] = ends_of(joint);
        for (const End& end : {a, b})
            if (end.body != kWorld && is_bounded(scene.bodies.type_of(end.body).shape))
                ranges.show_point(end.body, end.on.norm());
    }
}

std::vector<PageJoint> page_joints(const Scene& scene, const std::vector<BodyTrack>& tracks) {
    const PageBodies bodies(scene.bodies, tracks);
    std::vector<PageJoint> joints;
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
        const auto [a, b] = ends_of(scene.joints[i]);
        PageJoint joint{.number = i};
        bodies.place(a, joint.a, joint.on_a);
        bodies.place(b, joint.b, joint.on_b);
        if (joint.b >= kNotInPage) {
            std::swap(joint.a, joint.b);
            std::swap(joint.on_a, joint.on_b);
        }
        if (joint.b < kNotInPage) joints.push_back(joint);
    }
    return joints;
}

void find_broken(std::vector<PageJoint>& joints, const Scene& scene,
                 const std::filesystem::path& trajectory, const std::vector<std::uint64_t>& steps) {
    if (scene.joints.empty()) return;
    const TrajectoryReader reader(trajectory);
    if (const std::size_t has = reader.header().joints.size(); has != scene.joints.size())
        throw InputError(fmt::format("{}: holds {} joints, the scene has {}", trajectory.string(),
                                     has, scene.joints.size()));
    const auto broken_at = [&](std::size_t moment) {
        const auto& stored = reader.steps();
        const auto row = std::lower_bound(stored.begin(), stored.end(), steps[moment]);
        TSR_ASSERT(row != stored.end());
        return reader.joints(static_cast<std::uint64_t>(row - stored.begin())).broken;
    };

    // What breaks stays broken: the last moment tells which joints to look for in the others.
    const std::size_t last = steps.size() - 1;
    std::size_t left = 0;
    const std::vector<std::uint8_t> at_end = broken_at(last);
    for (PageJoint& joint : joints) {
        if (at_end[joint.number] == 0) continue;
        joint.broken_at = static_cast<std::uint32_t>(last);
        ++left;
    }
    for (std::size_t moment = 0; moment < last && left > 0; ++moment) {
        const std::vector<std::uint8_t> broken = broken_at(moment);
        for (PageJoint& joint : joints) {
            if (joint.broken_at != last || broken[joint.number] == 0) continue;
            joint.broken_at = static_cast<std::uint32_t>(moment);
            --left;
        }
    }
}

std::string joint_bytes(const std::vector<PageJoint>& joints) {
    std::string bytes;
    bytes.reserve(kPageJointBytes * joints.size());
    for (const PageJoint& joint : joints)
        for (int i = 0; i < 4; ++i) append_value(bytes, joint.on_a[i]);
    for (const PageJoint& joint : joints)
        for (int i = 0; i < 4; ++i) append_value(bytes, static_cast<float>(joint.on_b[i]));
    for (const PageJoint& joint : joints) append_value(bytes, joint.a);
    for (const PageJoint& joint : joints) append_value(bytes, joint.b);
    for (const PageJoint& joint : joints) append_value(bytes, joint.broken_at);
    return bytes;
}

}  // namespace tesserae::scenes

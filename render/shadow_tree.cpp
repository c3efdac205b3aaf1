#include "render/shadow_tree.hpp"

#include <limits>

namespace tesserae::render {
namespace {

/// Reorders so that the lower half along the axis of greatest extent comes first; ties by index.
std::size_t split_at_median(std::span<std::uint32_t> members, std::span<const PlacedBody> bodies) {
    Vec4 low = bodies[members[0]].centre, high = low;
    for (std::uint32_t m : members) {
        low = low.cwiseMin(bodies[m].centre);
        high = high.cwiseMax(bodies[m].centre);
    }
    int axis;
    (high - low).maxCoeff(&axis);
    const std::size_t middle = members.size() / 2;
    std::nth_element(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(middle),
                     members.end(), [&](std::uint32_t a, std::uint32_t b) {
                         const double x = bodies[a].centre[axis], y = bodies[b].centre[axis];
                         return x != y ? x < y : a < b;
                     });
    return middle;
}

}  // namespace

ShadowTree::ShadowTree(std::span<const PlacedBody> bodies) {
    std::vector<std::uint32_t> members;
    for (std::uint32_t i = 0; i < bodies.size(); ++i)
        if (bodies[i].radius < std::numeric_limits<double>::infinity()) members.push_back(i);
    TSR_ASSERT(bodies.size() < kBody);
    if (!members.empty()) build(members, bodies);
}

std::uint32_t ShadowTree::build(std::span<std::uint32_t> members,
                                std::span<const PlacedBody> bodies) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Node& fresh = nodes_.emplace_back();
    for (auto& lane : fresh.centre) lane.fill(0);
    fresh.radius.fill(-std::numeric_limits<float>::infinity());
    fresh.child.fill(kBody);

    // Halve three times; parts of one body and up become children.
    std::array<std::span<std::uint32_t>, kWidth> parts = {members};
    for (std::size_t width = kWidth; width > 1; width /= 2)
        for (std::size_t i = 0; i < kWidth; i += width) {
            const std::span<std::uint32_t> part = parts[i];
            if (part.size() < 2) continue;
            const std::size_t middle = split_at_median(part, bodies);
            parts[i] = part.first(middle);
            parts[i + width / 2] = part.subspan(middle);
        }
    for (int slot = 0; slot < kWidth; ++slot)
        if (!parts[static_cast<std::size_t>(slot)].empty())
            set_child(index, slot, parts[static_cast<std::size_t>(slot)], bodies);
    return index;
}

void ShadowTree::set_child(std::uint32_t node, int slot, std::span<std::uint32_t> members,
                           std::span<const PlacedBody> bodies) {
    const auto i = static_cast<std::size_t>(slot);
    // The ball about the middle of the bodies' boxes.
    Vec4 low = Vec4::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (std::uint32_t m : members) {
        low = low.cwiseMin((bodies[m].centre.array() - bodies[m].radius).matrix());
        high = high.cwiseMax((bodies[m].centre.array() + bodies[m].radius).matrix());
    }
    const Vec4 centre = 0.5 * (low + high);
    double radius = 0;
    for (std::uint32_t m : members)
        radius = std::max(radius, (bodies[m].centre - centre).norm() + bodies[m].radius);

    const std::uint32_t child = members.size() == 1 ? kBody | members[0] : build(members, bodies);
    Node& n = nodes_[node];
    for (std::size_t axis = 0; axis < 4; ++axis)
        n.centre[axis][i] = static_cast<float>(centre[static_cast<int>(axis)]);
    n.radius[i] = static_cast<float>(radius * (1 + kSlack) + kSlack * centre.lpNorm<1>());
    n.child[i] = child;
}

}  // namespace tesserae::render

// SPDX-License-Identifier: Apache-2.0
#include "render/scene/body_tree.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.hpp"

namespace tesserae::render {
namespace {

using Four = Eigen::Array4f;
constexpr float kInfiniteFloat = std::numeric_limits<float>::infinity();
constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
/// Part of a body's coordinates and size by which its bounds are widened: three times the rounding
/// of a double to a float, and a million times what any hit is out by.
constexpr double kWiden = 2e-7;
/// Part of a ray origin's coordinates by which spheres count as wider for it. As floats they shift
/// the ray by at most 2^-24 of their sum, a 33rd of this; a wider sphere only makes more
/// candidates.
constexpr double kOriginSlack = 2e-6;
/// No slope is less than this: it keeps the inverse finite, and a ray leaves its place by less than
/// the bounds' widening.
constexpr double kLeast = 1e-18;

struct Box {
    Four low = Four::Constant(kInfiniteFloat), high = Four::Constant(-kInfiniteFloat);

    void add(const Box& o) { low = low.min(o.low), high = high.max(o.high); }
    /// Half the content of the box's boundary: how often it is met by rays from everywhere.
    double half_boundary() const {
        const Eigen::Array4d e = (high - low).cast<double>();
        if (!(e[0] >= 0)) return 0;
        return e[0] * e[1] * (e[2] + e[3]) + (e[0] + e[1]) * e[2] * e[3];
    }
};

/// A body as the builder sees it.
struct Member {
    Box box;
    std::array<float, 5> key;  ///< what bodies are sorted by: the centre, the radius's logarithm
    float radius;
    std::uint32_t body;
};

Box box_of(const PlacedBodies& placed, const PlacedBody& body) {
    Vec4 half = Vec4::Constant(body.radius);
    if (!body.moves()) {
        Mat4 rotation = Mat4::Identity();
        if (body.turn != PlacedBody::kNotTurned) rotation = placed.turns[body.turn].transpose();
        half = std::visit([&](const auto& s) { return half_extents(s, rotation); }, *body.shape);
    }
    half.array() += kWiden * (body.centre.lpNorm<1>() + body.radius);
    Box box;
    box.low = (body.centre - half).cast<float>();
    box.high = (body.centre + half).cast<float>();
    return box;
}

Member member_of(const PlacedBodies& placed, std::uint32_t index) {
    const PlacedBody& body = placed.bodies[index];
    Member m;
    m.box = box_of(placed, body);
    for (std::size_t i = 0; i < 4; ++i)
        m.key[i] = static_cast<float>(body.centre[static_cast<int>(i)]);
    m.key[4] = static_cast<float>(std::log2(body.radius));
    m.radius = static_cast<float>(body.radius + kWiden * (body.centre.lpNorm<1>() + body.radius));
    m.body = index;
    return m;
}

/// Members [begin, end) and their bounds.
struct Part {
    std::size_t begin = 0, end = 0;
    Box box;

    std::size_t size() const { return end - begin; }
};

/// A node of the binary tree that becomes the wide one.
struct Branch {
    Part part;
    std::vector<Branch> halves;  ///< two, or none: a leaf
    /// Least cost of the branch as at most i + 1 children of a wide node.
    std::array<double, kLanes> cost;
};

/// Least cost of both halves as at most `places` children in all, and how many the first one takes.
struct Shares {
    double cost;
    std::size_t first;
};
Shares share(const Branch& branch, std::size_t places) {
    Shares best = {std::numeric_limits<double>::infinity(), 0};
    for (std::size_t first = 1; first < places; ++first) {
        const double cost =
            branch.halves[0].cost[first - 1] + branch.halves[1].cost[places - first - 1];
        if (cost < best.cost) best = {cost, first};
    }
    return best;
}

void set_costs(Branch& branch) {
    // A node's test and a leaf's take about the same time.
    branch.cost.fill(branch.part.box.half_boundary());
    if (branch.halves.empty()) return;
    branch.cost[0] += share(branch, kLanes).cost;
    for (std::size_t i = 1; i < kLanes; ++i)
        branch.cost[i] = std::min(branch.cost[i - 1], share(branch, i + 1).cost);
}

/// What stands for a branch among the children of a wide node when it may take `places` of them.
void collect(const Branch& branch, std::size_t places, std::vector<const Branch*>& children) {
    while (places > 1 && branch.cost[places - 1] == branch.cost[places - 2]) --places;
    if (places == 1) {
        children.push_back(&branch);
        return;
    }
    const std::size_t first = share(branch, places).first;
    collect(branch.halves[0], first, children);
    collect(branch.halves[1], places - first, children);
}

}  // namespace

/// Halves by the surface area heuristic, here the content of a box's three-dimensional boundary, in
/// bins, down to leaves; then makes of the binary tree the wide one of least expected cost.
/// Sources: Wald, On fast construction of SAH-based bounding volume hierarchies, 2007; Ylitie,
/// Karras and Laine, Efficient incoherent ray traversal on GPUs through compressed wide BVHs, 2017,
/// section 3 (the wide tree).
/// Beyond the sources, the size of the bodies is one more key to sort by: it parts huge bodies from
/// the small ones among them.
class BodyTreeBuilder {
  public:
    BodyTreeBuilder(BodyTree& tree, const PlacedBodies& placed) : tree_(tree), placed_(placed) {
        for (std::uint32_t i = 0; i < placed.bodies.size(); ++i)
            if (placed.bodies[i].radius < std::numeric_limits<double>::infinity())
                bounded_.push_back(i);
            else
                tree_.unbounded_.push_back(i);
        members_.resize(bounded_.size());
        tbb::parallel_for(std::size_t{0}, bounded_.size(),
                          [&](std::size_t i) { members_[i] = member_of(placed_, bounded_[i]); });
    }

    void build() {
        TSR_ASSERT(members_.size() <= BodyTree::kMostBodies);
        if (members_.empty()) return;
        Branch root;
        root.part = {0, members_.size(), {}};
        for (const Member& m : members_) root.part.box.add(m.box);
        divide(root, 0);
        add_node(root);
    }

  private:
    static constexpr int kBins = 16;
    /// Deeper than this, which takes bodies that grow by large factors, parts are halved.
    static constexpr int kMaxDepth = 48;
    /// Parts of this many bodies and more are divided in parallel.
    static constexpr std::size_t kParallel = 512;

    struct Split {
        double cost = std::numeric_limits<double>::infinity();
        int key = -1, bin = 0;  ///< the first bin of the upper half
        float low = 0, scale = 0;

        int bin_of(const Member& m) const {
            const float at = (m.key[static_cast<std::size_t>(key)] - low) * scale;
            return std::clamp(static_cast<int>(at), 0, kBins - 1);
        }
    };

    void divide(Branch& branch, int depth);
    std::pair<Part, Part> halves(const Part& part, bool by_cost);
    Split best_split(const Part& part) const;
    void try_key(const Part& part, Split split, Split& best) const;
    std::uint32_t add_node(const Branch& branch);
    std::uint32_t add_leaf(const Part& part);

    BodyTree& tree_;
    const PlacedBodies& placed_;
    std::vector<std::uint32_t> bounded_;
    std::vector<Member> members_;
};

void BodyTreeBuilder::divide(Branch& branch, int depth) {
    if (branch.part.size() > kLanes) {
        const auto [lower, upper] = halves(branch.part, depth < kMaxDepth);
        branch.halves.resize(2);
        branch.halves[0].part = lower;
        branch.halves[1].part = upper;
        const auto divide_half = [&](std::size_t i) { divide(branch.halves[i], depth + 1); };
        if (branch.part.size() >= kParallel)
            tbb::parallel_for(std::size_t{0}, std::size_t{2}, divide_half);
        else
            divide_half(0), divide_half(1);
    }
    set_costs(branch);
}

std::pair<Part, Part> BodyTreeBuilder::halves(const Part& part, bool by_cost) {
    const Split split = by_cost ? best_split(part) : Split{};
    const auto begin = members_.begin() + static_cast<std::ptrdiff_t>(part.begin);
    const auto end = members_.begin() + static_cast<std::ptrdiff_t>(part.end);
    // Where nothing tells the members apart, in the middle.
    std::size_t middle = part.begin + part.size() / 2;
    if (split.key >= 0)
        middle = static_cast<std::size_t>(
            std::partition(begin, end,
                           [&](const Member& m) { return split.bin_of(m) < split.bin; }) -
            members_.begin());
    Part lower{part.begin, middle, {}}, upper{middle, part.end, {}};
    for (std::size_t i = lower.begin; i < lower.end; ++i) lower.box.add(members_[i].box);
    for (std::size_t i = upper.begin; i < upper.end; ++i) upper.box.add(members_[i].box);
    return {lower, upper};
}

BodyTreeBuilder::Split BodyTreeBuilder::best_split(const Part& part) const {
    std::array<float, 5> low, high;
    low.fill(kInfiniteFloat), high.fill(-kInfiniteFloat);
    for (std::size_t i = part.begin; i < part.end; ++i)
        for (std::size_t k = 0; k < low.size(); ++k) {
            low[k] = std::min(low[k], members_[i].key[k]);
            high[k] = std::max(high[k], members_[i].key[k]);
        }
    Split best;
    for (std::size_t k = 0; k < low.size(); ++k) {
        Split split;
        split.key = static_cast<int>(k);
        split.low = low[k];
        split.scale = kBins / (high[k] - low[k]);
        if (high[k] > low[k] && split.scale < kInfiniteFloat) try_key(part, split, best);
    }
    return best;
}

/// Takes the best of the 15 splits between bins where it beats the best so far.
void BodyTreeBuilder::try_key(const Part& part, Split split, Split& best) const {
    std::array<Box, kBins> boxes;
    std::array<std::size_t, kBins> counts{};
    for (std::size_t i = part.begin; i < part.end; ++i) {
        const auto bin = static_cast<std::size_t>(split.bin_of(members_[i]));
        boxes[bin].add(members_[i].box);
        ++counts[bin];
    }
    // A leaf tests eight bodies in the time of one.
    const auto cost = [](const Box& box, std::size_t count) {
        return box.half_boundary() * static_cast<double>((count + kLanes - 1) / kLanes);
    };
    std::array<double, kBins> above{};
    Box box;
    std::size_t count = 0;
    for (std::size_t bin = kBins - 1; bin > 0; --bin) {
        box.add(boxes[bin]);
        count += counts[bin];
        above[bin] = cost(box, count);
    }
    box = {};
    count = 0;
    for (std::size_t bin = 1; bin < kBins; ++bin) {
        box.add(boxes[bin - 1]);
        count += counts[bin - 1];
        split.cost = cost(box, count) + above[bin];
        split.bin = static_cast<int>(bin);
        if (count > 0 && count < part.size() && split.cost < best.cost) best = split;
    }
}

std::uint32_t BodyTreeBuilder::add_node(const Branch& branch) {
    // The root is a node even where one leaf would do.
    std::vector<const Branch*> children;
    if (branch.halves.empty()) {
        children.push_back(&branch);
    } else {
        const std::size_t first = share(branch, kLanes).first;
        collect(branch.halves[0], first, children);
        collect(branch.halves[1], kLanes - first, children);
    }
    BodyTree::Node node{};
    for (std::size_t axis = 0; axis < 4; ++axis)
        for (std::size_t i = 0; i < kLanes; ++i) {
            node.boxes.sides[BodyTree::Boxes::low(axis) + i] = kInfiniteFloat;
            node.boxes.sides[BodyTree::Boxes::high(axis) + i] = -kInfiniteFloat;
        }
    for (std::size_t i = 0; i < children.size(); ++i) {
        const Part& part = children[i]->part;
        for (std::size_t axis = 0; axis < 4; ++axis) {
            node.boxes.sides[BodyTree::Boxes::low(axis) + i] = part.box.low[static_cast<int>(axis)];
            node.boxes.sides[BodyTree::Boxes::high(axis) + i] =
                part.box.high[static_cast<int>(axis)];
        }
    }
    const std::size_t index = tree_.nodes_.size();
    tree_.nodes_.push_back(node);
    for (std::size_t i = 0; i < children.size(); ++i) {
        const Branch& child = *children[i];
        const std::uint32_t at = child.halves.empty() ? add_leaf(child.part) : add_node(child);
        tree_.nodes_[index].child[i] = at;
        if (child.halves.empty()) tree_.nodes_[index].leaves |= 1u << i;
    }
    return static_cast<std::uint32_t>(index);
}

std::uint32_t BodyTreeBuilder::add_leaf(const Part& part) {
    BodyTree::Leaf leaf{};
    leaf.radius = all_lanes(kNoNumber);
    for (std::size_t i = 0; i < part.size(); ++i) {
        const Member& m = members_[part.begin + i];
        for (std::size_t axis = 0; axis < 4; ++axis) leaf.centre[axis][i] = m.key[axis];
        leaf.radius[i] = m.radius;
        leaf.body[i] = m.body;
    }
    tree_.leaves_.push_back(leaf);
    return static_cast<std::uint32_t>(tree_.leaves_.size() - 1);
}

BodyTree::BodyTree(const PlacedBodies& placed) { BodyTreeBuilder(*this, placed).build(); }

BodyTree::Line BodyTree::line_of(const Ray& ray) {
    // All four axes at once, and no branch: which side is first is a toss.
    simd::Double4 o, d;
    std::memcpy(&o, ray.origin.data(), sizeof o);
    std::memcpy(&d, ray.direction.data(), sizeof d);
    const simd::Double4 least = simd::all_four(kLeast);
    const simd::Mask4 is_forward = d > -least;
    const simd::Double4 inverse = 1 / (is_forward ? (d > least ? d : least) : d);
    const double reach = ray.origin.lpNorm<1>(), slack = kWiden * reach;
    const simd::Double4 shift = -o * inverse, widening = slack * (is_forward ? inverse : -inverse);
    Line line;
    const auto write = [](const simd::Double4& v, std::array<float, 4>& to) {
        const auto floats = __builtin_convertvector(v, simd::Float4);
        std::memcpy(to.data(), &floats, sizeof floats);
    };
    write(o, line.origin);
    write(d, line.direction);
    write(inverse, line.inverse);
    write(shift - widening, line.enter_shift);
    write(shift + widening, line.leave_shift);
    const simd::Mask4 low = {Boxes::low(0), Boxes::low(1), Boxes::low(2), Boxes::low(3)};
    const simd::Mask4 high = {Boxes::high(0), Boxes::high(1), Boxes::high(2), Boxes::high(3)};
    const auto sides = __builtin_convertvector(is_forward ? low : high, simd::Unsigned4);
    std::memcpy(line.enter_side.data(), &sides, sizeof sides);
    line.slack = static_cast<float>(kOriginSlack * reach);
    line.limit = rounded_up(ray.limit);
    return line;
}

BodyTree::Flare BodyTree::flare_of(const Ray& axis, const Cone& cone) {
    const double reach = axis.origin.lpNorm<1>(), slack = kWiden * reach;
    const double tangent = cone.sine > 0 ? (1 + kWiden) * cone.sine / cone.cosine : 0;
    Flare flare;
    for (std::size_t i = 0; i < 4; ++i) {
        const double o = axis.origin[static_cast<int>(i)], d = axis.direction[static_cast<int>(i)];
        flare.origin[i] = static_cast<float>(o);
        flare.direction[i] = static_cast<float>(d);
        const double least = d - tangent, most = d + tangent;
        const bool forward = least > -kLeast, backward = !forward && most < kLeast;
        flare.opens[i] = !forward && !backward;
        // A point is beyond the low side from where o + t most reaches it, and before the high side
        // up to where o + t least does.
        const double to_low = 1 / (backward ? std::min(most, -kLeast) : std::max(most, kLeast));
        const double to_high =
            tangent == 0 ? to_low
                         : 1 / (forward ? std::max(least, kLeast) : std::min(least, -kLeast));
        const auto side = [&](std::uint32_t which, double inverse, double widening) {
            return Side{which, static_cast<float>(inverse),
                        static_cast<float>(-o * inverse + widening * std::abs(inverse))};
        };
        flare.enter[i] =
            backward ? side(Boxes::high(i), to_high, -slack) : side(Boxes::low(i), to_low, -slack);
        flare.leave[i] = backward ? side(Boxes::low(i), to_low, slack)
                                  : side(Boxes::high(i), to_high, flare.opens[i] ? -slack : slack);
    }
    flare.slack = static_cast<float>(kOriginSlack * reach);
    flare.limit = rounded_up(kMiss);
    flare.sine = static_cast<float>(cone.sine);
    flare.cosine = static_cast<float>(cone.cosine);
    return flare;
}

std::uint64_t BodyTree::fingerprint() const {
    std::uint64_t hash = 14695981039346656037u;
    const auto add = [&](const auto& part) {
        const auto* bytes = reinterpret_cast<const unsigned char*>(&part);
        for (std::size_t i = 0; i < sizeof part; ++i) hash = (hash ^ bytes[i]) * 1099511628211u;
    };
    for (const Node& node : nodes_) add(node);
    for (const Leaf& leaf : leaves_) add(leaf);
    return hash;
}

}  // namespace tesserae::render

// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/generate.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.hpp"
#include "scenes/load/effective.hpp"

namespace tesserae::scenes {
namespace {

using Counts = std::array<std::uint64_t, 4>;

/// Bodies on a grid, so many to fill it axis by axis.
struct Grid {
    std::array<int, 4> order;  ///< axes, the one that fills first in front
    Counts size;               ///< by axis; of the last in `order` as many as it takes
    Vec4 spacing, corner;      ///< [m]
};

/// A piece of a grid without gaps.
struct Block {
    Counts count;
    Vec4 centre;
};

/// At most four: what is full, then what is left over in one axis fewer each.
std::vector<Block> blocks_of(const Grid& grid, std::uint64_t bodies) {
    std::vector<Block> blocks;
    Counts first = {0, 0, 0, 0};
    for (int depth = 3; depth >= 0 && bodies > 0; --depth) {
        Counts count = {1, 1, 1, 1};
        std::uint64_t layer = 1;
        for (int i = 0; i < depth; ++i) {
            const auto axis = static_cast<std::size_t>(grid.order[static_cast<std::size_t>(i)]);
            count[axis] = grid.size[axis];
            layer *= grid.size[axis];
        }
        const auto axis = static_cast<std::size_t>(grid.order[static_cast<std::size_t>(depth)]);
        count[axis] = bodies / layer;
        if (count[axis] > 0) {
            Vec4 middle;
            for (std::size_t i = 0; i < 4; ++i)
                middle[static_cast<int>(i)] =
                    static_cast<double>(first[i]) + 0.5 * (static_cast<double>(count[i]) - 1);
            blocks.push_back({count, grid.corner + middle.cwiseProduct(grid.spacing)});
        }
        first[axis] = count[axis];
        bodies %= layer;
    }
    return blocks;
}

/// Decimals without what rounding of doubles leaves at their end.
double rounded(double value) {
    constexpr double kParts = 1e9;
    return std::round(value * kParts) / kParts + 0.0;  // -0 becomes 0
}
std::string rounded_text(double value) { return toml_text(rounded(value)); }
std::string rounded_text(const Vec4& value) {
    return toml_text(Vec4(value.unaryExpr([](double v) { return rounded(v); })));
}

/// The least n with n^3 >= count.
std::uint64_t cube_side(std::uint64_t count) {
    auto n = static_cast<std::uint64_t>(std::cbrt(static_cast<double>(count)));
    while (n * n * n < count) ++n;
    return std::max<std::uint64_t>(n, 1);
}

/// Bodies that joints connect: scene files have a limited number of joints.
constexpr std::uint64_t kMostJoined = 80000;

constexpr const char* kBallText = "shape = \"hypersphere\"\nradius = 0.5\n";
constexpr const char* kPlainBox = "shape = \"hyperbox\"\nsize = [1, 1, 1, 1]\n";
constexpr const char* kUnevenBox =
    "shape = \"hyperbox\"\nsize = [0.9, 0.5, 0.7, 0.6]\n"
    "rotation = { xy = 20, zw = 35 }\n";

std::string lattice(const Block& b, const Vec4& spacing, double jitter, std::string_view body) {
    return fmt::format(
        "\n[[lattice]]\n{}count = [{}, {}, {}, {}]\nspacing = {}\nposition = {}\n"
        "jitter = {}\nmaterial = \"bodies\"\n",
        body, b.count[0], b.count[1], b.count[2], b.count[3], rounded_text(spacing),
        rounded_text(b.centre), jitter);
}

std::string lattices(const Grid& grid, std::uint64_t bodies, double jitter, std::string_view body) {
    std::string text;
    for (const Block& block : blocks_of(grid, bodies))
        text += lattice(block, grid.spacing, jitter, body);
    return text;
}

/// A plane whose free side faces the origin, unseen.
std::string wall(int axis, double side, double distance, std::string_view surface) {
    return fmt::format(
        "\n[[body]]\nname = \"wall-{}{}\"\nshape = \"hyperplane\"\nnormal = {}\n"
        "offset = {}\nvisible = false\n{}",
        side > 0 ? "below-" : "above-", "xyzw"[axis],
        rounded_text(Vec4((side * Vec4::Unit(axis)).array() + 0)), rounded_text(-distance),
        surface);
}

std::string floor_and_walls(double half_width) {
    std::string text =
        "\n[[body]]\nname = \"floor\"\nshape = \"hyperplane\"\n"
        "normal = [0, 1, 0, 0]\noffset = 0\nmaterial = \"floor\"\n";
    if (half_width > 0)
        for (const int axis : {0, 2, 3})
            for (const double side : {1.0, -1.0}) text += wall(axis, side, half_width, "");
    return text;
}

// Where the camera of a generated scene stands, seen from the middle of its block's floor.
/// Times the larger of the block's height and width, so that all of it is in the picture, and so
/// much more [m], so that a single body does not fill it: the distance.
constexpr double kDistance = 1.7, kMoreDistance = 4;
/// Parts of the distance: beside the block, above it, before it.
constexpr double kBeside = 0.35, kAbove = 0.25, kBefore = 0.9;
/// Parts of the height: by which the camera stands still higher, and where it looks, a little below
/// the middle, since heaps fall.
constexpr double kEyeHeight = 0.6, kTargetHeight = 0.4;

/// The tables that all have in common; the camera looks at a block of this height and width, in the
/// slice at `fourth`.
std::string stage(std::string_view name, std::string_view physics, double height, double width,
                  double fourth = 0) {
    const double far = kDistance * std::max(width, height) + kMoreDistance;
    const Vec4 position(kBeside * far, kEyeHeight * height + kAbove * far, -kBefore * far, fourth);
    return fmt::format(R"([scene]
name = "{}"

[physics]
{}
[camera]
position = {}
look_at = {}
field_of_view = 45

[render]
samples = 4

[[light]]
type = "sun"
direction = [0.5, -1, 0.6, 0.2]
color = [1, 0.92, 0.8]
strength = 4.5
angle = 2

[[light]]
type = "sky"
color = [0.6, 0.75, 1]
strength = 0.4

[[material]]
name = "floor"
albedo = [0.5, 0.5, 0.48]
pattern = "checker"
pattern_albedo = [0.4, 0.4, 0.4]
pattern_size = 2

[[material]]
name = "bodies"
albedo = [0.85, 0.45, 0.12]
pattern = "stripes"
pattern_albedo = [0.93, 0.86, 0.75]
pattern_size = 0.25
)",
                       name, physics, rounded_text(position),
                       rounded_text(Vec4(0, kTargetHeight * height, 0, fourth)));
}

std::string gas(std::uint64_t bodies) {
    // Two grids, each in the gaps of the other, that move against each other.
    constexpr double kSpacing = 2.4;
    const std::uint64_t half = bodies / 2;
    std::uint64_t n = 1;
    while (n * n * n * n < bodies - half) ++n;
    const double width = kSpacing * static_cast<double>(n), first = 0.5 * (kSpacing - width);
    Grid grid = {{0, 1, 2, 3},
                 {n, n, n, n},
                 Vec4::Constant(kSpacing),
                 Vec4::Constant(first - 0.25 * kSpacing)};
    // The slice shows one of the grids first.
    std::string text =
        stage("gas", "gravity = [0, 0, 0, 0]\nduration = 2\n", 0, width, 0.25 * kSpacing);
    constexpr const char* kElastic = "restitution = 1\nfriction = 0\n";
    for (int axis = 0; axis < 4; ++axis)
        for (const double side : {1.0, -1.0}) text += wall(axis, side, 0.5 * width + 1, kElastic);
    const auto body = [&](const char* velocity) {
        return fmt::format("{}velocity = {}\n{}", kBallText, velocity, kElastic);
    };
    text += lattices(grid, bodies - half, 0.05, body("[3, 1, -2, 2]"));
    grid.corner.array() += 0.5 * kSpacing;
    return text + lattices(grid, half, 0.05, body("[-3, -1, 2, -2]"));
}

/// Where the bodies of a heap begin, between walls: half as high as wide, once it has fallen.
struct HeapGrid {
    Grid grid;
    double width, height;

    explicit HeapGrid(std::uint64_t bodies) {
        constexpr double kSpacing = 1.1;
        const std::uint64_t n = cube_side(static_cast<std::uint64_t>(
            std::ceil(std::pow(2.0 * static_cast<double>(bodies), 0.75))));
        width = kSpacing * static_cast<double>(n);
        height = kSpacing * static_cast<double>(bodies / (n * n * n) + 1);
        const double first = 0.5 * (kSpacing - width);
        grid = {{0, 2, 3, 1}, {n, 0, n, n}, Vec4::Constant(kSpacing), {first, 0.7, first, first}};
    }
    std::string stage(std::string_view name) const {
        return tesserae::scenes::stage(name, "duration = 4\n", height, width) +
               floor_and_walls(0.5 * width + 0.1);
    }
    /// Of a body by its number, w first.
    Vec4 place(std::uint64_t number) const {
        const std::uint64_t n = grid.size[0];
        const Vec4 steps(static_cast<double>(number / n / n % n),
                         static_cast<double>(number / n / n / n),
                         static_cast<double>(number / n % n), static_cast<double>(number % n));
        return grid.corner + steps.cwiseProduct(grid.spacing);
    }
};

std::string heap(std::string_view name, std::uint64_t bodies, const char* body) {
    const HeapGrid heap(bodies);
    return heap.stage(name) + lattices(heap.grid, bodies, 0.045, body);
}

constexpr const char* kConvex[] = {
    "shape = \"polychoron\"\nregular = \"24-cell\"\nradius = 0.5\n",
    "shape = \"duocylinder\"\nradii = [0.36, 0.34]\n",
    "shape = \"polychoron\"\nregular = \"8-cell\"\nradius = 0.5\n",
    "shape = \"spherinder\"\nradius = 0.36\nheight = 0.7\n",
    "shape = \"polychoron\"\nregular = \"120-cell\"\nradius = 0.5\n",
    "shape = \"duoprism\"\npolygons = [5, 6]\nradii = [0.38, 0.36]\n",
    "shape = \"polychoron\"\nregular = \"16-cell\"\nradius = 0.5\n",
    "shape = \"cubinder\"\nradius = 0.35\nsize = [0.6, 0.5]\n",
    "shape = \"polychoron\"\nregular = \"600-cell\"\nradius = 0.5\n",
    "shape = \"polychoron\"\nregular = \"5-cell\"\nradius = 0.5\n",
};

/// Every kind in turn, each body turned another way; of many bodies a row along w is alike.
std::string polychora(std::uint64_t bodies) {
    const HeapGrid heap(bodies);
    constexpr std::uint64_t kMostSingle = 2000;
    const std::uint64_t row = bodies <= kMostSingle ? 1 : heap.grid.size[3];
    std::string text = heap.stage("polychora");
    for (std::uint64_t first = 0, i = 0; first < bodies; first += row, ++i) {
        const std::uint64_t count = std::min(row, bodies - first);
        Vec4 centre = heap.place(first);
        centre[3] += 0.5 * static_cast<double>(count - 1) * heap.grid.spacing[3];
        // Multiples of irrational parts of a turn come near none before.
        const auto turn = [&](double part) {
            return std::round(360 * std::fmod(part * static_cast<double>(i), 1.0));
        };
        const std::string body = fmt::format(
            "{}rotation = {{ xy = {}, xw = {}, yz = {} }}\n", kConvex[i % std::size(kConvex)],
            turn(0.7548776662466927), turn(0.5698402909980532), turn(0.6180339887498949));
        text += lattice({{1, 1, 1, count}, centre}, heap.grid.spacing, 0.045, body);
    }
    return text;
}

std::string stacks(std::uint64_t bodies) {
    constexpr double kApart = 2;
    const std::uint64_t n = cube_side((bodies + 9) / 10);
    const double width = kApart * static_cast<double>(n), first = 0.5 * (kApart - width);
    const Grid grid = {
        {1, 0, 2, 3}, {n, 10, n, n}, {kApart, 1, kApart, kApart}, {first, 0.5, first, first}};
    return stage("stacks", "duration = 2\n", 10, width) + floor_and_walls(0) +
           lattices(grid, bodies, 0, kPlainBox);
}

std::string pyramid(std::uint64_t bodies) {
    std::uint64_t n = 1;
    while (n * (n + 1) / 2 < bodies) ++n;
    const auto height = static_cast<double>(n);
    std::string text =
        stage("pyramid", "duration = 2\n", height, 1.1 * height) + floor_and_walls(0);
    for (std::uint64_t row = 0; bodies > 0; ++row) {
        const std::uint64_t length = std::min(bodies, n - row);
        bodies -= length;
        text += lattice({{length, 1, 1, 1}, {0, 0.5 + static_cast<double>(row), 0, 0}},
                        {1.1, 1, 1, 1}, 0, kPlainBox);
    }
    return text;
}

/// @param keys   of its type
std::string joint(std::string_view type, std::string_view a, std::string_view b, const Vec4& anchor,
                  std::string_view keys = "") {
    const std::string other = b.empty() ? "" : fmt::format("b = \"{}\"\n", b);
    return fmt::format("\n[[joint]]\ntype = \"{}\"\na = \"{}\"\n{}anchor = {}\n{}", type, a, other,
                       rounded_text(anchor), keys);
}

std::string chain(std::uint64_t bodies) {
    constexpr double kLink = 0.5;
    const double length = kLink * static_cast<double>(bodies), height = 1 + 1.2 * length;
    std::string text = stage("chain", "duration = 4\n", height, length) + floor_and_walls(0);
    text += lattice({{bodies, 1, 1, 1}, {0, height, 0, 0}}, {kLink, 1, 1, 1}, 0,
                    "name = \"joined\"\nshape = \"hypercapsule\"\nradius = 0.06\n"
                    "height = 0.38\nrotation = { xy = 90 }\n");
    for (std::uint64_t i = 0; i < bodies; ++i)
        text += joint("point", fmt::format("joined.{}", i),
                      i > 0 ? fmt::format("joined.{}", i - 1) : std::string(),
                      {kLink * static_cast<double>(i) - 0.5 * length, height, 0, 0});
    return text;
}

/// Planks along the lower part of a circle: a straight bridge could not bear its weight.
std::string bridge(std::uint64_t bodies) {
    constexpr double kPlank = 0.5, kHalfAngle = 0.6;  // [m, rad]
    const auto count = static_cast<double>(bodies);
    const double step = 2 * kHalfAngle / count, radius = 0.5 * kPlank / std::sin(0.5 * step);
    const auto place = [&](double at, double far) {
        const double angle = step * at - kHalfAngle;
        return Vec4(far * std::sin(angle), 1.3 * radius - far * std::cos(angle), 0, 0);
    };
    std::string text = stage("bridge", "duration = 4\n", 0.5 * radius, radius) + floor_and_walls(0);
    const auto name = [](std::uint64_t i) { return fmt::format("plank-{}", i); };
    for (std::uint64_t i = 0; i < bodies; ++i) {
        const double at = static_cast<double>(i) + 0.5;
        const double degrees = (step * at - kHalfAngle) * 180 / std::numbers::pi;
        text += fmt::format(
            "\n[[body]]\nname = \"{}\"\nshape = \"hyperbox\"\nsize = [0.46, 0.1, 1, 1]\n"
            "position = {}\nrotation = {{ xy = {} }}\nmaterial = \"bodies\"\n",
            name(i), rounded_text(place(at, radius * std::cos(0.5 * step))), rounded_text(degrees));
    }
    for (std::uint64_t i = 0; i <= bodies; ++i)
        text += joint("hinge", name(std::min(i, bodies - 1)),
                      i > 0 && i < bodies ? name(i - 1) : std::string(),
                      place(static_cast<double>(i), radius), "plane = \"xy\"\n");
    return text;
}

/// Rows of balls, the last one as long as what is left; the first row is held.
std::string grid(std::uint64_t bodies) {
    constexpr double kApart = 0.5;
    std::uint64_t n = 1;
    while (n * n < bodies) ++n;
    const std::uint64_t rows = bodies / n, rest = bodies % n;
    const double width = kApart * static_cast<double>(n), height = 1 + width;
    const Vec4 corner(-0.5 * (width - kApart), height, -0.5 * (width - kApart), 0);
    const auto place = [&](double x, double z) { return Vec4(corner + kApart * Vec4(x, 0, z, 0)); };
    const auto balls = [&](const char* name, std::uint64_t across, std::uint64_t deep, double z) {
        const Vec4 centre = place(0.5 * (static_cast<double>(across) - 1),
                                  z + 0.5 * (static_cast<double>(deep) - 1));
        const std::string body =
            fmt::format("name = \"{}\"\nshape = \"hypersphere\"\nradius = 0.15\n", name);
        return lattice({{across, 1, deep, 1}, centre}, {kApart, 1, kApart, 1}, 0, body);
    };
    std::string text = stage("grid", "duration = 4\n", height, width) + floor_and_walls(0) +
                       balls("joined", n, rows, 0);
    if (rest > 0) text += balls("rest", rest, 1, static_cast<double>(rows));
    // A lattice counts its last axis first.
    const auto name = [&](std::uint64_t x, std::uint64_t z) {
        return z < rows ? fmt::format("joined.{}", x * rows + z) : fmt::format("rest.{}", x);
    };
    for (std::uint64_t x = 0; x < n; ++x)
        text += joint("point", name(x, 0), "", place(static_cast<double>(x), -0.5));
    for (std::uint64_t i = 1; i < bodies; ++i) {
        const std::uint64_t x = i % n, z = i / n;
        const auto at_x = static_cast<double>(x), at_z = static_cast<double>(z);
        if (x > 0) text += joint("point", name(x, z), name(x - 1, z), place(at_x - 0.5, at_z));
        if (z > 0) text += joint("point", name(x, z), name(x, z - 1), place(at_x, at_z - 0.5));
    }
    return text;
}

}  // namespace

std::string generated_scene(std::string_view name, std::uint64_t bodies) {
    TSR_ASSERT(bodies > 0);
    const std::string head = fmt::format("# tesserae generate {} --bodies {}\n\n", name, bodies);
    if (name == "gas") return head + gas(bodies);
    if (name == "pile") return head + heap(name, bodies, kBallText);
    if (name == "boxes") return head + heap(name, bodies, kUnevenBox);
    if (name == "polychora") return head + polychora(bodies);
    if (name == "stacks") return head + stacks(bodies);
    if (name == "pyramid") return head + pyramid(bodies);
    if (bodies > kMostJoined)
        throw InputError(fmt::format("--bodies {}: a {} has at most {}, as each joint is a table",
                                     bodies, name, kMostJoined));
    if (name == "chain") return head + chain(bodies);
    if (name == "grid") return head + grid(bodies);
    TSR_ASSERT(name == "bridge");
    return head + bridge(bodies);
}

}  // namespace tesserae::scenes

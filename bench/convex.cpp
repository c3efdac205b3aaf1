// SPDX-License-Identifier: Apache-2.0
// The general pair function of convex bodies: pairs of 24-cells, boxes beside their own function,
// cubes and icosahedra beside Bullet's and libccd's; what separating axes would cost; and towers of
// 24-cells and boxes. One thread, all in turns. See README.md.

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string>

#include "bench/convex_pairs.hpp"
#include "bench/hulls_in_3d.hpp"
#include "bench/resting_towers.hpp"
#include "bench/thread_time.hpp"
#include "core/contact/hyperbox_hyperbox.hpp"
#include "parallel/threads.hpp"

namespace tesserae::bench {
namespace {

constexpr int kRepeats = 21;
constexpr std::size_t kPairs = 2000;
/// Pairs are copied this many at a time, untimed, as in contacts.cpp.
constexpr std::size_t kBatch = 500;
constexpr int kSolids = 32;
/// Distances that differ by more of the size are counted.
constexpr double kOff = 2e-5;
/// libccd's default, and one that is fit for small overlaps [m^2].
constexpr double kCcdTolerance = 1e-4, kTightTolerance = 1e-10;
constexpr int kSettlingSteps = 480, kStepsOfRepeat = 4;

/// What is measured, in turns, and what is known already.
class Table {
  public:
    void measure(const std::string& name, const std::string& quantity,
                 std::function<double()> work) {
        rows_.push_back({name + "," + quantity, std::move(work), {}, false});
    }
    void note(const std::string& name, const std::string& quantity, double value) {
        rows_.push_back({name + "," + quantity, nullptr, {value}, false});
    }
    /// What is known in the end.
    void note_last(const std::string& name, const std::string& quantity,
                   std::function<double()> value) {
        rows_.push_back({name + "," + quantity, std::move(value), {}, true});
    }
    void run() {
        for (int repeat = -1; repeat < kRepeats; ++repeat)
            for (Row& row : rows_) {
                if (!row.work || row.is_last) continue;
                const double value = row.work();
                if (repeat >= 0) row.values.push_back(value);  // before, memory is taken
            }
        fmt::print("benchmark,quantity,median,least,spread_percent\n");
        for (Row& row : rows_) {
            std::vector<double>& all = row.values;
            if (row.is_last) all = {row.work()};
            std::sort(all.begin(), all.end());
            const std::size_t n = all.size();
            const double median = all[n / 2], spread = all[3 * n / 4] - all[n / 4];
            const bool varies = n > 1;
            fmt::print("{},{:.4g},{},{}\n", row.name, median,
                       varies ? fmt::format("{:.4g}", all[0]) : "",
                       varies ? fmt::format("{:.1f}", 100 * spread / median) : "");
        }
    }

  private:
    struct Row {
        std::string name;
        std::function<double()> work;
        std::vector<double> values;
        bool is_last = false;
    };
    std::vector<Row> rows_;
};

/// What a call returns goes here, so that it is made.
volatile double sink;

/// Processor time of a call, the mean over the pairs [ns].
template <class Pair, class Call>
double time_per_pair(const std::vector<Pair>& list, const Call& call) {
    double time = 0, sum = 0;
    for (std::size_t first = 0; first < list.size(); first += kBatch) {
        const auto begin = list.begin() + static_cast<std::ptrdiff_t>(first);
        const std::vector<Pair> batch(begin, begin + kBatch);
        const double begun = thread_time();
        for (const Pair& pair : batch) sum += call(pair);
        time += thread_time() - begun;
    }
    sink = sum;
    return 1e9 * time / static_cast<double>(list.size());
}

template <class Pair>
using List = std::shared_ptr<const std::vector<Pair>>;
using ConvexList = List<ConvexPair>;

template <class Draw>
auto draw_list(const Draw& draw) {
    std::vector<decltype(draw())> list;
    while (list.size() < kPairs) list.push_back(draw());
    return std::make_shared<const std::vector<decltype(draw())>>(std::move(list));
}

/// Rows of a function of pairs: its time, and what it returns on average if that is `quantity`.
template <class Pair, class Call>
void add_calls(Table& table, const std::string& name, const List<Pair>& list, const Call& call,
               const std::string& quantity = "") {
    table.measure(name, "ns_per_pair", [list, call] { return time_per_pair(*list, call); });
    if (quantity.empty()) return;
    double sum = 0;
    for (const Pair& pair : *list) sum += call(pair);
    table.note(name, quantity, sum / static_cast<double>(list->size()));
}

/// Calls find(pair, list) and returns the number of contacts.
template <class Find>
auto counting(const Find& find) {
    return [find, list = std::make_shared<std::vector<Contact>>()](const ConvexPair& pair) {
        list->clear();
        find(pair, *list);
        return static_cast<double>(list->size());
    };
}

/// The one way in, for all shapes.
auto whole_contacts(double margin_part) {
    return counting([=](const ConvexPair& p, std::vector<Contact>& list) {
        find_contacts(0, *p.a.shape, {p.a.position, p.a.rotor}, 1, *p.b.shape,
                      {p.b.position, p.b.rotor}, margin_part * p.size(), list);
    });
}

// ---- two 24-cells, also with the last step's direction ----------------------------------------

constexpr double kNoMargin = 0, kMarginOfAll = 0.1;

template <class S>
void add_distances(Table& table, const std::string& name, const ConvexList& list) {
    add_calls(table, name + "/distance", list, [](const ConvexPair& pair) {
        return separation_of_pair<S>(pair, pair.between()).distance;
    });
    const auto count_rounds = [&](const std::string& way, bool is_warm) {
        double calls = 0;
        for (const ConvexPair& p : *list)
            calls += rounds_of<S>(p, is_warm ? p.last_normal : p.between());
        table.note(name + way, "rounds_per_pair_by_supports",
                   calls / static_cast<double>(list->size()));
    };
    if constexpr (std::derived_from<S, HullShape>)
        add_calls(table, name + "/distance_by_supports", list, [](const ConvexPair& pair) {
            return separation_by_supports<S>(pair, pair.between()).distance;
        });
    count_rounds("/distance", false);
    if ((*list)[0].last_normal.isZero(0)) return;
    add_calls(table, name + "/distance_warm", list, [](const ConvexPair& pair) {
        return separation_of_pair<S>(pair, pair.last_normal).distance;
    });
    count_rounds("/distance_warm", true);
}

void add_24_cells(Table& table, Random& random) {
    const std::vector<ConvexSolid> solids = cells_24(kSolids);
    const auto draw = [&](Range range) {
        return draw_list([&] { return random_pair<Polychoron>(random, solids, range, 4); });
    };
    const ConvexList apart = draw(kApart), overlapping = draw(kOverlapping);
    const std::string points = "points_per_pair";
    add_distances<Polychoron>(table, "24_cells/apart", apart);
    add_calls(table, "24_cells/apart/contacts", apart, whole_contacts(kNoMargin), points);
    add_calls(table, "24_cells/apart/contacts_in_margin", apart, whole_contacts(kMarginOfAll),
              points);
    add_distances<Polychoron>(table, "24_cells/overlapping", overlapping);
    add_calls(table, "24_cells/overlapping/contacts", overlapping, whole_contacts(kNoMargin),
              points);
    add_calls(table, "24_cells/overlapping/contacts_warm", overlapping,
              counting([](const ConvexPair& pair, std::vector<Contact>& list) {
                  contacts_from<Polychoron>(pair, pair.last_normal, list);
              }),
              points);
}

// ---- boxes by the general function and by their own -------------------------------------------

auto own_contacts(double margin_part) {
    return counting([=](const ConvexPair& p, std::vector<Contact>& list) {
        PairContacts out{0, 1, false, list};
        contacts_between(std::get<Hyperbox>(*p.a.shape), {p.a.position, p.a.rotor},
                         std::get<Hyperbox>(*p.b.shape), {p.b.position, p.b.rotor},
                         margin_part * p.size(), out);
    });
}
auto general_box_contacts(double margin_part) {
    return counting([=](const ConvexPair& p, std::vector<Contact>& list) {
        PairContacts out{0, 1, false, list};
        general_contacts(std::get<Hyperbox>(*p.a.shape), {p.a.position, p.a.rotor},
                         std::get<Hyperbox>(*p.b.shape), {p.b.position, p.b.rotor},
                         margin_part * p.size(), out);
    });
}

/// The least separation that the boxes' own function finds.
double own_separation(const ConvexPair& p) {
    std::vector<Contact> list;
    PairContacts out{0, 1, false, list};
    contacts_between(std::get<Hyperbox>(*p.a.shape), {p.a.position, p.a.rotor},
                     std::get<Hyperbox>(*p.b.shape), {p.b.position, p.b.rotor}, p.size(), out);
    double least = std::numeric_limits<double>::infinity();
    for (const Contact& contact : list) least = std::min(least, contact.separation);
    return least;
}

void add_boxes(Table& table, Random& random) {
    const std::vector<ConvexSolid> solids = random_boxes(random, kSolids);
    const auto draw = [&](Range range) {
        return draw_list([&] { return random_pair<Hyperbox>(random, solids, range, 4); });
    };
    const std::vector<std::pair<std::string, ConvexList>> sets = {
        {"apart", draw(kApart)},
        {"overlapping", draw(kOverlapping)},
        {"resting", draw_list([&] { return resting_boxes(random); })}};
    for (const auto& [set, list] : sets) {
        const std::string name = "boxes/" + set, points = "points_per_pair";
        add_distances<Hyperbox>(table, name, list);
        add_calls(table, name + "/general", list, general_box_contacts(kNoMargin), points);
        add_calls(table, name + "/own", list, own_contacts(kNoMargin), points);
        if (set == "apart") {
            add_calls(table, name + "/general_in_margin", list, general_box_contacts(kMarginOfAll),
                      points);
            add_calls(table, name + "/own_in_margin", list, own_contacts(kMarginOfAll), points);
        }
        double worst = 0;
        for (const ConvexPair& p : *list) {
            const double general = separation_of_pair<Hyperbox>(p, p.between()).distance;
            worst = std::max(worst, std::abs(general - own_separation(p)) / p.size());
        }
        table.note(name, "worst_difference", worst);
    }
}

// ---- hulls beside Bullet and libccd -----------------------------------------------------------

/// What distances are compared with: apart ours, in overlap that of all separating axes.
std::vector<double> true_distances(const std::vector<ConvexPair>& ours,
                                   const std::vector<HullPair>& theirs, bool is_apart) {
    std::vector<double> all;
    for (std::size_t i = 0; i < ours.size(); ++i)
        all.push_back(is_apart ? separation_of_pair<Polychoron>(ours[i], ours[i].between()).distance
                               : distance_by_all_axes(theirs[i]));
    return all;
}

/// How far distances are off, in parts of the size: the worst, and how many by more
/// than kOff.
template <class Pair, class Distance>
void add_errors(Table& table, const std::string& name, const List<Pair>& list,
                const std::vector<double>& truth, const Distance& distance) {
    double above = 0, below = 0;
    int off = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double part = (distance((*list)[i]) - truth[i]) / (*list)[i].size();
        above = std::max(above, part), below = std::max(below, -part);
        if (std::abs(part) > kOff) ++off;
    }
    table.note(name, "worst_above", above);
    table.note(name, "worst_below", below);
    table.note(name, "off_percent", 100.0 * off / static_cast<double>(truth.size()));
}

void add_hulls(Table& table, Random& random, const std::string& kind, const Hulls& hulls,
               HullsInBullet& bullet, const HullsInCcd& ccd, const HullsInCcd& tight) {
    const auto distance = [&bullet](const HullPair& pair) { return bullet.distance(pair); };
    const auto clipped = [&bullet](const HullPair& pair) {
        return static_cast<double>(bullet.contacts(pair, false));
    };
    const auto by_axes = [&bullet](const HullPair& pair) {
        return static_cast<double>(bullet.contacts(pair, true));
    };
    const auto polytope = [&ccd](const HullPair& pair) { return -ccd.overlap(pair); };
    const auto tight_polytope = [&tight](const HullPair& pair) { return -tight.overlap(pair); };
    const auto portals = [&ccd](const HullPair& pair) { return -ccd.overlap_by_portals(pair); };
    for (const bool is_apart : {true, false}) {
        const std::string name = kind + (is_apart ? "/apart" : "/overlapping");
        const ConvexList ours = draw_list([&] {
            return random_pair<Polychoron>(random, hulls.solids, is_apart ? kApart : kOverlapping,
                                           3);
        });
        std::vector<HullPair> list;
        for (const ConvexPair& p : *ours)
            list.push_back({PlacedHull(hulls, p.a), PlacedHull(hulls, p.b), p.size()});
        const auto theirs = std::make_shared<const std::vector<HullPair>>(std::move(list));

        const std::vector<double> truth = true_distances(*ours, *theirs, is_apart);

        add_distances<Polychoron>(table, name, ours);
        if (!is_apart)
            add_errors(table, name + "/distance", ours, truth, [](const ConvexPair& p) {
                return separation_of_pair<Polychoron>(p, p.between()).distance;
            });
        add_calls(table, name + "/contacts", ours, whole_contacts(kNoMargin), "points_per_pair");
        if (is_apart) {
            add_calls(table, name + "/flat_distance", theirs, flat_distance);
            add_errors(table, name + "/flat_distance", theirs, truth, flat_distance);
        }
        add_calls(table, name + "/bullet_distance", theirs, distance);
        add_errors(table, name + "/bullet_distance", theirs, truth, distance);
        add_calls(table, name + "/bullet_contacts", theirs, clipped, "points_per_pair");
        add_calls(table, name + "/bullet_contacts_by_axes", theirs, by_axes, "points_per_pair");
        add_calls(table, name + "/ccd_gjk", theirs, polytope);
        if (!is_apart) {
            add_errors(table, name + "/ccd_gjk", theirs, truth, polytope);
            add_calls(table, name + "/ccd_gjk_tight", theirs, tight_polytope);
            add_errors(table, name + "/ccd_gjk_tight", theirs, truth, tight_polytope);
        }
        add_calls(table, name + "/ccd_mpr", theirs, portals);
        if (!is_apart) add_errors(table, name + "/ccd_mpr", theirs, truth, portals);
    }
}

// ---- what separating axes would cost ----------------------------------------------------------

/// How many of some vectors there are, of opposite ones one.
template <class Vector>
std::size_t count_lines(const std::vector<Vector>& all) {
    std::vector<Vector> lines;
    for (const Vector& v : all)
        if (std::none_of(lines.begin(), lines.end(), [&](const Vector& line) {
                return std::abs(line.dot(v)) > (1 - 1e-9) * line.norm() * v.norm();
            }))
            lines.push_back(v);
    return lines.size();
}

/// Directions along which a pair of equal polytopes may be apart.
struct AxisCount {
    double all;       ///< a cell's normal, or an edge of one by a 2-face of the other
    double distinct;  ///< those that are parallel in every position counted once
};
AxisCount axes_of(const Hull& hull) {
    std::set<std::array<std::uint16_t, 2>> edges;
    std::vector<Vec4> normals, directions;
    std::vector<Eigen::Matrix<double, 6, 1>> planes;
    for (const HullCell& cell : hull.cells) {
        normals.push_back(cell.plane.normal);
        for (const auto& edge : cell.edges) {
            const std::uint16_t from = cell.vertices[edge[0]], to = cell.vertices[edge[1]];
            edges.insert({std::min(from, to), std::max(from, to)});
            directions.push_back(hull.vertices[from] - hull.vertices[to]);
        }
        for (const HalfSpace& side : cell.sides) {
            const Vec4 &n = cell.plane.normal, &m = side.normal;
            planes.emplace_back();
            for (int i = 0, k = 0; i < 4; ++i)
                for (int j = i + 1; j < 4; ++j) planes.back()[k++] = n[i] * m[j] - n[j] * m[i];
        }
    }
    const auto cells = static_cast<double>(normals.size());
    const auto faces = static_cast<double>(planes.size()) / 2;
    return {2 * cells + 2 * static_cast<double>(edges.size()) * faces,
            2.0 * static_cast<double>(count_lines(normals)) +
                2.0 * static_cast<double>(count_lines(directions) * count_lines(planes))};
}

/// Both 24-cells' farthest vertices along given directions [ns an axis]: how an axis is made of an
/// edge and a face is not in it.
double time_of_axis(const std::vector<ConvexPair>& list, const std::vector<Vec4>& axes) {
    const double time = time_per_pair(list, [&](const ConvexPair& pair) {
        const auto& a = *std::get<Polychoron>(*pair.a.shape).body;
        const auto& b = *std::get<Polychoron>(*pair.b.shape).body;
        const Mat4 to_a = to_matrix(pair.a.rotor).transpose();
        const Mat4 to_b = to_matrix(pair.b.rotor).transpose();
        const Vec4 between = pair.b.position - pair.a.position;
        double best = -std::numeric_limits<double>::infinity();
        for (const Vec4& n : axes)
            best = std::max(best, n.dot(between) - b.corners.largest_at(-(to_b * n)).value -
                                      a.corners.largest_at(to_a * n).value);
        return best;
    });
    return time / static_cast<double>(axes.size());
}

void add_axes(Table& table, Random& random) {
    const std::vector<ConvexSolid> solids = cells_24(kSolids);
    const auto list =
        draw_list([&] { return random_pair<Polychoron>(random, solids, kOverlapping, 4); });
    std::vector<Vec4> axes;
    for (int i = 0; i < 64; ++i) axes.push_back(random_direction(random, 4));
    const AxisCount count = axes_of(std::get<Polychoron>(*solids[0].shape).body->hull);
    const std::string name = "24_cells/separating_axes";
    table.note(name, "axes", count.all);
    table.note(name, "distinct_axes", count.distinct);
    table.measure(name, "ns_per_axis", [=] { return time_of_axis(*list, axes); });
    table.measure(name, "us_per_pair",
                  [=] { return 1e-3 * count.all * time_of_axis(*list, axes); });
    table.measure(name, "us_per_pair_distinct",
                  [=] { return 1e-3 * count.distinct * time_of_axis(*list, axes); });
}

// ---- towers at rest ---------------------------------------------------------------------------

void add_towers(Table& table, const std::string& name, const Shape& shape) {
    const auto towers = std::make_shared<RestingTowers>(shape, kSettlingSteps);
    table.measure(name, "ms_per_step", [=] { return 1e3 * towers->step_time(kStepsOfRepeat); });
    table.note_last(name, "contacts_percent",
                    [=] { return 100 * towers->share_of(Stage::kFindContacts); });
    table.note_last(name, "solver_percent",
                    [=] { return 100 * towers->share_of(Stage::kSolveIslands); });
    table.note_last(name, "points_per_body", [=] {
        return static_cast<double>(towers->report().contacts) / RestingTowers::kBodies;
    });
    table.note_last(name, "penetration_mm", [=] { return 1e3 * towers->report().penetration; });
    table.note_last(name, "way_mm", [=] { return 1e3 * towers->way(); });
    table.note_last(name, "speed_mm_s", [=] { return 1e3 * towers->speed(); });
}

void run() {
    Random random(6);
    Table table;
    HullsInBullet bullet;
    const HullsInCcd ccd(kCcdTolerance), tight(kTightTolerance);
    const Hulls cubes(cube_vertices, kSolids), icosahedra(icosahedron_vertices, kSolids);
    add_24_cells(table, random);
    add_axes(table, random);
    add_boxes(table, random);
    add_hulls(table, random, "cubes", cubes, bullet, ccd, tight);
    add_hulls(table, random, "icosahedra", icosahedra, bullet, ccd, tight);
    Polychoron cell;
    cell.regular = RegularPolychoron::k24Cell;
    cell.radius = std::sqrt(0.5);  // stands on a cell as it is
    complete(cell);
    add_towers(table, "towers/24_cells", cell);
    add_towers(table, "towers/boxes", Hyperbox{});
    table.run();
}

}  // namespace
}  // namespace tesserae::bench

int main() {
    tesserae::parallel::Threads(1).run(tesserae::bench::run);
    return 0;
}

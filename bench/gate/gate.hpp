// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

// The gate of the dynamics: drawn and fixed scenes, each watched for what a user would see of it.
// Every change of the dynamics is judged by the table that comes out. See README.md.
namespace tesserae::bench::gate {

/// How the values of all scenes of a family become one number of the table.
enum class Statistic {
    kMedian,
    kNinth,  ///< nine of ten scenes have less
    kCount,  ///< of scenes whose value is not 0, the mean over their runs
};

/// Which changes of a number are welcome.
enum class Better { kLess, kMore, kEqual };

struct Quantity {
    std::string name, unit;
    std::vector<Statistic> statistics = {Statistic::kMedian};
    Better better = Better::kLess;
};
inline Quantity count_of(const std::string& name) { return {name, "", {Statistic::kCount}}; }
/// Of a quantity whose scenes differ much: the median and the ninth tenth.
inline Quantity spread_of(const std::string& name, const std::string& unit) {
    return {name, unit, {Statistic::kMedian, Statistic::kNinth}};
}

/// One run of one scene. The runs of a scene differ by `shake` alone: what chance does to a
/// scene is seen by moving its bodies by almost nothing.
struct Run {
    int scene = 0;            ///< its number within the family, from 0
    std::uint64_t shake = 0;  ///< 0: the scene as it is
};

/// Scenes of one kind and what is measured of them.
struct Family {
    std::string name;
    int scenes = 1, quick_scenes = 1;
    int runs = 2;  ///< of every scene
    std::vector<Quantity> quantities;
    /// The values of a run, in the order of `quantities`; NaN where one has no meaning.
    /// @throws RunError   which counts as infinite values of all quantities
    std::function<std::vector<double>(const Run&)> measure;
    /// Instead of `quantities`, where only a run tells what is measured.
    std::function<std::vector<Quantity>()> find_quantities = {};
};

/// One line of the table.
struct Row {
    std::string family, quantity, unit;
    double value = 0;
    /// Half the width of the range in which 95 of 100 tables of the same program lie, if their
    /// scenes are shaken otherwise, or what one scene does to it that ends otherwise, if that is
    /// more; of times, the distance of the quartiles of the repeats.
    double spread = 0;
    int samples = 0;
    Better better = Better::kLess;
};

/// Values of the runs of every scene to the rows of a family.
/// @param values   by scene, run and quantity
std::vector<Row> rows_of(const Family& family,
                         const std::vector<std::vector<std::vector<double>>>& values);

// The families, each in a source of its own.
std::vector<Family> rest_families();
std::vector<Family> tower_families();
std::vector<Family> thin_heap_families();
std::vector<Family> jam_families();
std::vector<Family> impact_families();
std::vector<Family> ride_families();
std::vector<Family> rim_families();
std::vector<Family> plate_families();
std::vector<Family> extreme_families();
std::vector<Family> found_families();
std::vector<Family> property_families();

/// Times of a step beside Bullet, measured in turn with nothing else running, and how still and
/// deep the same scenes lie.
/// @param names   of scenes to measure; empty: all
/// @param print   gets the rows of a scene once they are known
void measure_times(const std::vector<std::string>& names, bool quick,
                   const std::function<void(const std::vector<Row>&)>& print);
std::vector<std::string> timed_scenes();

}  // namespace tesserae::bench::gate

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "bench/gate/gate.hpp"

namespace tesserae::bench::gate {
namespace {

constexpr int kResamples = 400;

/// @param values   not empty; are put into another order
double quantile(std::vector<double>& values, double part) {
    const auto at = static_cast<std::size_t>(part * static_cast<double>(values.size()));
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::min(at, values.size() - 1));
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

double summary(Statistic statistic, std::vector<double> values, double runs_of_scene) {
    switch (statistic) {
        case Statistic::kMedian:
            return quantile(values, 0.5);
        case Statistic::kNinth:
            return quantile(values, 0.9);
        case Statistic::kCount:
            break;
    }
    const auto counted =
        std::count_if(values.begin(), values.end(), [](double value) { return value != 0; });
    return static_cast<double>(counted) / runs_of_scene;
}

/// The number changes by so much if every scene's runs are drawn anew from those that were made:
/// the scenes stay, chance is what differs. Two standard deviations, enlarged as n / (n - 1) says
/// for variances of n runs.
double spread_of_chance(Statistic statistic, const std::vector<std::vector<double>>& by_scene,
                        double runs) {
    if (runs < 2) return 0;
    std::mt19937_64 engine(1);
    double sum = 0, squares = 0;
    int finite = 0;
    for (int i = 0; i < kResamples; ++i) {
        std::vector<double> drawn;
        for (const std::vector<double>& of_scene : by_scene)
            for (std::size_t k = 0; k < of_scene.size(); ++k)
                drawn.push_back(of_scene[engine() % of_scene.size()]);
        const double value = summary(statistic, std::move(drawn), runs);
        if (!std::isfinite(value)) continue;
        ++finite, sum += value, squares += value * value;
    }
    if (finite == 0) return 0;
    const double mean = sum / finite;
    return 2 * std::sqrt(std::max(0.0, squares / finite - mean * mean) * runs / (runs - 1));
}

/// How far a quantile moves if one scene does otherwise: half the distance of the scenes beside it.
double spread_of_one_scene(double part, const std::vector<std::vector<double>>& by_scene) {
    std::vector<double> scenes;
    for (std::vector<double> runs : by_scene) scenes.push_back(quantile(runs, 0.5));
    if (scenes.size() < 3) return 0;
    std::sort(scenes.begin(), scenes.end());
    const auto at = static_cast<std::size_t>(part * static_cast<double>(scenes.size()));
    const std::size_t middle = std::clamp<std::size_t>(at, 1, scenes.size() - 2);
    const double distance = scenes[middle + 1] - scenes[middle - 1];
    return std::isfinite(distance) ? 0.5 * distance : 0;
}

const char* name_of(Statistic statistic) {
    switch (statistic) {
        case Statistic::kMedian:
            return ", median";
        case Statistic::kNinth:
            return ", nine of ten below";
        case Statistic::kCount:
            break;
    }
    return "";
}

}  // namespace

std::vector<Row> rows_of(const Family& family,
                         const std::vector<std::vector<std::vector<double>>>& values) {
    std::vector<Row> rows;
    for (std::size_t q = 0; q < family.quantities.size(); ++q) {
        const Quantity& quantity = family.quantities[q];
        std::vector<std::vector<double>> by_scene;
        std::vector<double> all;
        for (const auto& runs : values) {
            std::vector<double> of_scene;
            for (const std::vector<double>& run : runs)
                if (!std::isnan(run[q])) of_scene.push_back(run[q]);
            if (of_scene.empty()) continue;
            all.insert(all.end(), of_scene.begin(), of_scene.end());
            by_scene.push_back(std::move(of_scene));
        }
        if (all.empty()) continue;
        const double runs = static_cast<double>(all.size()) / static_cast<double>(by_scene.size());
        for (const Statistic statistic : quantity.statistics) {
            Row row;
            row.family = family.name;
            row.quantity = quantity.name;
            if (values.size() > 1) row.quantity += name_of(statistic);
            row.unit = statistic == Statistic::kCount ? "of " + std::to_string(by_scene.size())
                                                      : quantity.unit;
            row.value = summary(statistic, all, runs);
            row.spread = spread_of_chance(statistic, by_scene, runs);
            if (statistic != Statistic::kCount)
                row.spread = std::max(
                    row.spread,
                    spread_of_one_scene(statistic == Statistic::kMedian ? 0.5 : 0.9, by_scene));
            row.samples = static_cast<int>(all.size());
            row.better = quantity.better;
            rows.push_back(std::move(row));
        }
    }
    return rows;
}

}  // namespace tesserae::bench::gate

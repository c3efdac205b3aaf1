// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/nearest_name.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace tesserae::scenes {
namespace {

/// Longer words are no misspelt names; the table below grows with the square.
constexpr std::size_t kLongest = 64;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Optimal string alignment distance: three rolling rows of the edit table.
std::size_t edits(std::string_view a, std::string_view b) {
    std::array<std::vector<std::size_t>, 3> rows;
    for (auto& row : rows) row.resize(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) rows[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        auto& row = rows[i % 3];
        const auto& above = rows[(i + 2) % 3];
        const auto& two_above = rows[(i + 1) % 3];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const char x = lower(a[i - 1]), y = lower(b[j - 1]);
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (x == y ? 0 : 1)});
            if (i > 1 && j > 1 && x == lower(b[j - 2]) && lower(a[i - 2]) == y)
                row[j] = std::min(row[j], two_above[j - 2] + 1);
        }
    }
    return rows[a.size() % 3][b.size()];
}

/// What everybody types at first, and what it is called here.
constexpr std::pair<std::string_view, std::string_view> kUsualNames[] = {
    {"tesseract", "hyperbox"},  {"cube", "hyperbox"},        {"box", "hyperbox"},
    {"hypercube", "hyperbox"},  {"sphere", "hypersphere"},   {"ball", "hypersphere"},
    {"glome", "hypersphere"},   {"plane", "hyperplane"},     {"floor", "hyperplane"},
    {"ground", "hyperplane"},   {"capsule", "hypercapsule"}, {"cylinder", "duocylinder"},
    {"polytope", "polychoron"}, {"bodies", "body"},          {"object", "body"},
    {"colour", "color"},        {"colour", "albedo"},        {"color", "albedo"},
    {"intensity", "strength"},  {"fov", "field_of_view"},    {"fps", "frames_per_second"},
    {"bounce", "restitution"},  {"pos", "position"},
};

}  // namespace

std::string_view nearest_name(std::string_view word, std::span<const std::string_view> names) {
    if (word.size() > kLongest) return {};
    for (const auto& [usual, name] : kUsualNames)
        if (word == usual && std::find(names.begin(), names.end(), name) != names.end())
            return name;
    std::string_view nearest;
    std::size_t fewest = std::max<std::size_t>(word.size() / 3, 1) + 1;
    for (std::string_view name : names) {
        if (name.size() > kLongest || name.size() + fewest <= word.size() ||
            word.size() + fewest <= name.size())
            continue;
        const std::size_t n = edits(word, name);
        // A name of one letter is not meant by another letter.
        if (n < fewest && n < std::max(word.size(), name.size())) {
            fewest = n;
            nearest = name;
        }
    }
    return nearest;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> names) {
    const std::string_view name = nearest_name(word, names);
    return name.empty() ? "" : "; did you mean \"" + std::string(name) + "\"?";
}

}  // namespace tesserae::scenes

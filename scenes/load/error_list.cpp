// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/error_list.hpp"

#include <algorithm>
#include <limits>
#include <string_view>
#include <tuple>

namespace tesserae::scenes {
namespace {

constexpr std::size_t kMostErrors = 20;

std::string text_of(std::vector<PlacedError>& errors) {
    std::stable_sort(errors.begin(), errors.end(), [](const PlacedError& a, const PlacedError& b) {
        return std::tie(a.line, a.column) < std::tie(b.line, b.column);
    });
    std::string text;
    for (const PlacedError& error : errors) {
        if (!text.empty()) text += '\n';
        text += error.what();
    }
    if (errors.size() >= kMostErrors)
        text += fmt::format("\n{} errors are told at once; there may be more", kMostErrors);
    return text;
}

}  // namespace

InputErrors::InputErrors(std::vector<PlacedError> all)
    : InputError(text_of(all)), errors(std::move(all)) {}

void ErrorList::add(const InputError& error) {
    if (const auto* several = dynamic_cast<const InputErrors*>(&error)) {
        for (const PlacedError& one : several->errors) add(one);
    } else {
        constexpr auto kNowhere = std::numeric_limits<std::size_t>::max();
        const auto* placed = dynamic_cast<const PlacedError*>(&error);
        const std::string_view what = error.what();
        // Several lists may have been told of one error.
        if (std::ranges::any_of(errors_, [&](const PlacedError& e) { return e.what() == what; }))
            return;
        errors_.push_back(placed ? *placed : PlacedError(error.what(), kNowhere, kNowhere));
        if (errors_.size() >= kMostErrors) require_none();
    }
}

void ErrorList::require_none() const {
    if (!errors_.empty()) throw InputErrors(errors_);
}

}  // namespace tesserae::scenes

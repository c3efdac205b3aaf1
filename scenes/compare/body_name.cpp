// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <string_view>

#include "scenes/compare/trajectory_difference.hpp"

namespace tesserae::scenes {
namespace {

/// The product of the whole numbers in "[3, 3, 3, 1]"; 0 if it is not such a list.
std::uint64_t product(std::string_view list) {
    std::uint64_t product = 1, numbers = 0;
    const char *at = list.data(), *const end = at + list.size();
    while (at != end) {
        std::uint32_t number = 0;
        const auto [next, error] = std::from_chars(at, end, number);
        if (error == std::errc::result_out_of_range) return 0;
        if (error == std::errc()) {
            if (__builtin_mul_overflow(product, std::uint64_t{number}, &product)) return 0;
            ++numbers;
            at = next;
        } else {
            ++at;
        }
    }
    return numbers == 4 ? product : 0;
}

}  // namespace

std::string body_name(const std::string &effective, std::uint64_t body) {
    std::string_view rest = effective, name;
    std::uint64_t first = 0, count = 0;
    for (bool at_end = false; !at_end;) {
        at_end = rest.empty();
        const auto length = rest.find('\n');
        const std::string_view line = rest.substr(0, length);
        rest = length == std::string_view::npos ? std::string_view() : rest.substr(length + 1);
        if (at_end || line.starts_with('[')) {
            // A table ends: its bodies are those from `first` on.
            if (body - first < count) return std::string(name);
            first += count;
            count = line == "[[body]]" || line == "[[lattice]]" ? 1 : 0;
            name = {};
        } else if (line.starts_with("name = \"") && line.ends_with('"')) {
            name = line.substr(8, line.size() - 9);
        } else if (line.starts_with("count = ")) {
            count = product(line.substr(8));
        }
    }
    return {};
}

}  // namespace tesserae::scenes

// SPDX-License-Identifier: Apache-2.0
#include "core/counting_sort.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace tesserae {
namespace {

TEST(CountingSort, IsAStableSort) {
    std::mt19937_64 engine(1);
    for (int set = 0; set < 1000; ++set) {
        // None, one, many; more keys than items, fewer, one.
        const std::size_t count = engine() % 50, keys = 1 + engine() % 60;
        std::vector<std::size_t> key(count), expected(count), sorted(count);
        for (std::size_t& k : key) k = engine() % keys;
        std::iota(expected.begin(), expected.end(), std::size_t{0});
        std::stable_sort(expected.begin(), expected.end(),
                         [&](std::size_t i, std::size_t j) { return key[i] < key[j]; });

        std::vector<std::uint32_t> first{7, 7};
        counting_sort(
            count, keys, [&](std::size_t i) { return key[i]; }, first,
            [&](std::size_t i, std::size_t place) { sorted[place] = i; });
        ASSERT_EQ(sorted, expected);
        ASSERT_EQ(first.size(), keys + 1);
        for (std::size_t k = 0; k <= keys; ++k)
            ASSERT_EQ(first[k], std::count_if(key.begin(), key.end(),
                                              [&](std::size_t at) { return at < k; }));
    }
}

}  // namespace
}  // namespace tesserae

// SPDX-License-Identifier: Apache-2.0
// Every operation on several numbers against the same on plain ones, by bits.
#include "core/simd/simd.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <random>
#include <vector>

namespace tesserae::simd {
namespace {

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kEndless = std::numeric_limits<float>::infinity();

/// Random ones of all sizes, and those that are special.
float any_float(std::mt19937_64& engine) {
    constexpr float kSpecial[] = {0, -0.0f, 1, -1, kEndless, -kEndless, kNoNumber, 1e-45f};
    if (engine() % 3 == 0) return kSpecial[engine() % std::size(kSpecial)];
    return std::ldexp(static_cast<float>(engine() % 2001) - 1000, static_cast<int>(engine() % 60));
}
Float8 any_lanes(std::mt19937_64& engine) {
    Float8 v;
    for (std::size_t i = 0; i < kLanes; ++i) v[i] = any_float(engine);
    return v;
}
std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }
bool same(float a, float b) { return bits(a) == bits(b) || (std::isnan(a) && std::isnan(b)); }

TEST(Simd, EightFloatsAreEightPlainOnes) {
    std::mt19937_64 engine(1);
    for (int set = 0; set < 10000; ++set) {
        const Float8 a = any_lanes(engine), b = any_lanes(engine);
        const Float8 most = larger(a, b), least = smaller(a, b), size = magnitude(a);
        const Float8 root = square_root(size);
        const std::uint32_t set_lanes = not_above(a, b);
        for (std::size_t i = 0; i < kLanes; ++i) {
            const float x = a[i], y = b[i];
            ASSERT_TRUE(same(most[i], x > y ? x : y)) << x << " " << y;
            ASSERT_TRUE(same(least[i], x < y ? x : y)) << x << " " << y;
            ASSERT_TRUE(same(size[i], x > -x ? x : -x)) << x;
            ASSERT_TRUE(same(root[i], std::sqrt(size[i]))) << x;
            ASSERT_EQ(set_lanes >> i & 1, x <= y) << x << " " << y;
            ASSERT_TRUE(same(larger(x, y), most[i]));
        }
        float all = a[0];
        for (std::size_t i = 1; i < kLanes; ++i) all = larger(all, a[i]);
        ASSERT_TRUE(same(largest_lane(a), all));
    }
}

TEST(Simd, ProductSumIsRoundedOnceOrTwice) {
    std::mt19937_64 engine(2);
    std::uniform_real_distribution<float> number(-2, 2);
    for (int set = 0; set < 10000; ++set) {
        const float a = number(engine), b = number(engine), c = number(engine);
        const float got = product_sum(all_lanes(a), all_lanes(b), all_lanes(c))[set % 8];
        ASSERT_TRUE(got == std::fma(a, b, c) || got == a * b + c);
    }
}

/// The nearest of eight significant bits by arithmetic; ties to even, as nearbyint() has them.
float rounded(float x) {
    if (x == 0) return x;
    int exponent;
    const float part = std::frexp(x, &exponent);
    const int bits = std::min(8, exponent + 126 + 7);  // of subnormal ones fewer
    return std::ldexp(std::nearbyint(std::ldexp(part, bits)), exponent - bits);
}

TEST(Simd, HalvesAreTheNearestFloatsOfEightBits) {
    std::mt19937_64 engine(5);
    for (std::uint32_t upper = 0; upper < 0x10000; ++upper) {
        const auto half = static_cast<std::uint16_t>(upper);
        const float x = from_half(half);
        if (!std::isfinite(x)) continue;
        ASSERT_EQ(to_half(x), half);
    }
    for (int set = 0; set < 20000; ++set) {
        Float8 v;
        for (std::size_t i = 0; i < kLanes; ++i) {
            // Half of them as close to a tie as can be.
            auto any = static_cast<std::uint32_t>(engine());
            const auto aside = static_cast<std::uint32_t>(engine() % 3);
            if (engine() % 2 == 0) any = (any & 0xffff0000) + 0x7fff + aside;
            if ((any >> 23 & 0xff) >= 0xfe) any &= 0xbfffffff;
            v[i] = std::bit_cast<float>(any);
        }
        const Half8 halves = to_half(v);
        const Float8 back = from_half(halves);
        for (std::size_t i = 0; i < kLanes; ++i) {
            ASSERT_EQ(bits(back[i]), bits(rounded(v[i]))) << v[i];
            ASSERT_EQ(halves[i], to_half(v[i]));
        }
    }
}

TEST(Simd, SetLanesAreStoredOneAfterTheOther) {
    const Float8 v = {10, 11, 12, 13, 14, 15, 16, 17};
    for (std::uint32_t set = 0; set < 256; ++set) {
        std::vector<float> expected, stored(kLanes);
        for (std::size_t i = 0; i < kLanes; ++i)
            if (set >> i & 1) expected.push_back(v[i]);
        store_set(&v, set, stored.data());
        stored.resize(expected.size());
        ASSERT_EQ(stored, expected) << set;
    }
}

TEST(Simd, FourDoublesGiveOneNumber) {
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<> number(-1, 1);
    for (int set = 0; set < 1000; ++set) {
        std::array<double, 4> x;
        for (double& value : x) value = number(engine);
        const Double4 v = {x[0], x[1], x[2], x[3]};
        ASSERT_EQ(largest_lane(v), *std::max_element(x.begin(), x.end()));
        ASSERT_EQ(smallest_lane(v), *std::min_element(x.begin(), x.end()));
        ASSERT_EQ(sum_of_lanes(v), (x[0] + x[2]) + (x[1] + x[3]));
        int negative = 0;
        for (int i = 0; i < 4; ++i) negative |= (x[static_cast<std::size_t>(i)] < 0) << i;
        ASSERT_EQ(lanes_set(v < 0), negative);
    }
}

}  // namespace
}  // namespace tesserae::simd

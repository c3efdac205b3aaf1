// SPDX-License-Identifier: Apache-2.0
#include "render/mattes.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace tesserae::render {

std::uint32_t murmur3(std::string_view text) {
    constexpr std::uint32_t kFirst = 0xcc9e2d51u, kSecond = 0x1b873593u;
    const auto scrambled = [](std::uint32_t block) {
        return std::rotl(block * kFirst, 15) * kSecond;
    };
    std::uint32_t hash = 0;
    const std::size_t whole = text.size() / 4 * 4;
    for (std::size_t at = 0; at < whole; at += 4) {
        std::uint32_t block = 0;
        for (std::size_t i = 4; i-- > 0;)
            block = block << 8 | static_cast<unsigned char>(text[at + i]);
        hash = std::rotl(hash ^ scrambled(block), 13) * 5 + 0xe6546b64u;
    }
    std::uint32_t rest = 0;
    for (std::size_t i = text.size(); i-- > whole;)
        rest = rest << 8 | static_cast<unsigned char>(text[i]);
    hash ^= scrambled(rest) ^ static_cast<std::uint32_t>(text.size());
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

std::uint32_t matte_id(std::string_view name) {
    const std::uint32_t hash = murmur3(name), exponent = hash >> 23 & 255u;
    return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

void MatteSums::clear() {
    objects_.clear();
    materials_.clear();
}

void MatteSums::add(Parts& parts, std::uint32_t id, double sum) {
    for (Part& part : parts)
        if (part.id == id) {
            part.sum += sum;
            return;
        }
    parts.push_back({id, sum});
}

void MatteSums::add(std::uint32_t object, std::uint32_t material) {
    add(objects_, object, 1);
    add(materials_, material, 1);
}

void MatteSums::add_to(MatteSums& sums, double weight) const {
    for (const Part& part : objects_) add(sums.objects_, part.id, weight * part.sum);
    for (const Part& part : materials_) add(sums.materials_, part.id, weight * part.sum);
}

void MatteSums::rank(Parts& parts, double weight,
                     std::array<float, 2 * MattePixel::kRanks>& ranked) {
    std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
        return a.sum != b.sum ? a.sum > b.sum : a.id < b.id;
    });
    for (std::size_t i = 0; i < std::min(parts.size(), MattePixel::kRanks); ++i) {
        std::memcpy(&ranked[2 * i], &parts[i].id, sizeof(float));
        ranked[2 * i + 1] = static_cast<float>(weight * parts[i].sum);
    }
}

MattePixel MatteSums::ranked(double weight) {
    MattePixel pixel;
    rank(objects_, weight, pixel.objects);
    rank(materials_, weight, pixel.materials);
    return pixel;
}

}  // namespace tesserae::render

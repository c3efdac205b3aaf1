// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tesserae::render {

/// MurmurHash3_x86_32 of a text's bytes, seed 0 (Appleby, 2011).
std::uint32_t murmur3(std::string_view text);

/// The id of a name in a Cryptomatte, as bits of a float: its hash, one bit turned where that would
/// be a denormal, infinite or no number (Friedman and Jones, Cryptomatte specification 1.2.0,
/// "uint32_to_float32").
std::uint32_t matte_id(std::string_view name);

/// Which names a Cryptomatte layer has.
struct MatteNames {
    std::string manifest;  ///< JSON, name to id as eight hexadecimal digits; or where that is
    bool is_file = false;  ///< the manifest is the path of its file, beside the frames
};

/// The ids of all bodies and materials of a picture. Equal names have equal ids.
struct Mattes {
    std::vector<std::uint32_t> objects;    ///< by body
    std::vector<std::uint32_t> materials;  ///< by material
    MatteNames object_names, material_names;
};

/// What covers a pixel: of each Cryptomatte layer the ids of the largest coverage, that first, then
/// the lower id; 0 where fewer cover it. Id and coverage in turn.
struct MattePixel {
    static constexpr std::size_t kRanks = 6;
    std::array<float, 2 * kRanks> objects{}, materials{};
};

/// What covers a pixel, as its samples are added up.
class MatteSums {
  public:
    void clear();
    void add(std::uint32_t object, std::uint32_t material);
    /// Adds to coverages what this makes of so many samples.
    /// @param weight   of one of them
    void add_to(MatteSums& sums, double weight) const;
    /// Puts them in order.
    /// @param weight   of a sample
    MattePixel ranked(double weight);

  private:
    struct Part {
        std::uint32_t id;
        double sum;
    };
    using Parts = std::vector<Part>;
    static void add(Parts& parts, std::uint32_t id, double sum);
    static void rank(Parts& parts, double weight,
                     std::array<float, 2 * MattePixel::kRanks>& ranked);

    Parts objects_, materials_;  ///< a pixel has few: searched one by one
};

}  // namespace tesserae::render

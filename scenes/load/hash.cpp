#include "scenes/load/hash.hpp"

#include <fmt/format.h>
#include <xxhash.h>

namespace tesserae::scenes {

std::array<std::uint64_t, 2> hash_of(std::string_view text) {
    const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
    return {hash.high64, hash.low64};
}

std::string hex_hash(std::string_view text) {
    const auto [high, low] = hash_of(text);
    return fmt::format("{:016x}{:016x}", high, low);
}

}  // namespace tesserae::scenes

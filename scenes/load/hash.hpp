#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace tesserae::scenes {

/// XXH3, 128 bits (high word, low word).
std::array<std::uint64_t, 2> hash_of(std::string_view text);

/// The same as 32 hexadecimal digits.
std::string hex_hash(std::string_view text);

}  // namespace tesserae::scenes

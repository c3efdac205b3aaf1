// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace tesserae::scenes {

/// XXH3, 128 bits (high word, low word).
std::array<std::uint64_t, 2> hash_of(std::string_view text);

/// The same as 32 hexadecimal digits.
std::string hex_hash(std::string_view text);

/// The same hash of bytes that come in pieces.
class StreamHash {
  public:
    StreamHash();
    ~StreamHash();
    StreamHash(StreamHash&&) noexcept;

    void add(const void* bytes, std::size_t count);
    /// 32 hexadecimal digits of all that was added.
    std::string hex() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tesserae::scenes

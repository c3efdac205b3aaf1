// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/hash.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <new>

namespace tesserae::scenes {
namespace {

std::string digits_of(const XXH128_hash_t& hash) {
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace

std::array<std::uint64_t, 2> hash_of(std::string_view text) {
    const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
    return {hash.high64, hash.low64};
}

std::string hex_hash(std::string_view text) {
    return digits_of(XXH3_128bits(text.data(), text.size()));
}

struct StreamHash::State {
    XXH3_state_t* stream = XXH3_createState();

    State() {
        if (stream == nullptr) throw std::bad_alloc();
        XXH3_128bits_reset(stream);
    }
    ~State() { XXH3_freeState(stream); }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
};

StreamHash::StreamHash() : state_(std::make_unique<State>()) {}
StreamHash::~StreamHash() = default;
StreamHash::StreamHash(StreamHash&&) noexcept = default;

void StreamHash::add(const void* bytes, std::size_t count) {
    XXH3_128bits_update(state_->stream, bytes, count);
}

std::string StreamHash::hex() const { return digits_of(XXH3_128bits_digest(state_->stream)); }

}  // namespace tesserae::scenes

#include "render/tint.hpp"

#include "render/sampling/sampler.hpp"

namespace tesserae::render {

Color tint_of(BodyId body, double variation) {
    constexpr std::uint64_t kTints = 0x74696e74;  // a pattern of random numbers that no picture has
    const std::uint64_t bits = pixel_hash(static_cast<int>(body), 0, kTints);
    const auto random = [&](int i) {
        return static_cast<double>(bits >> (16 * i) & 0xffff) / 0x10000;
    };
    const Color own(random(1), random(2), random(3));
    return 1 - variation * (0.75 * random(0) + 0.25 * own);
}

}  // namespace tesserae::render

// SPDX-License-Identifier: Apache-2.0
// Scene files: what is accepted is finite, and its canonical text is the same scene again.
#include <cmath>

#include "scenes/load/load.hpp"
#include "scenes/timeline.hpp"
#include "tests/fuzz/example.hpp"
#include "tests/fuzz/reading.hpp"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    tesserae::fuzz::limit_memory();
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tesserae;
    const fuzz::MemoryFile file(fuzz::text_of(data, size));
    std::string effective, hash;
    const bool accepted = fuzz::accepts([&] {
        const scenes::Scene scene = scenes::load_scene(file.path(), {});
        for (const Vec4& p : scene.bodies.position)
            fuzz::require(p.allFinite(), "a position is not finite");
        for (const BodyType& t : scene.bodies.types)
            fuzz::require(std::isfinite(t.mass) && t.mass >= 0, "a mass is not finite");
        effective = scene.effective;
        hash = scene.hash;
    });
    if (!accepted) return 0;
    // As trajectories are read: `tesserae export`, `tesserae view`. What is refused then was too
    // large for the memory that is left.
    fuzz::accepts([&] {
        const scenes::Scene again = scenes::load_scene_text("scene.toml", effective, {});
        fuzz::require(again.hash == hash, "the canonical text is another scene");
        scenes::frame_count(again), scenes::step_count(again);
    });
    return 0;
}

// SPDX-License-Identifier: Apache-2.0
// --frames, and the frames of submitted tasks. The first byte says how many frames there are.
#include "scenes/farm/estimate.hpp"
#include "scenes/timeline.hpp"
#include "tests/fuzz/reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tesserae;
    if (size == 0) return 0;
    constexpr int kCounts[] = {1, 48, 10'000, 10'000'000};
    const int count = kCounts[data[0] % std::size(kCounts)];
    std::vector<int> frames;
    if (!fuzz::accepts([&] {
            frames = scenes::parse_frames(std::string(fuzz::text_of(data + 1, size - 1)), count);
        }))
        return 0;
    for (std::size_t i = 0; i < frames.size(); ++i)
        fuzz::require(frames[i] >= (i == 0 ? 0 : frames[i - 1] + 1) && frames[i] < count,
                      "frames do not ascend from 0 to the last");
    fuzz::require(scenes::parse_frames(scenes::frames_text(frames), count) == frames,
                  "the text of frames is of others");
    return 0;
}

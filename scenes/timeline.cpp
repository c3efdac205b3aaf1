// SPDX-License-Identifier: Apache-2.0
#include "scenes/timeline.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.hpp"
#include "scenes/load/effective.hpp"

namespace tesserae::scenes {
namespace {

constexpr double kLastStep = 9007199254740992.0;  // 2^53: a step's number is exact as a double
constexpr int kMaxFrames = 10'000'000;
/// Frames that a text may list, those in several ranges counted again.
constexpr std::size_t kMostListed = 2 * kMaxFrames;

/// A frame whose instant is this close to a step (in steps, relative) is at that step: what
/// k * steps_per_second / frames_per_second loses to rounding, with room to spare.
constexpr double kSameStep = 1e-12;

/// Of a frame, between the opening and the closing of its shutter: a bounce is known to 1/16 of it.
constexpr std::uint64_t kMostShutterSteps = 16;
/// Bodies at all of them together (some 200 bytes each).
constexpr std::uint64_t kMostShutterBodies = 2'000'000;

[[noreturn]] void bad_frames(const std::string& text, const std::string& why) {
    throw InputError(fmt::format(
        "--frames {}: {}; expected ranges such as 0-239x2,300 (first-last, xstep)", text, why));
}

int parse_number(const std::string& text, const char*& at, const char* end) {
    int value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || *at == '-')
        bad_frames(text, fmt::format("no frame number at \"{}\"", std::string(at, end)));
    at = next;
    return value;
}

}  // namespace

std::uint64_t step_count(const Scene& scene) {
    if (!scene.physics) return 0;
    const double steps = std::round(scene.physics->duration * scene.physics->steps_per_second);
    if (!(steps < kLastStep))
        throw InputError(
            fmt::format("{}: [physics]: duration x steps_per_second is {}: expected "
                        "fewer than 2^53 steps",
                        scene.file.string(), steps));
    return static_cast<std::uint64_t>(steps);
}

int frame_count(const Scene& scene) {
    if (!scene.physics) return 1;
    const double duration = scene.physics->duration, rate = scene.render.frames_per_second;
    if (!(duration * rate < kMaxFrames))
        throw InputError(
            fmt::format("{}: duration x frames_per_second is {} frames: expected fewer "
                        "than {}",
                        scene.file.string(), duration * rate, kMaxFrames));
    // The product rounds; the rule is k / rate < duration, so step to the count that obeys it.
    int count = static_cast<int>(duration * rate);
    while (count > 0 && !((count - 1) / rate < duration)) --count;
    while (count / rate < duration) ++count;
    return std::max(count, 1);
}

namespace {

/// @param frame   with a fraction for instants between frames
FrameInstant instant_of(const Scene& scene, double frame) {
    const double time = frame / scene.render.frames_per_second;
    if (!scene.physics) return {time, 0, 0};
    const double steps =
        std::max(0.0, frame * scene.physics->steps_per_second / scene.render.frames_per_second);
    const double nearest = std::round(steps);
    const double last = static_cast<double>(step_count(scene));
    if (std::abs(steps - nearest) <= kSameStep * std::max(1.0, steps) || steps >= last)
        return {time, static_cast<std::uint64_t>(std::min(nearest, last)), 0};
    const double before = std::floor(steps);
    return {time, static_cast<std::uint64_t>(before), steps - before};
}

}  // namespace

FrameInstant frame_instant(const Scene& scene, int frame) { return instant_of(scene, frame); }

bool has_frame(const Scene& scene, int frame) { return frame >= 0 && frame < frame_count(scene); }

FrameInstant closing_instant(const Scene& scene, int frame) {
    return instant_of(scene, frame + scene.camera.shutter);
}

std::vector<std::uint64_t> shutter_steps(const Scene& scene, int frame) {
    std::vector<std::uint64_t> steps;
    if (scene.camera.shutter == 0 || !scene.physics) return steps;
    const FrameInstant open = frame_instant(scene, frame), close = closing_instant(scene, frame);
    const std::uint64_t end = close.step + (close.fraction > 0 ? 1 : 0);
    if (end < open.step + 2) return steps;
    const std::uint64_t count = end - open.step - 1;
    const std::uint64_t most = std::min(
        kMostShutterSteps, kMostShutterBodies / std::max<std::uint64_t>(1, scene.bodies.size()));
    if (most == 0) return steps;
    const std::uint64_t stride = (count + most - 1) / most;
    for (std::uint64_t step = open.step + stride; step < end; step += stride) steps.push_back(step);
    return steps;
}

namespace {

/// Frames at which FilmCamera asks where the followed body is, to show the given ones and what is
/// beside them.
/// @param frames   ascending
std::vector<int> frames_of_lag(const Scene& scene, const std::vector<int>& frames) {
    std::vector<int> asked;
    const double lag = scene.follows() ? scene.camera_motion.follow_lag : 0;
    if (lag == 0) return asked;
    // The frame before, for vectors of motion; and one at or before the window's begin.
    const double back = std::ceil(lag * scene.render.frames_per_second) + 2;
    int next = 0;
    for (const int frame : frames) {
        for (int k = static_cast<int>(std::max<double>(next, frame - back)); k <= frame; ++k)
            asked.push_back(k);
        next = std::max(next, frame + 1);
    }
    return asked;
}

void sort_without_repeats(std::vector<std::uint64_t>& steps) {
    std::sort(steps.begin(), steps.end());
    steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
}

}  // namespace

std::vector<std::uint64_t> steps_needed(const Scene& scene, const std::vector<int>& frames) {
    std::vector<std::uint64_t> steps;
    const auto add = [&](const FrameInstant& at) {
        steps.push_back(at.step);
        if (at.fraction > 0) steps.push_back(at.step + 1);
    };
    for (const int frame : frames_of_lag(scene, frames)) add(frame_instant(scene, frame));
    for (int frame : frames) {
        add(frame_instant(scene, frame));
        if (scene.camera.shutter > 0) add(closing_instant(scene, frame));
        if (!scene.render.channels.motion) continue;
        for (const int other : {frame - 1, frame + 1})
            if (has_frame(scene, other)) add(frame_instant(scene, other));
    }
    sort_without_repeats(steps);
    return steps;
}

std::uint64_t last_step_needed(const Scene& scene, const std::vector<int>& frames) {
    const std::vector<std::uint64_t> steps = steps_needed(scene, frames);
    return steps.empty() ? 0 : steps.back();
}

std::vector<std::uint64_t> steps_for_frames(const Scene& scene, const std::vector<int>& frames) {
    std::vector<std::uint64_t> steps = steps_needed(scene, frames);
    for (int frame : frames) {
        const auto more = shutter_steps(scene, frame);
        steps.insert(steps.end(), more.begin(), more.end());
    }
    sort_without_repeats(steps);
    return steps;
}

std::vector<int> parse_frames(const std::string& text, int count) {
    std::vector<int> frames;
    if (text.empty()) {
        for (int k = 0; k < count; ++k) frames.push_back(k);
        return frames;
    }
    std::vector<bool> is_asked(static_cast<std::size_t>(count));
    std::size_t listed = 0;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        const int first = parse_number(text, at, end);
        int last = first, step = 1;
        if (at != end && *at == '-') last = parse_number(text, ++at, end);
        if (at != end && *at == 'x') step = parse_number(text, ++at, end);
        if (last < first) bad_frames(text, fmt::format("{} is after {}", first, last));
        if (step < 1) bad_frames(text, "a step of 0");
        if (last >= count)
            bad_frames(text, fmt::format("the scene has no frame {}: its frames are 0 to {}", last,
                                         count - 1));
        // Ranges may overlap, but not without end.
        listed += static_cast<std::size_t>((last - first) / step) + 1;
        if (listed > kMostListed)
            bad_frames(printable(text), fmt::format("lists more than {} frames", kMostListed));
        for (int k = first; k <= last; k += std::min(step, count))
            is_asked[static_cast<std::size_t>(k)] = true;
        if (at == end) break;
        if (*at != ',') bad_frames(text, fmt::format("unexpected \"{}\"", std::string(at, end)));
        ++at;
    }
    for (int k = 0; k < count; ++k)
        if (is_asked[static_cast<std::size_t>(k)]) frames.push_back(k);
    return frames;
}

std::string frames_text(const std::vector<int>& frames) {
    std::string text;
    for (std::size_t i = 0; i < frames.size();) {
        // Frames that are equally far apart: two beside each other are a range, else three.
        const int stride = i + 1 < frames.size() ? frames[i + 1] - frames[i] : 1;
        std::size_t last = i;
        while (last + 1 < frames.size() && frames[last + 1] - frames[last] == stride) ++last;
        if (stride > 1 && last < i + 2) last = i;
        if (!text.empty()) text += ',';
        text += fmt::format("{}", frames[i]);
        if (last > i) text += fmt::format("-{}", frames[last]);
        if (last > i && stride > 1) text += fmt::format("x{}", stride);
        i = last + 1;
    }
    return text;
}

}  // namespace tesserae::scenes

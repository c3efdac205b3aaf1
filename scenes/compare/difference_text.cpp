// SPDX-License-Identifier: Apache-2.0
#include <fmt/ranges.h>

#include "scenes/compare/difference.hpp"
#include "scenes/load/effective.hpp"

namespace tesserae::scenes {
namespace {

/// Lines of a name and what there is to say of it.
class Lines {
  public:
    void add(std::string_view name, const std::string& text) {
        lines_ += fmt::format("\n{:<16} {}", name, text);
    }
    void add_unless_empty(std::string_view name, const std::string& text) {
        if (!text.empty()) add(name, text);
    }
    void add_row(const std::string& text) { lines_ += "\n" + text; }
    const std::string& text() const { return lines_; }

  private:
    std::string lines_ = "different";
};

void add_entries(Lines& lines, const Difference& difference) {
    for (const EntryDifference& e : difference.entries) {
        const std::string name = printable(e.name, 400);
        if (e.b.empty())
            lines.add("only in A", name + " " + e.a);
        else if (e.a.empty())
            lines.add("only in B", name + " " + e.b);
        else if (e.a == e.b)
            lines.add("other values", name);
        else
            lines.add("other form", fmt::format("{}: {} in A, {} in B", name, e.a, e.b));
    }
}

void add_scene(Lines& lines, const std::string& scene, const std::string& motion) {
    if (scene.empty()) return;
    lines.add("scene", scene + " (there: A, here: B)");
    lines.add("motion part", motion.empty() ? "equal" : motion + " (there: A, here: B)");
}

std::string text_of(const LoneSteps& steps) {
    if (steps.count == 0) return {};
    if (steps.count == 1) return fmt::format("step {}", steps.first);
    return fmt::format("{} steps, the first {}, the last {}", steps.count, steps.first, steps.last);
}

std::string text_of(const FirstDifference& first) {
    std::string text = fmt::format("step {}, time {} s, ", first.step, first.time);
    if (first.body) {
        text += fmt::format("body {} ", *first.body);
        if (!first.body_name.empty()) text += fmt::format("\"{}\" ", printable(first.body_name));
    }
    if (first.joint)
        text += fmt::format("joint {} \"{}\" ", *first.joint, printable(first.joint_name));
    return text + fmt::format("{}: {} in A, {} in B, {} apart", first.component, first.a, first.b,
                              first.difference);
}

void add_trajectory(Lines& lines, const TrajectoryDifference& difference) {
    if (difference.bodies_a != difference.bodies_b)
        lines.add("bodies",
                  fmt::format("{} in A, {} in B", difference.bodies_a, difference.bodies_b));
    if (difference.joints_a != difference.joints_b)
        lines.add("joints",
                  fmt::format("{} in A, {} in B", difference.joints_a, difference.joints_b));
    add_scene(lines, difference.scene, difference.motion);
    lines.add_unless_empty("steps only in A", text_of(difference.only_a));
    lines.add_unless_empty("steps only in B", text_of(difference.only_b));
    if (difference.first) lines.add("first difference", text_of(*difference.first));
    lines.add_unless_empty("not compared", difference.not_compared);
    if (difference.growth.empty()) return;
    lines.add_row(fmt::format("{:>10} {:>12} {:>9} {:>11} {:>11} {:>11} {:>11}", "step", "time [s]",
                              "bodies", "position", "rotor", "velocity", "angular"));
    for (const StepDifference& row : difference.growth)
        lines.add_row(fmt::format("{:>10} {:>12.6g} {:>9} {:>11.4g} {:>11.4g} {:>11.4g} {:>11.4g}",
                                  row.step, row.time, row.bodies, row.largest[0], row.largest[1],
                                  row.largest[2], row.largest[3]));
}

std::string text_of(const render::Crop& window) {
    return fmt::format("{},{} to {},{}", window.x0, window.y0, window.x1, window.y1);
}

void add_image(Lines& lines, const ImageDifference& difference) {
    const std::string window_a = text_of(difference.window_a),
                      window_b = text_of(difference.window_b);
    if (window_a != window_b)
        lines.add("data window",
                  fmt::format("{} in A, {} in B; what both hold is compared", window_a, window_b));
    lines.add_unless_empty("only in A", fmt::format("{}", fmt::join(difference.only_a, " ")));
    lines.add_unless_empty("only in B", fmt::format("{}", fmt::join(difference.only_b, " ")));
    for (const std::string& type : difference.other_type) lines.add("other type", type);
    if (!difference.first) return;
    const PixelDifference& first = *difference.first;
    lines.add("first difference",
              fmt::format("pixel {},{} channel {}: {} in A, {} in B, {} apart", first.x, first.y,
                          first.channel, first.a, first.b, first.difference));
    lines.add_row(fmt::format("{:<16} {:>10} {:>11} {:>13} {:>11} {:>11}", "channel", "pixels",
                              "largest", "at", "rms", "not finite"));
    for (const ChannelDifference& c : difference.channels)
        lines.add_row(fmt::format("{:<16} {:>10} {:>11.4g} {:>13} {:>11.4g} {:>11}", c.name,
                                  c.pixels, c.largest, fmt::format("{},{}", c.x, c.y), c.rms,
                                  c.not_finite));
}

}  // namespace

std::string text_of(const Difference& difference) {
    if (difference.is_equal()) return "equal";
    Lines lines;
    // An image's channels have a table, a scene's two texts lines of their own.
    if (difference.kind == FileKind::kTrajectory || difference.kind == FileKind::kFrames)
        add_entries(lines, difference);
    add_scene(lines, difference.scene, difference.motion);
    if (difference.trajectory) add_trajectory(lines, *difference.trajectory);
    lines.add_unless_empty("first frame", difference.frame);
    if (difference.image) add_image(lines, *difference.image);
    return lines.text();
}

}  // namespace tesserae::scenes

// SPDX-License-Identifier: Apache-2.0
#include "scenes/plot/plot.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/nearest_name.hpp"
#include "scenes/plot/gnuplot.hpp"
#include "scenes/trajectory/joint_datasets.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

/// Parts of the time that are told apart where there are more steps than twice this: a pixel or so
/// of the drawing each. More would make the file large and look the same.
constexpr std::size_t kTimeParts = 1000;

/// Pixels; the panels share what margins leave.
constexpr int kPlotWidth = 1000, kPlotHeight = 1250;
constexpr double kPlotLeft = 0.08, kPlotRight = 0.86, kPlotTop = 0.945, kPlotBottom = 0.045;
/// Between panels, in parts of the height.
constexpr double kPanelGap = 0.035;

/// Okabe and Ito's colours, told apart by the colour-blind as well, but for the yellow one.
constexpr const char* kLineColours[] = {"#0072b2", "#d55e00", "#000000",
                                        "#009e73", "#cc79a7", "#56b4e9"};

using ValueOfStep = std::function<double(const StepFacts&)>;

PlotLine line_of(const std::string& name, const std::vector<StepFacts>& facts,
                 const ValueOfStep& value) {
    PlotLine line{name, {}, {}};
    const auto add = [&](std::size_t row) {
        line.time.push_back(facts[row].time);
        line.value.push_back(value(facts[row]));
    };
    const std::size_t parts = facts.size() > 2 * kTimeParts ? kTimeParts : 0;
    if (parts == 0)
        for (std::size_t row = 0; row < facts.size(); ++row) add(row);
    for (std::size_t part = 0; part < parts; ++part) {
        // In the order of time, and once where both are one.
        std::size_t least = part * facts.size() / parts, largest = least;
        for (std::size_t row = least; row < (part + 1) * facts.size() / parts; ++row) {
            if (value(facts[row]) < value(facts[least])) least = row;
            if (value(facts[row]) > value(facts[largest])) largest = row;
        }
        add(std::min(least, largest));
        if (least != largest) add(std::max(least, largest));
    }
    return line;
}

double total_energy(const StepFacts& f) { return f.kinetic_energy + f.potential_energy; }

/// A text that cannot end the string of a script that it is put into, nor change its line.
std::string quoted_for_gnuplot(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' || static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    return quoted + "'";
}

/// A logarithmic axis has no place for 0; where nothing is above it, the axis is a common one.
bool has_positive(const PlotPanel& panel) {
    for (const PlotLine& line : panel.lines)
        for (const double value : line.value)
            if (value > 0 && std::isfinite(value)) return true;
    return false;
}

/// The lines' points as blocks of data, $p0, $p1, ...
std::string data_blocks(const PlotPanel& panel, bool logarithmic) {
    std::string text;
    for (std::size_t l = 0; l < panel.lines.size(); ++l) {
        const PlotLine& line = panel.lines[l];
        text += fmt::format("$p{} << END\n", l);
        for (std::size_t i = 0; i < line.time.size(); ++i) {
            const double value = line.value[i];
            const bool has_place = std::isfinite(value) && !(logarithmic && value <= 0);
            text += fmt::format("{:.12g} {}\n", line.time[i],
                                has_place ? fmt::format("{:.9g}", value) : "NaN");
        }
        text += "END\n";
    }
    return text;
}

}  // namespace

std::vector<PlotPanel> observables_plot(const std::vector<StepFacts>& facts) {
    const auto line = [&](const char* name, const ValueOfStep& value) {
        return line_of(name, facts, value);
    };
    PlotPanel energy{"energy [J]", false, {}};
    energy.lines = {line("kinetic", [](const StepFacts& f) { return f.kinetic_energy; }),
                    line("potential", [](const StepFacts& f) { return f.potential_energy; }),
                    line("total", total_energy)};

    PlotPanel momentum{"momentum [kg m/s]", false, {}};
    constexpr const char* kAxisNames[] = {"x", "y", "z", "w"};
    for (int axis = 0; axis < 4; ++axis)
        momentum.lines.push_back(
            line(kAxisNames[axis], [axis](const StepFacts& f) { return f.momentum[axis]; }));

    PlotPanel angular{"angular momentum [kg m²/s]", false, {}};
    constexpr std::pair<const char*, double Bivector::*> kPlanes[] = {
        {"xy", &Bivector::xy}, {"xz", &Bivector::xz}, {"xw", &Bivector::xw},
        {"yz", &Bivector::yz}, {"yw", &Bivector::yw}, {"zw", &Bivector::zw}};
    for (const auto& [name, plane] : kPlanes)
        angular.lines.push_back(
            line(name, [of = plane](const StepFacts& f) { return f.angular_momentum.*of; }));

    PlotPanel counts{"contacts", false, {}};
    const auto asleep = [](const StepFacts& f) { return static_cast<double>(f.report.asleep); };
    counts.lines = {
        line("points", [](const StepFacts& f) { return static_cast<double>(f.report.contacts); })};
    if (std::any_of(facts.begin(), facts.end(), asleep))
        counts.lines.push_back(line("asleep", asleep));

    PlotPanel overlap{"overlap [m]", true, {}};
    overlap.lines = {line("deepest", [](const StepFacts& f) { return f.report.penetration; }),
                     line("mean", [](const StepFacts& f) { return f.report.mean_penetration; })};

    PlotPanel residual{"solver residual [m/s]", true, {}};
    residual.lines = {line("residual", [](const StepFacts& f) { return f.report.residual; })};
    return {energy, momentum, angular, counts, overlap, residual};
}

std::vector<PlotPanel> joints_plot(const std::vector<StepFacts>& facts,
                                   const std::vector<JointDescription>& joints) {
    const auto panel = [&](const char* title, std::vector<double> JointFacts::*values,
                           const char* unit) {
        PlotPanel made{title, false, {}};
        for (std::size_t joint = 0; joint < joints.size(); ++joint)
            if (!unit || joints[joint].unit == unit)
                made.lines.push_back(line_of(joints[joint].name, facts, [=](const StepFacts& f) {
                    // Of numbers that are smaller gnuplot makes no range.
                    constexpr double kLeast = 1e-300;
                    const double number = (f.joints.*values)[joint];
                    return std::abs(number) < kLeast ? 0 : number;
                }));
        return made;
    };
    std::vector<PlotPanel> panels = {
        panel("impulse in a step [N s]", &JointFacts::impulse, nullptr),
        panel("angular impulse in a step [N m s]", &JointFacts::angular_impulse, nullptr),
        panel("error [m]", &JointFacts::error, nullptr),
        panel("angular error [deg]", &JointFacts::angular_error, nullptr)};
    PlotPanel lengths = panel("position [m]", &JointFacts::position, "m");
    PlotPanel angles = panel("position [deg]", &JointFacts::position, "deg");
    for (PlotPanel* position : {&lengths, &angles})
        if (!position->lines.empty()) panels.push_back(std::move(*position));
    return panels;
}

std::string plot_script(const std::vector<PlotPanel>& panels, const std::string& title,
                        const std::string& terminal) {
    // Every panel has the same span of time; one of no length would have no axis.
    double begin = 0, end = 0;
    for (const PlotPanel& panel : panels)
        for (const PlotLine& line : panel.lines)
            if (!line.time.empty()) begin = line.time.front(), end = line.time.back();
    if (!(end > begin)) end = begin + 1;

    std::string script = fmt::format(
        "set encoding utf8\nset terminal {}\nset multiplot title {} noenhanced\n"
        "set lmargin at screen {}\nset rmargin at screen {}\nset xrange [{:.12g}:{:.12g}]\n"
        "set grid lc rgb '#dddddd' lt 1\nset border 3 lc rgb '#444444'\nset tics nomirror out\n"
        "set key at graph 1.02, graph 1 left top reverse Left samplen 2 noenhanced\n"
        "set ytics format '%g'\n",
        terminal, quoted_for_gnuplot(title), kPlotLeft, kPlotRight, begin, end);
    const double pitch = (kPlotTop - kPlotBottom + kPanelGap) / static_cast<double>(panels.size());
    double top = kPlotTop;
    for (std::size_t p = 0; p < panels.size(); ++p, top -= pitch) {
        const PlotPanel& panel = panels[p];
        const bool logarithmic = panel.logarithmic && has_positive(panel);
        script += data_blocks(panel, logarithmic);
        script += fmt::format("set tmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n", top,
                              top - pitch + kPanelGap);
        script += fmt::format("set label 1 {} at graph 0, graph 1.1 noenhanced\n",
                              quoted_for_gnuplot(panel.title));
        script += logarithmic ? "set logscale y\nset ytics format '10^{%T}' enhanced\n"
                              : "unset logscale y\nset ytics format '%g'\n";
        script += p + 1 == panels.size() ? "set xtics format '%g'\nset xlabel 'time [s]'\n"
                                         : "set xtics format ''\n";
        script += "plot ";
        for (std::size_t l = 0; l < panel.lines.size(); ++l)
            script += fmt::format("{}$p{} with lines lw 1.3 lc rgb '{}' title {}",
                                  l == 0 ? "" : ", ", l, kLineColours[l % std::size(kLineColours)],
                                  quoted_for_gnuplot(panel.lines[l].name));
        script += "\n";
    }
    return script + "unset multiplot\n";
}

namespace {

/// The numbers of a trajectory's joints that have these names. @throws InputError
std::vector<std::size_t> joints_of_names(const fs::path& trajectory,
                                         const std::vector<JointDescription>& joints,
                                         const std::vector<std::string>& names) {
    std::vector<std::size_t> numbers;
    for (const std::string& name : names) {
        const auto at = std::ranges::find(joints, name, &JointDescription::name);
        if (at == joints.end()) {
            std::vector<std::string_view> known;
            for (const JointDescription& joint : joints) known.push_back(joint.name);
            throw InputError(fmt::format("{}: has no joint \"{}\"{}", trajectory.string(),
                                         printable(name), did_you_mean(name, known)));
        }
        numbers.push_back(static_cast<std::size_t>(at - joints.begin()));
    }
    return numbers;
}

/// What is plotted of joints of these names.
std::vector<PlotPanel> panels_of_joints(const TrajectoryReader& reader, const fs::path& trajectory,
                                        std::vector<StepFacts> facts,
                                        const std::vector<std::string>& names) {
    const std::vector<JointDescription>& all = reader.header().joints;
    const std::vector<std::size_t> numbers = joints_of_names(trajectory, all, names);
    std::vector<JointDescription> joints;
    for (const std::size_t number : numbers) joints.push_back(all[number]);
    for (std::size_t row = 0; row < facts.size(); ++row) {
        const JointFacts read = reader.joints(row);
        JointFacts& kept = facts[row].joints = room_for_joints(numbers.size());
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            kept.impulse[i] = read.impulse[numbers[i]];
            kept.angular_impulse[i] = read.angular_impulse[numbers[i]];
            kept.error[i] = read.error[numbers[i]];
            kept.angular_error[i] = read.angular_error[numbers[i]];
            kept.position[i] = read.position[numbers[i]];
        }
    }
    return joints_plot(facts, joints);
}

/// What gnuplot draws. @throws RunError   with the picture's path and the reason
std::string drawn(const std::string& script, const fs::path& picture) try {
    std::string drawing = gnuplot_output(script);
    if (drawing.empty()) throw RunError("gnuplot: drew nothing");
    return drawing;
} catch (const RunError& error) {
    throw RunError(fmt::format("{}: cannot be made: {}", picture.string(), error.what()));
}

}  // namespace

bool plot(const fs::path& trajectory, const fs::path& picture,
          const std::vector<std::string>& joints, bool overwrite) {
    const bool is_svg = picture.extension() == ".svg";
    if (!is_svg && picture.extension() != ".png")
        throw InputError(
            fmt::format("-o {}: expected a name that ends in .svg or .png", picture.string()));
    const TrajectoryReader reader(trajectory);
    const auto facts = reader.facts();
    if (facts.empty()) throw InputError(fmt::format("{}: holds no steps yet", trajectory.string()));

    const std::string terminal =
        fmt::format("{} size {},{} font 'DejaVu Sans,11' background rgb 'white'",
                    is_svg ? "svg" : "pngcairo", kPlotWidth, kPlotHeight);
    const std::string title =
        fmt::format("{}: {} bodies, steps {} to {}", reader.header().scene_name,
                    reader.header().bodies, facts.front().step, facts.back().step);
    const std::vector<PlotPanel> panels = joints.empty()
                                              ? observables_plot(facts)
                                              : panels_of_joints(reader, trajectory, facts, joints);
    const std::string drawing = drawn(plot_script(panels, title, terminal), picture);

    if (fs::exists(picture)) {
        std::ifstream in(picture, std::ios::binary);
        if (std::string(std::istreambuf_iterator<char>(in), {}) == drawing) return false;
        if (!overwrite)
            throw InputError(fmt::format(
                "{}: is there already, and is another picture; choose another name, or --overwrite",
                picture.string()));
    }
    write_file(picture, drawing);
    return true;
}

}  // namespace tesserae::scenes

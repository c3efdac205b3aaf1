// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/trajectory/trajectory.hpp"

namespace tesserae::scenes {

/// A line of a diagram: a name and points in time [s], ascending.
struct PlotLine {
    std::string name;
    std::vector<double> time, value;
};

/// Lines that share an axis.
struct PlotPanel {
    std::string title;  ///< with the unit
    bool logarithmic = false;
    std::vector<PlotLine> lines;
};

/// What is plotted of a trajectory: energies, momentum, angular momentum, contacts, overlap and the
/// solver's residual, over time. Of more than some thousand steps a line shows the least and the
/// largest value in each of as many equal parts of the time, so that no peak is lost.
std::vector<PlotPanel> observables_plot(const std::vector<StepFacts>& facts);

/// What is plotted of some joints: impulses in a step, errors and positions, over time, with a line
/// for each joint. Positions are there for joints that have one.
/// @param joints   those that `facts` tell of
std::vector<PlotPanel> joints_plot(const std::vector<StepFacts>& facts,
                                   const std::vector<JointDescription>& joints);

/// The script by which gnuplot draws panels one below the other, into its standard output.
/// @param terminal   of gnuplot, with its options
std::string plot_script(const std::vector<PlotPanel>& panels, const std::string& title,
                        const std::string& terminal);

/// Draws the observables of a trajectory, finished or not, or what its joints do, into an .svg or
/// .png file.
/// @param joints   names of joints; none: the observables
/// @return false   the file is there already, as it would be written
/// @throws InputError   another ending; not a trajectory, or one without steps, or without a joint
///                      of such a name; another file of that name is there, and not `overwrite`
/// @throws RunError     no gnuplot; the file cannot be written
bool plot(const std::filesystem::path& trajectory, const std::filesystem::path& picture,
          const std::vector<std::string>& joints, bool overwrite);

}  // namespace tesserae::scenes

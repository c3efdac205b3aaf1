// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tests/scenes/properties/start.hpp"

// Properties that every scene has. Each function returns what is wrong with a scene, or an empty
// text. A defect changes all motions of a scene alike: to see that a property is able to fail.
namespace tesserae::scenes::properties {

/// With lengths, times and masses so many times as large bodies move as many times as far and fast,
/// bit for bit.
std::string fault_of_scaling(const SmallScene& scene, const Scaling& by, const Change& defect = {});

/// A motion that is interrupted goes on from bodies and memory bit for bit.
std::string fault_of_parting(const SmallScene& scene, const Change& defect = {});

/// A body that nothing touches, put in before another one, and types in another order change no bit
/// of how the others move.
std::string fault_of_numbering(const SmallScene& scene, const Change& defect = {});

/// The momentum of all bodies changes by gravity and by what those give that contacts do not move;
/// so does their angular momentum about the origin where nothing touches such a body.
std::string fault_of_momentum(const SmallScene& scene, const Change& defect = {});

/// Turned and moved scenes, and mirror images, move alike: they are no farther apart than scenes
/// that are rounded otherwise from the start on, as long as these are not, as is_gentle() ones are
/// for some steps. Bodies are turned a little first, as ties between directions are rounding's.
std::string fault_of_turning(const SmallScene& scene, const Change& defect = {});
std::string fault_of_mirroring(const SmallScene& scene, const Change& defect = {});

/// With times twice as long everything takes twice as long, bit for bit. Not so where the law has
/// times of its own (kFastestCorrection, kStill, kTimeToSleep): the scene gets restitution and no
/// sleeping, and is looked at while nothing overlaps so far that kFastestCorrection limits it.
std::string fault_of_slowing(const SmallScene& scene, const Change& defect = {});

/// A scene, seen otherwise.
struct View {
    Start start;
    std::function<void(Bodies&)> see;  ///< takes bodies of the scene to those of the view
};
View turned_view(const SmallScene& scene);
View mirrored_view(const SmallScene& scene);

/// Whether bodies overlap and move so little that nothing is left to rounding: which of several
/// ways out of a deep overlap is the shortest, or where a body is stopped that is about to pass
/// through another.
bool is_gentle(const Motion& motion);

/// How far a scene and a view of it are apart.
struct Agreement {
    int step = 0;      ///< the last one
    double apart = 0;  ///< difference() there
    double rounding =
        0;  ///< the same between the scene and others of it that are rounded otherwise
};
/// Compares them step by step, as long as they are gentle.
/// @param ends          is asked after every step whether to end
/// @param others_count  how many others there are
Agreement agreement_of(const SmallScene& scene, const View& view, const Change& defect,
                       const std::function<bool(const Agreement&)>& ends, int others_count);

}  // namespace tesserae::scenes::properties

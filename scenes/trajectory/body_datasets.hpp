// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "scenes/trajectory/hdf5.hpp"
#include "scenes/trajectory/trajectory.hpp"

// What a trajectory says of each body beside its states, so that whoever reads it needs no scene
// file: datasets of one entry a body in the group of the bodies. Files of earlier programs have
// none of them, and nothing in this program reads them.
//
//   mass    float64 [kg]; infinite for a body without bounds, which never moves
//   name    text; all bodies of a lattice have the lattice's
//   shape   text: what a scene file calls it
//   size    text: the shape's parameters as in a scene file, "radius = 0.2, height = 1"; those of a
//           hyperplane with its normal made unit; cut after kMostSizeBytes
//
// Texts are UTF-8 of a fixed length, that of the longest, filled up with zeros.
namespace tesserae::scenes {

/// Bytes of a text of parameters, usual below 100. More, as of a list of points, would be stored
/// for every body; the scene's effective text has all of it.
inline constexpr std::size_t kMostSizeBytes = 256;

/// Nothing is to be added to the group of the bodies after these.
void create_body_datasets(const hdf5::Handle& group, const BodyDescriptions& bodies);

/// Gives the bodies other names, which their motion does not depend on, where the file has names.
/// A kill leaves all of the old ones or all of the new ones. Flushes; the file is to be closed
/// before more is written.
void replace_names(const hdf5::Handle& file, const BodyDescriptions& bodies);

}  // namespace tesserae::scenes

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/compare/content.hpp"

// The contents of single files: see read_content().
namespace tesserae::scenes {

/// Walks all groups through hard links, at most 16 deep and 10^4 objects by all their names; a
/// dataset with two names counts under both. Known limit: as for TrajectoryReader, damage inside
/// HDF5's own structures is left to libhdf5 to notice.
/// @throws InputError   a soft or external link; a type, layout or filter that trajectories do not
///                      have; all datasets, by all their names, claim more than gzip can make of
///                      the file
Content trajectory_content(const std::filesystem::path& file);

/// @throws InputError   see render::ImagePixels
Content image_content(const std::filesystem::path& file);

}  // namespace tesserae::scenes

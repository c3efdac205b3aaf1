// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/process/version.hpp"

namespace tesserae::scenes {

/// The commit of the sources. The build writes its definition into a file of its own, anew where
/// it has changed (commit.cmake), and only the program is linked with it.
extern const Commit kCommit;

}  // namespace tesserae::scenes

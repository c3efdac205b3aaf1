// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tesserae::parallel {

/// A control group of Linux that limits what a process may use.
struct ControlGroup {
    std::filesystem::path folder;  ///< where its limits are files
    int version = 2;               ///< of control groups: their files' names differ
};

/// The groups that hold this process and may limit what `controller` ("cpu", "memory") stands for:
/// its own, the group that holds that, and so on up to the mount point.
/// @param list   what /proc/self/cgroup holds
std::vector<ControlGroup> control_groups(const std::string& controller, const std::string& list);
/// Of this process.
std::vector<ControlGroup> control_groups(const std::string& controller);

}  // namespace tesserae::parallel

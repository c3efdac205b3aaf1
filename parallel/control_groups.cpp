// SPDX-License-Identifier: Apache-2.0
#include "parallel/control_groups.hpp"

#include <fstream>
#include <sstream>

namespace tesserae::parallel {

std::vector<ControlGroup> control_groups(const std::string& controller, const std::string& list) {
    std::vector<ControlGroup> groups;
    std::istringstream lines(list);
    // Lines are hierarchy:controllers:group; version 2 has no controllers.
    for (std::string line; std::getline(lines, line);) {
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const bool is_second_version = controllers.empty();
        if (!is_second_version &&
            ("," + controllers + ",").find("," + controller + ",") == std::string::npos)
            continue;
        std::filesystem::path root = "/sys/fs/cgroup";
        if (!is_second_version) root /= controller;
        std::filesystem::path group = line.substr(second + 1);
        for (group = group.relative_path();; group = group.parent_path()) {
            groups.push_back({root / group, is_second_version ? 2 : 1});
            if (group.empty()) break;
        }
    }
    return groups;
}

std::vector<ControlGroup> control_groups(const std::string& controller) {
    std::ifstream file("/proc/self/cgroup");
    std::ostringstream list;
    list << file.rdbuf();
    return control_groups(controller, list.str());
}

}  // namespace tesserae::parallel

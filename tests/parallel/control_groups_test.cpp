// SPDX-License-Identifier: Apache-2.0
#include "parallel/control_groups.hpp"

#include <gtest/gtest.h>

namespace tesserae::parallel {
namespace {

std::vector<std::string> folders(const std::string& controller, const std::string& list) {
    std::vector<std::string> found;
    for (const ControlGroup& group : control_groups(controller, list))
        found.push_back(std::to_string(group.version) + " " +
                        group.folder.lexically_normal().string());
    return found;
}

using Folders = std::vector<std::string>;

TEST(ControlGroups, OfTheSecondVersionAreThoseUpToTheMountPoint) {
    EXPECT_EQ(
        folders("cpu", "0::/a.slice/b:c\n"),
        (Folders{"2 /sys/fs/cgroup/a.slice/b:c", "2 /sys/fs/cgroup/a.slice", "2 /sys/fs/cgroup/"}));
    EXPECT_EQ(folders("memory", "0::/\n"), (Folders{"2 /sys/fs/cgroup/"}));
}

TEST(ControlGroups, OfTheFirstVersionAreThoseOfTheController) {
    const std::string list = "12:cpu,cpuacct:/x\n11:cpuset:/y\n3:memory:/z\n1:name=systemd:/w\n";
    EXPECT_EQ(folders("cpu", list), (Folders{"1 /sys/fs/cgroup/cpu/x", "1 /sys/fs/cgroup/cpu/"}));
    EXPECT_EQ(folders("memory", list),
              (Folders{"1 /sys/fs/cgroup/memory/z", "1 /sys/fs/cgroup/memory/"}));
}

TEST(ControlGroups, AreNoneInWhatIsNoSuchList) {
    for (const char* list : {"", "\n", "nothing", "0:", ":", "1:cpu"})
        EXPECT_TRUE(folders("cpu", list).empty()) << list;
}

}  // namespace
}  // namespace tesserae::parallel

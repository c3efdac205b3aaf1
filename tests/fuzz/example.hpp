// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.hpp"
#include "scenes/trajectory/trajectory.hpp"

// Small valid examples of what is read, and limits for whoever reads it.
namespace tesserae::fuzz {

/// A scene that has one of everything, and for which nothing takes long.
extern const char* const kSceneOfEverything;

/// From now on readers that ask how much memory is free (scenes/process/memory.hpp) are told less
/// than what libFuzzer lets them take.
void limit_memory();

/// A trajectory of kSceneOfEverything: some rows in which bodies touch, roll and fall asleep.
class ExampleTrajectory {
  public:
    ExampleTrajectory();

    const scenes::Scene& scene() const { return scene_; }
    const std::vector<std::uint64_t>& steps() const { return steps_; }  ///< those to store
    scenes::TrajectoryHeader header() const;

    /// The bytes of a whole file, and of one whose last `lacking` rows are not there yet.
    std::string whole() const { return written(0); }
    std::string unfinished(std::size_t lacking) const { return written(lacking); }

    /// Steps the bodies on to the last row, as simulating does, and finishes the file.
    void finish(scenes::TrajectoryWriter& writer) const { append(writer, 0); }

  private:
    void append(scenes::TrajectoryWriter& writer, std::size_t lacking) const;
    std::string written(std::size_t lacking) const;

    scenes::Scene scene_;
    std::vector<std::uint64_t> steps_;
};

/// A frame of the scene as the program writes it, and the same in parts (part_file.hpp).
std::string example_image();
std::vector<std::string> example_parts(int count = 2);

std::string content_of(const std::filesystem::path& file);

/// A folder in memory, if the system has one.
std::filesystem::path memory_folder(const char* name);

}  // namespace tesserae::fuzz

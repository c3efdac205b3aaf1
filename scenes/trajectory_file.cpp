// SPDX-License-Identifier: Apache-2.0
#include "scenes/trajectory_file.hpp"

#include "core/dynamics/bodies/bodies.hpp"
#include "core/error.hpp"
#include "scenes/trajectory/trajectory.hpp"
#include "scenes/trajectory/trajectory_layout.hpp"

namespace tesserae {

struct Trajectory::Inside {
    std::string file;
    scenes::TrajectoryReader reader;

    explicit Inside(const std::filesystem::path& path) : file(path.string()), reader(path) {}
};

Trajectory::Trajectory(const std::filesystem::path& file)
    : inside_(std::make_shared<Inside>(file)) {}

std::size_t Trajectory::size() const { return inside_->reader.rows(); }
std::span<const std::uint64_t> Trajectory::steps() const { return inside_->reader.steps(); }
std::span<const double> Trajectory::times() const { return inside_->reader.times(); }
std::size_t Trajectory::bodies() const { return inside_->reader.header().bodies; }
std::vector<std::string> Trajectory::names() const { return inside_->reader.names(); }
std::vector<double> Trajectory::masses() const { return inside_->reader.masses(); }
const std::string& Trajectory::scene_name() const { return inside_->reader.header().scene_name; }
const std::string& Trajectory::scene_text() const { return inside_->reader.header().effective; }
const std::string& Trajectory::motion_hash() const { return inside_->reader.header().motion_hash; }

BodyArrays Trajectory::state(std::size_t i) const {
    if (i >= size())
        throw InputError(
            fmt::format("{}: stored step {}: the trajectory has {}", inside_->file, i, size()));
    const auto bodies = std::make_shared<Bodies>(scenes::room_for(this->bodies()));
    inside_->reader.read_row(i, *bodies);
    return {bodies->position, bodies->rotor, bodies->velocity, bodies->angular_velocity, bodies};
}

}  // namespace tesserae

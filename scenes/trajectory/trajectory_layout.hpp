// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "scenes/trajectory/hdf5.hpp"
#include "scenes/trajectory/joint_datasets.hpp"
#include "scenes/trajectory/trajectory.hpp"

// Where a trajectory's parts lie in its file, for the writer and the reader.
namespace tesserae::scenes {

/// The group of what bodies are and do.
inline constexpr const char* kBodies = "/particles/bodies";

/// The components of a vector and of a plane, as they lie in memory and in a file.
inline constexpr const char* kVectorComponents = "x y z w";
inline constexpr const char* kPlaneComponents = "xy xz xw yz yw zw";

/// A property of bodies: an H5MD element of `width` doubles a body.
struct StateElement {
    const char* name;
    const char* unit;
    std::size_t width;
    const char* components;
};
inline constexpr std::array<StateElement, 4> kStateElements = {{
    {"position", "m", 4, kVectorComponents},
    {"rotor", "", 8, "s xy xz xw yz yw zw xyzw"},
    {"velocity", "m s-1", 4, kVectorComponents},
    {"angular_velocity", "rad s-1", 6, kPlaneComponents},
}};

/// What sums up a stored step: an H5MD observable of `width` numbers of 8 bytes.
struct Observable {
    const char* name;
    const char* unit;
    std::size_t width;
    bool is_count;                ///< an integer; else reals
    const char* components = "";  ///< none: a single number
    bool may_lack = false;        ///< files of earlier versions have none; it then reads as 0
};
inline constexpr std::array<Observable, 10> kObservables = {{
    {"kinetic_energy", "kg m2 s-2", 1, false},
    {"potential_energy", "kg m2 s-2", 1, false},
    {"momentum", "kg m s-1", 4, false, kVectorComponents},
    {"angular_momentum", "kg m2 s-1", 6, false, kPlaneComponents},
    {"contacts", "", 1, true},
    {"penetration", "m", 1, false},
    {"mean_penetration", "m", 1, false},
    {"solver_residual", "m s-1", 1, false},
    {"asleep", "", 1, true},
    {"sweeps", "", 1, true, "", true},
}};

/// The datasets that grow by a row with every stored step.
struct TrajectoryDatasets {
    hdf5::Handle step, time;
    std::array<hdf5::Handle, kStateElements.size()> state;     ///< in that order
    std::array<hdf5::Handle, kObservables.size()> observable;  ///< in that order; none: it lacks
    std::array<hdf5::Handle, kJointElements.size()> joint;     ///< in that order; none: no joints
    std::uint64_t joints = 0;

    std::vector<const hdf5::Handle*> all() const;
    /// Rows that every dataset has.
    std::uint64_t whole_rows() const;
    /// Drops or adds rows where a dataset has more or fewer.
    void resize(std::uint64_t rows) const;
};

/// Where the bodies' states lie in memory, in the order of kStateElements.
std::array<const double*, 4> state_arrays(const Bodies& bodies);
std::array<double*, 4> state_arrays(Bodies& bodies);

/// Where a step's observables lie in memory, in the order of kObservables.
std::array<const void*, kObservables.size()> observable_values(const StepFacts& facts);
std::array<void*, kObservables.size()> observable_values(StepFacts& facts);

/// The record (resume_record.hpp) of a finished file, from which it can be continued: bytes, none
/// while the file grows.
inline constexpr const char* kCheckpoint = "/parameters/checkpoint";
/// The group of what a growing file is continued from.
inline constexpr const char* kResume = "/parameters/resume";

/// Everything but the rows. @throws hdf5::Failure
void create_layout(const hdf5::Handle& file, const TrajectoryHeader& header);
/// The scene's texts may change while its motion stays the same. Flushes.
void replace_scene(const hdf5::Handle& file, const TrajectoryHeader& header);

/// What datasets are opened for: only those in chunks can grow.
enum class Opened { kToRead, kToGrow };
/// @throws hdf5::Failure   a shape, type, size or filter is not that of a trajectory
TrajectoryDatasets open_datasets(const hdf5::Handle& file, std::uint64_t bodies,
                                 std::uint64_t joints, std::uint64_t file_bytes, Opened opened);
TrajectoryHeader read_header(const hdf5::Handle& file, std::uint64_t file_bytes);

/// Length of a file that begins like a whole one of HDF5's default format: signature, version 0,
/// 64-bit offsets, no longer by its own account than it is. A first sieve before HDF5 sees it.
/// @throws hdf5::Failure
std::uint64_t checked_file_bytes(const std::filesystem::path& path);

/// Bodies without types whose states a row can be read into.
Bodies room_for(std::uint64_t bodies);

void write_row(const TrajectoryDatasets& data, std::uint64_t row, const StepFacts& facts,
               const Bodies& bodies);
void read_row(const TrajectoryDatasets& data, std::uint64_t row, StepFacts& facts, Bodies& bodies);
JointFacts read_joints(const TrajectoryDatasets& data, std::uint64_t row);

}  // namespace tesserae::scenes

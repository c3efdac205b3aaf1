// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/step/memory.hpp"
#include "scenes/named_bodies.hpp"

// Trajectories as HDF5 files after H5MD 1.1 (h5md.nongnu.org), in the default file format. HDF5
// here is built without locks of its own: use all of this from one thread at a time.
namespace tesserae::scenes {

/// What bodies are, beside how they move. Refers to lists that must outlive whoever has it.
struct BodyDescriptions {
    std::span<const BodyType> types;
    std::span<const std::uint32_t> type;  ///< of every body: index into types
    std::span<const NamedBodies> names;   ///< ascending, covering all bodies
};

/// Bytes that a file takes to describe a body, before compression.
std::uint64_t description_bytes(const BodyDescriptions& bodies);

/// What a trajectory says of a joint, beside what it does.
struct JointDescription {
    std::string name;
    std::string unit;  ///< of its position: "m", "deg"; empty: it has none

    friend bool operator==(const JointDescription&, const JointDescription&) = default;
};

/// What a trajectory says of itself. Only `motion_hash`, `motion_version`, `bodies`,
/// the number of joints, `steps_per_second` and `store_every` decide whether a file can be
/// continued.
struct TrajectoryHeader {
    std::string scene_name, source, effective, hash, motion_hash;
    std::string creator = "tesserae";  ///< of the file; that of view's own: "tesserae view"
    std::string program_version;
    std::uint64_t bodies = 0;
    double steps_per_second = 0;
    std::uint64_t store_every = 0;  ///< 0: the steps that frames need
    /// That the scene is simulated to: a file whose last row is of an earlier one ends early. None
    /// in files that do not say it.
    std::optional<std::uint64_t> last_step;
    int motion_version = 1;      ///< by which bodies were moved; 1 in files that do not say it
    BodyDescriptions described;  ///< of all bodies, for the writer; a reader leaves it empty
    std::vector<JointDescription> joints;  ///< of all joints, in the scene's order
    std::uint64_t joint_parts = 0;  ///< see core's Joints; for the writer; a reader leaves it 0
};

/// What a stored step tells of every joint, in the scene's order; all lists are empty where a scene
/// has no joints.
struct JointFacts {
    std::vector<double> impulse;          ///< size of what acts in the step that led here [N s]
    std::vector<double> angular_impulse;  ///< and of its moment about the anchor [N m s]
    std::vector<double> error;            ///< how far held points are apart [m]
    std::vector<double> angular_error;    ///< by what angle held directions are off [deg]
    std::vector<double> position;  ///< of the one free coordinate [m, deg]; NaN if it has not one
    std::vector<std::uint8_t> broken;  ///< 1 if it is
};

/// What a stored step is besides the bodies' states.
struct StepFacts {
    std::uint64_t step = 0;
    double time = 0;  ///< [s]
    StepReport report;
    double kinetic_energy = 0, potential_energy = 0;  ///< [J]
    Vec4 momentum = Vec4::Zero();                     ///< [kg m/s]
    Bivector angular_momentum;                        ///< about the origin [kg m^2/s]
    JointFacts joints;
};

/// Writes FILE.h5.partial row by row, FILE.h5 once finish()ed. The bytes of every dataset are a
/// pure function of what is appended, whether or not the run was interrupted in between.
///
/// At least every two seconds of wall time during append(), and after the first row, everything
/// goes to the system, in an order (trajectory_driver.hpp) in which a process killed at any moment
/// leaves a file that can be read and continued, with all rows of the last flush. It is not synced
/// to the disk before finish(): that is needed against power cuts only, and would stall the run.
/// Another process may read the growing file, not write it. Every failure (disk full, folder
/// missing) throws RunError with the path and the reason; what was flushed before is kept under the
/// unfinished name.
class TrajectoryWriter {
  public:
    /// Continues an unfinished file of the same motion whose rows are the first of `steps`; else a
    /// copy of such a finished one, which stays whole until the copy takes its name; else starts
    /// anew.
    /// @param steps       all steps that the scene stores, ascending, at least one
    /// @param overwrite   a finished file, and an unfinished one of another motion or of other
    ///                    steps, is replaced
    /// @throws InputError   such a file is there, and not `overwrite`
    /// @throws RunError     another process has the file, or the system does not let it be read:
    ///                      it is left as it is
    TrajectoryWriter(const std::filesystem::path& path, const TrajectoryHeader& header,
                     std::vector<std::uint64_t> steps, bool overwrite);
    /// Without finish(): flushes, and leaves the unfinished file to be continued.
    ~TrajectoryWriter();
    TrajectoryWriter(const TrajectoryWriter&) = delete;
    TrajectoryWriter& operator=(const TrajectoryWriter&) = delete;

    /// Why an unfinished file that was there is not continued; empty if it is, or there was none.
    const std::string& note() const;
    /// Rows that the file has: steps[0] to steps[rows() - 1] are stored.
    std::uint64_t rows() const;

    struct Resume {
        std::uint64_t step = 0;  ///< the last stored one
        StepMemory memory;
    };
    /// Sets the bodies to the last stored row of the file that is continued. None (bodies are left
    /// alone) if there is no row yet.
    std::optional<Resume> resume(Bodies& bodies) const;

    /// The next row; facts.step must be the next of `steps`.
    /// @param memory   of the world after the step, kept for resuming
    void append(const StepFacts& facts, const Bodies& bodies, const StepMemory& memory);

    /// Everything appended so far goes to the system now.
    void flush();

    /// After the last row, or an earlier one where no more are asked for: leaves what a longer run
    /// needs to go on (52 bytes a contact that pushes), takes out what only resuming needs, checks,
    /// syncs, renames.
    void finish();

  private:
    struct File;
    std::unique_ptr<File> file_;
};

/// Reads a trajectory, finished or not. Shapes, types and sizes are checked before anything is
/// read: memory is bounded by the bodies and by 1032 times the file's size (gzip's limit).
/// Known limit: damage inside HDF5's own structures is left to libhdf5 to notice.
/// Links to other places and datasets in other files are not followed.
/// Everything throws InputError with the path and the reason.
class TrajectoryReader {
  public:
    explicit TrajectoryReader(const std::filesystem::path& path);
    ~TrajectoryReader();
    TrajectoryReader(const TrajectoryReader&) = delete;
    TrajectoryReader& operator=(const TrajectoryReader&) = delete;

    const TrajectoryHeader& header() const;
    std::uint64_t rows() const;
    const std::vector<std::uint64_t>& steps() const;  ///< ascending
    const std::vector<double>& times() const;         ///< [s]

    /// Each body's name and mass [kg]. Files of older programs have none, which is an error.
    std::vector<std::string> names() const;
    std::vector<double> masses() const;

    /// Sets position, rotor, velocity and angular velocity; the bodies must be as many as the
    /// file's. Values that are not finite, or rotors not of length 1, are an error.
    void read_row(std::uint64_t row, Bodies& bodies) const;

    /// Of one body, without reading the others.
    Vec4 position(std::uint64_t row, BodyId body) const;

    /// All that was appended besides the states and what is told of joints, of every row.
    std::vector<StepFacts> facts() const;

    /// What a row tells of all joints.
    JointFacts joints(std::uint64_t row) const;

  private:
    struct File;
    std::unique_ptr<File> file_;
};

}  // namespace tesserae::scenes

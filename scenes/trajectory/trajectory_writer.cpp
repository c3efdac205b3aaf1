// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <exception>

#include "core/error.hpp"
#include "core/file/partial_file.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/versions.hpp"
#include "scenes/trajectory/body_datasets.hpp"
#include "scenes/trajectory/resume_record.hpp"
#include "scenes/trajectory/trajectory.hpp"
#include "scenes/trajectory/trajectory_layout.hpp"

namespace tesserae::scenes {
namespace {

using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

/// Longest wall time between flushes during append(): what a kill costs at most. Usual 2 s.
constexpr std::chrono::seconds kFlushInterval(2);

/// Two datasets of bytes take turns, so that one always holds the record of the last whole flush.
constexpr const char* kSlots[2] = {"/parameters/resume/a", "/parameters/resume/b"};
constexpr hsize_t kSlotChunk = 64 * 1024;

/// A dataset of records: bytes in a row, in chunks, so that more of them can be written.
hdf5::Handle open_record(const hdf5::Handle& file, const std::string& name) {
    hdf5::Handle dataset = hdf5::open_dataset(file.get(), name);
    const hdf5::Handle type(H5Dget_type(dataset.get()), H5Tclose);
    const hdf5::Handle creation(H5Dget_create_plist(dataset.get()), H5Pclose);
    if (H5Tget_class(type.get()) != H5T_INTEGER || H5Tget_size(type.get()) != 1 ||
        hdf5::extent_of(dataset).size() != 1 || H5Pget_layout(creation.get()) != H5D_CHUNKED)
        throw hdf5::Failure(name + ": is no record to continue from");
    return dataset;
}

std::optional<ResumeRecord> read_record(const hdf5::Handle& dataset, std::uint64_t file_bytes) {
    const hsize_t count = hdf5::extent_of(dataset)[0];
    if (count == 0 || count > file_bytes) return std::nullopt;
    std::string bytes(count, '\0');
    hdf5::read_rows(dataset, 0, bytes.size(), H5T_NATIVE_UINT8, bytes.data());
    return to_record(bytes);
}

/// A dataset of records never shrinks while the file is open: a record says itself how long it is.
void write_record(const hdf5::Handle& dataset, const ResumeRecord& record) {
    const std::string bytes = to_bytes(record);
    if (hdf5::extent_of(dataset)[0] < bytes.size()) hdf5::resize(dataset, bytes.size());
    hdf5::write_rows(dataset, 0, bytes.size(), H5T_NATIVE_UINT8, bytes.data());
}

}  // namespace

struct TrajectoryWriter::File {
    PartialFile lock;
    TrajectoryHeader header;
    std::vector<std::uint64_t> steps;
    std::string note;

    hdf5::Handle file;  // closed after what is in it
    TrajectoryDatasets data;
    hdf5::Handle checkpoint;
    hdf5::Handle slots[2];  ///< none in a file that is finished but for its name

    std::uint64_t rows = 0;
    ResumeRecord record;  ///< of the rows appended since the last flush
    bool flushed = true;  ///< nothing was appended since the last flush
    bool failed = false;
    int next_slot = 0;
    Clock::time_point last_flush = Clock::now();

    File(const fs::path& path, const TrajectoryHeader& h, std::vector<std::uint64_t> s)
        : lock(path), header(h), steps(std::move(s)) {}

    void open(bool overwrite);
    void remove_if_empty() noexcept;
    std::uint64_t finished_rows(bool overwrite) const;
    void copy_finished();
    bool continue_leftover(bool overwrite);
    TrajectoryHeader open_leftover();
    bool take_leftover(bool overwrite);
    void reopen();
    std::optional<std::string> other_motion(const TrajectoryHeader& there) const;
    std::optional<std::string> other_steps(const TrajectoryHeader& there,
                                           const std::vector<std::uint64_t>& stored) const;
    bool is_good(const ResumeRecord& candidate) const;
    bool find_record(std::uint64_t file_bytes);
    void create_slots();
    void start();
    void flush();
    void write_checkpoint();
    void close_datasets();
    void forget();

    /// Runs what writes. @throws RunError   with the path; everything later fails too
    template <class Work>
    void writing(Work&& work) {
        if (failed) throw RunError(lock.path().string() + ": writing failed before");
        try {
            work();
        } catch (const hdf5::Failure& failure) {
            failed = true;
            forget();
            throw RunError(
                fmt::format("{}: cannot be written: {}", lock.path().string(), failure.what()));
        }
    }
};

/// Why a leftover that is whole goes with other settings; none if it can be continued.
std::optional<std::string> TrajectoryWriter::File::other_motion(
    const TrajectoryHeader& there) const {
    const bool other_version = there.motion_version != header.motion_version;
    if (other_version || there.motion_hash != header.motion_hash) {
        const std::string difference = first_motion_difference(there.effective, header.effective);
        if (other_version && difference.empty())
            return other_motion_version(there.motion_version, header.motion_version);
        return "is of another motion: " + difference;
    }
    if (there.bodies != header.bodies)
        return fmt::format("has {} bodies, here {}", there.bodies, header.bodies);
    if (there.joints.size() != header.joints.size())
        return fmt::format("has {} joints, here {}", there.joints.size(), header.joints.size());
    if (there.steps_per_second != header.steps_per_second)
        return fmt::format("has {} steps per second, here {}", there.steps_per_second,
                           header.steps_per_second);
    const auto stored = [](std::uint64_t every) {
        return every == 0 ? std::string("the steps that frames need")
                          : fmt::format("every {}. step", every);
    };
    if (there.store_every != header.store_every)
        return fmt::format("stores {}, here {}", stored(there.store_every),
                           stored(header.store_every));
    return std::nullopt;
}

/// The same by the steps that it has, which must be the first of those wanted.
std::optional<std::string> TrajectoryWriter::File::other_steps(
    const TrajectoryHeader& there, const std::vector<std::uint64_t>& stored) const {
    const auto [a, b] = std::mismatch(stored.begin(), stored.end(), steps.begin(), steps.end());
    if (a == stored.end()) return std::nullopt;
    std::string what =
        b == steps.end()
            ? fmt::format("goes on to step {} in {} rows, here to step {} in {}", stored.back(),
                          stored.size(), steps.empty() ? 0 : steps.back(), steps.size())
            : fmt::format("stores other steps: row {} is of step {}, here of step {}",
                          a - stored.begin(), *a, *b);
    const std::string cause = first_difference(there.effective, header.effective);
    return cause.empty() ? what : what + "; " + cause;
}

/// Rows of a finished file that is there, to be continued.
std::uint64_t TrajectoryWriter::File::finished_rows(bool overwrite) const try {
    if (!fs::exists(lock.path())) return 0;
    const TrajectoryReader there(lock.path());
    auto other = other_motion(there.header());
    if (!other) other = other_steps(there.header(), there.steps());
    if (other)
        throw InputError(fmt::format("{}: {}; choose another file, or --overwrite",
                                     lock.path().string(), *other));
    return there.rows();
} catch (const InputError&) {
    if (!overwrite) throw;
    return 0;
}

/// A finished file is continued in a copy, so that it stays whole until the copy takes its name.
void TrajectoryWriter::File::copy_finished() {
    forget();
    lock.copy_from(lock.path());
    note.clear();
}

/// The rows since the flush before are those that the record was made of.
bool TrajectoryWriter::File::is_good(const ResumeRecord& candidate) const {
    if (candidate.rows > data.whole_rows()) return false;
    if (!is_of_bodies(candidate.memory, header.bodies) ||
        !is_of_joints(candidate.memory, header.joints.size(), header.joint_parts))
        return false;
    Bodies bodies = room_for(header.bodies);
    std::array<std::uint64_t, 2> hash = {};
    StepFacts facts;
    for (std::uint64_t row = candidate.first; row < candidate.rows; ++row) {
        read_row(data, row, facts, bodies);
        hash = hash_with_row(hash, facts, bodies);
    }
    return hash == candidate.hash && facts.step == candidate.step;
}

/// The record of the last whole flush; none: false.
bool TrajectoryWriter::File::find_record(std::uint64_t file_bytes) {
    bool found = false;
    const auto takes = [&](const hdf5::Handle& dataset) {
        const auto candidate = read_record(dataset, file_bytes);
        if (!candidate || (found && candidate->rows <= record.rows)) return false;
        try {
            if (!is_good(*candidate)) return false;
        } catch (const hdf5::SystemFailure&) {
            throw;
        } catch (const hdf5::Failure&) {
            return false;
        }
        record = *candidate;
        return found = true;
    };
    const bool grows = hdf5::has_link(file.get(), kResume);
    for (int i = 0; grows && i < 2; ++i) {
        slots[i] = open_record(file, kSlots[i]);
        if (takes(slots[i])) next_slot = 1 - i;
    }
    checkpoint = open_record(file, kCheckpoint);
    takes(checkpoint);
    return found;
}

/// @throws hdf5::Failure
TrajectoryHeader TrajectoryWriter::File::open_leftover() {
    const std::uint64_t file_bytes = checked_file_bytes(lock.partial());
    file = hdf5::open_file(lock.partial(), true);
    TrajectoryHeader there = read_header(file, file_bytes);
    if (other_motion(there)) return there;
    data = open_datasets(file, header.bodies, header.joints.size(), file_bytes, Opened::kToGrow);
    if (!find_record(file_bytes)) throw hdf5::Failure("holds no row that can be continued from");
    rows = record.rows;
    return there;
}

/// Makes the leftover one of `rows` rows and of this scene, or refuses it.
bool TrajectoryWriter::File::take_leftover(bool overwrite) {
    const TrajectoryHeader there = open_leftover();
    auto other = other_motion(there);
    if (!other) {
        std::vector<std::uint64_t> stored(rows);
        hdf5::read_rows(data.step, 0, rows, H5T_NATIVE_UINT64, stored.data());
        other = other_steps(there, stored);
    }
    if (other && overwrite) throw hdf5::Failure(*other);
    if (other)
        throw InputError(fmt::format("{}: {}; choose another file, or --overwrite",
                                     lock.partial().string(), *other));
    if (!slots[0]) {
        // One that was about to get its name is left as it is.
        if (rows == steps.size()) return true;
        hdf5::create_group(file.get(), kResume);
        create_slots();
        write_record(slots[0], record);
        hdf5::checked(H5Fflush(file.get(), H5F_SCOPE_LOCAL));
        reopen();
    }
    const auto all = data.all();
    const bool longer = hdf5::extent_of(checkpoint)[0] != 0 ||
                        std::any_of(all.begin(), all.end(), [&](const hdf5::Handle* dataset) {
                            return hdf5::extent_of(*dataset)[0] != rows;
                        });
    const bool other_texts = there.source != header.source || there.effective != header.effective ||
                             there.hash != header.hash || there.scene_name != header.scene_name ||
                             there.joints != header.joints;
    if (!longer && !other_texts) return true;
    // The datasets are shortened first, and in a flush of their own: what they free lies where the
    // file on disk still has something.
    data.resize(rows);
    hdf5::resize(checkpoint, 0);
    reopen();
    // Names before texts: a kill between the two leaves texts that differ still, and this is done
    // again.
    if (!same_body_names(there.effective, header.effective)) {
        replace_names(file, header.described);
        reopen();
    }
    if (there.joints != header.joints) {
        replace_joint_names(file, header.joints);
        reopen();
    }
    if (other_texts) {
        replace_scene(file, header);
        reopen();
    }
    return true;
}

/// Forgets, as HDF5 does with a file, which places in it are free.
void TrajectoryWriter::File::reopen() {
    close_datasets();
    file.close();
    open_leftover();
}

bool TrajectoryWriter::File::continue_leftover(bool overwrite) try {
    return fs::file_size(lock.partial()) > 0 && take_leftover(overwrite);
} catch (const hdf5::SystemFailure& failure) {
    forget();
    throw RunError(fmt::format("{}: cannot be continued: {}; remove it to start anew",
                               lock.partial().string(), failure.what()));
} catch (const hdf5::Failure& failure) {
    note = fmt::format("{}: {}; starting anew", lock.partial().string(), failure.what());
    forget();
    return false;
}

void TrajectoryWriter::File::create_slots() {
    for (int i = 0; i < 2; ++i)
        slots[i] =
            hdf5::create_growing(file.get(), kSlots[i], H5T_STD_U8LE, {0}, {kSlotChunk}, false);
}

void TrajectoryWriter::File::start() {
    file = hdf5::create_file(lock.partial());
    create_layout(file, header);
    create_slots();
    checkpoint = open_record(file, kCheckpoint);
    hdf5::checked(H5Fflush(file.get(), H5F_SCOPE_LOCAL));
    data = open_datasets(file, header.bodies, header.joints.size(), fs::file_size(lock.partial()),
                         Opened::kToGrow);
    rows = 0;
    record = {};
    next_slot = 0;
}

/// Everything to the system: the record first, so that it is never older than the rows it is of.
void TrajectoryWriter::File::flush() {
    if (flushed) return;
    record.rows = rows;
    write_record(slots[next_slot], record);
    hdf5::checked(H5Fflush(file.get(), H5F_SCOPE_LOCAL));
    next_slot = 1 - next_slot;
    record.first = rows;
    record.hash = {};
    flushed = true;
    last_flush = Clock::now();
}

/// The record by which a finished file can be continued. It holds the hash of the last row alone,
/// so that its bytes do not depend on when the file was flushed.
void TrajectoryWriter::File::write_checkpoint() {
    ResumeRecord last = record;
    last.rows = rows;
    last.first = rows - 1;
    StepFacts facts;
    Bodies bodies = room_for(header.bodies);
    read_row(data, last.first, facts, bodies);
    last.hash = hash_with_row({}, facts, bodies);
    write_record(checkpoint, last);
    hdf5::checked(H5Fflush(file.get(), H5F_SCOPE_LOCAL));
}

void TrajectoryWriter::File::close_datasets() {
    data = {};
    checkpoint = {};
    for (hdf5::Handle& slot : slots) slot = {};
}

/// Closes whatever is open, without a word.
void TrajectoryWriter::File::forget() {
    close_datasets();
    file = {};
    rows = 0;
}

/// Continues what is there, or starts.
void TrajectoryWriter::File::open(bool overwrite) {
    const std::uint64_t finished = finished_rows(overwrite);
    bool continued = continue_leftover(overwrite);
    if (rows < finished) {
        copy_finished();
        continued = continue_leftover(overwrite);
    }
    if (!continued) writing([&] { start(); });
    record.first = rows;
    record.hash = {};
    lock.admit_readers();
}

/// What is refused leaves no file that was not there before.
void TrajectoryWriter::File::remove_if_empty() noexcept {
    std::error_code error;
    if (fs::file_size(lock.partial(), error) == 0 && !error) lock.remove();
}

TrajectoryWriter::TrajectoryWriter(const fs::path& path, const TrajectoryHeader& header,
                                   std::vector<std::uint64_t> steps, bool overwrite)
    : file_(std::make_unique<File>(path, header, std::move(steps))) {
    try {
        file_->open(overwrite);
    } catch (...) {
        file_->remove_if_empty();
        throw;
    }
}

TrajectoryWriter::~TrajectoryWriter() {
    if (!file_->file || file_->failed) return;
    try {
        flush();
    } catch (const std::exception&) {
        // The flush before still stands.
    }
}

const std::string& TrajectoryWriter::note() const { return file_->note; }

std::uint64_t TrajectoryWriter::rows() const { return file_->rows; }

std::optional<TrajectoryWriter::Resume> TrajectoryWriter::resume(Bodies& bodies) const {
    if (file_->rows == 0) return std::nullopt;
    TSR_ASSERT(bodies.size() == file_->header.bodies);
    StepFacts facts;
    file_->writing([&] { read_row(file_->data, file_->rows - 1, facts, bodies); });
    Resume resume{file_->record.step, file_->record.memory};
    resume.memory.time = facts.time;
    return resume;
}

void TrajectoryWriter::append(const StepFacts& facts, const Bodies& bodies,
                              const StepMemory& memory) {
    File& f = *file_;
    TSR_ASSERT(bodies.size() == f.header.bodies);
    TSR_ASSERT(facts.joints.broken.size() == f.header.joints.size());
    TSR_ASSERT(f.rows < f.steps.size() && facts.step == f.steps[f.rows]);
    f.writing([&] {
        f.flushed = false;
        write_row(f.data, f.rows, facts, bodies);
        ++f.rows;
        f.record.hash = hash_with_row(f.record.hash, facts, bodies);
        f.record.step = facts.step;
        f.record.memory = memory;
        if (f.rows == 1 || Clock::now() - f.last_flush >= kFlushInterval) f.flush();
    });
}

void TrajectoryWriter::flush() {
    file_->writing([&] { file_->flush(); });
}

void TrajectoryWriter::finish() {
    File& f = *file_;
    TSR_ASSERT(f.rows > 0);
    f.writing([&] {
        f.flush();
        const bool grows = static_cast<bool>(f.slots[0]);
        if (grows) f.write_checkpoint();
        f.close_datasets();
        if (grows) hdf5::remove_link(f.file.get(), kResume);
        f.file.close();
    });
    f.lock.publish();
}

}  // namespace tesserae::scenes

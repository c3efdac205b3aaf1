#include <chrono>
#include <exception>

#include "core/error.hpp"
#include "render/partial_file.hpp"
#include "scenes/resume_record.hpp"
#include "scenes/trajectory.hpp"
#include "scenes/trajectory_layout.hpp"

namespace tesserae::scenes {
namespace {

using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

/// Longest wall time between flushes during append(): what a kill costs at most. Usual 2 s.
constexpr std::chrono::seconds kFlushInterval(2);

/// Two datasets of bytes take turns, so that one always holds the record of the last whole flush.
constexpr const char* kResume = "/parameters/resume";
constexpr const char* kSlots[2] = {"/parameters/resume/a", "/parameters/resume/b"};
constexpr hsize_t kSlotChunk = 64 * 1024;

std::optional<ResumeRecord> read_slot(const hdf5::Handle& slot, std::uint64_t file_bytes) {
    const hdf5::Extent extent = hdf5::extent_of(slot);
    if (extent.size() != 1 || extent[0] == 0 || extent[0] > file_bytes) return std::nullopt;
    std::string bytes(extent[0], '\0');
    hdf5::read_rows(slot, 0, bytes.size(), H5T_NATIVE_UINT8, bytes.data());
    return to_record(bytes);
}

Bodies room_for(std::uint64_t bodies) {
    Bodies room;
    room.type.resize(bodies);
    room.position.resize(bodies);
    room.rotor.resize(bodies);
    room.velocity.resize(bodies);
    room.angular_velocity.resize(bodies);
    return room;
}

}  // namespace

struct TrajectoryWriter::File {
    render::PartialFile lock;
    TrajectoryHeader header;
    std::vector<std::uint64_t> steps;
    std::string note;

    hdf5::Handle file;  // closed after what is in it
    TrajectoryDatasets data;
    hdf5::Handle slots[2];

    std::uint64_t rows = 0;
    ResumeRecord record;  ///< of the rows appended since the last flush
    bool flushed = true;  ///< nothing was appended since the last flush
    bool failed = false;
    int next_slot = 0;
    Clock::time_point last_flush = Clock::now();

    File(const fs::path& path, const TrajectoryHeader& h, std::vector<std::uint64_t> s)
        : lock(path), header(h), steps(std::move(s)) {}

    bool continue_leftover(bool overwrite);
    std::optional<std::string> other_motion(const TrajectoryHeader& there);
    bool is_good(const ResumeRecord& candidate) const;
    bool find_record(std::uint64_t file_bytes);
    void start();
    void flush();
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

/// Why a leftover cannot be continued although it is whole; none if it can.
std::optional<std::string> TrajectoryWriter::File::other_motion(const TrajectoryHeader& there) {
    if (there.motion_hash != header.motion_hash)
        return fmt::format("is of another motion (hash {}, here {})", there.motion_hash,
                           header.motion_hash);
    if (there.bodies != header.bodies)
        return fmt::format("has {} bodies, here {}", there.bodies, header.bodies);
    if (there.steps_per_second != header.steps_per_second ||
        there.store_every != header.store_every)
        return std::string("stores other steps");
    return std::nullopt;
}

/// The rows since the flush before are those that the record was made of, at the steps wanted.
bool TrajectoryWriter::File::is_good(const ResumeRecord& candidate) const try {
    if (candidate.rows > steps.size() || candidate.rows > data.whole_rows()) return false;
    std::vector<std::uint64_t> stored(candidate.rows);
    hdf5::read_rows(data.step, 0, candidate.rows, H5T_NATIVE_UINT64, stored.data());
    if (!std::equal(stored.begin(), stored.end(), steps.begin()) || stored.back() != candidate.step)
        return false;
    Bodies bodies = room_for(header.bodies);
    std::array<std::uint64_t, 2> hash = {};
    for (std::uint64_t row = candidate.first; row < candidate.rows; ++row) {
        StepFacts facts;
        read_row(data, row, facts, bodies);
        hash = hash_with_row(hash, facts, bodies);
    }
    return hash == candidate.hash;
} catch (const hdf5::Failure&) {
    return false;
}

/// The record of the last whole flush; none: false.
bool TrajectoryWriter::File::find_record(std::uint64_t file_bytes) {
    // finish() takes the slots out once every row is flushed: then there is nothing to resume.
    if (!hdf5::has_link(file.get(), kResume)) {
        if (data.whole_rows() != steps.size() || steps.empty()) return false;
        std::vector<std::uint64_t> stored(steps.size());
        hdf5::read_rows(data.step, 0, steps.size(), H5T_NATIVE_UINT64, stored.data());
        if (stored != steps) return false;
        record.rows = steps.size();
        record.step = steps.back();
        return true;
    }
    bool found = false;
    for (int i = 0; i < 2; ++i) {
        slots[i] = hdf5::open_dataset(file.get(), kSlots[i]);
        const auto candidate = read_slot(slots[i], file_bytes);
        if (!candidate || (found && candidate->rows <= record.rows) || !is_good(*candidate))
            continue;
        record = *candidate;
        next_slot = 1 - i;
        found = true;
    }
    return found;
}

bool TrajectoryWriter::File::continue_leftover(bool overwrite) {
    if (fs::file_size(lock.partial()) == 0) return false;
    const auto anew = [&](const std::string& why) {
        note = fmt::format("{}: {}; starting anew", lock.partial().string(), why);
        forget();
        return false;
    };
    try {
        const std::uint64_t file_bytes = checked_file_bytes(lock.partial());
        file = hdf5::open_file(lock.partial(), true);
        const TrajectoryHeader there = read_header(file, file_bytes);
        if (const auto other = other_motion(there)) {
            if (overwrite) return anew(*other);
            throw InputError(fmt::format("{}: {}; choose another file, or --overwrite",
                                         lock.partial().string(), *other));
        }
        data = open_datasets(file, header.bodies, file_bytes);
        if (!find_record(file_bytes)) return anew("holds no row that can be continued from");
        rows = record.rows;
        data.resize(rows);
        if (there.source != header.source || there.effective != header.effective ||
            there.hash != header.hash || there.scene_name != header.scene_name)
            write_scene_texts(file, header);
    } catch (const hdf5::Failure& failure) {
        return anew(failure.what());
    }
    return true;
}

void TrajectoryWriter::File::start() {
    file = hdf5::create_file(lock.partial());
    create_layout(file, header);
    hdf5::create_group(file.get(), kResume);
    for (int i = 0; i < 2; ++i)
        slots[i] =
            hdf5::create_growing(file.get(), kSlots[i], H5T_STD_U8LE, {0}, {kSlotChunk}, false);
    hdf5::checked(H5Fflush(file.get(), H5F_SCOPE_LOCAL));
    data = open_datasets(file, header.bodies, fs::file_size(lock.partial()));
    rows = 0;
    record = {};
    next_slot = 0;
}

/// Everything to the system: the record first, so that it is never older than the rows it is of.
void TrajectoryWriter::File::flush() {
    if (flushed) return;
    record.rows = rows;
    const std::string bytes = to_bytes(record);
    const hdf5::Handle& slot = slots[next_slot];
    // A slot never shrinks: a record says itself how long it is.
    if (hdf5::extent_of(slot)[0] < bytes.size()) hdf5::resize(slot, bytes.size());
    hdf5::write_rows(slot, 0, bytes.size(), H5T_NATIVE_UINT8, bytes.data());
    hdf5::checked(H5Fflush(file.get(), H5F_SCOPE_LOCAL));
    next_slot = 1 - next_slot;
    record.first = rows;
    record.hash = {};
    flushed = true;
    last_flush = Clock::now();
}

/// Closes whatever is open, without a word.
void TrajectoryWriter::File::forget() {
    data = {};
    for (hdf5::Handle& slot : slots) slot = {};
    file = {};
}

TrajectoryWriter::TrajectoryWriter(const fs::path& path, const TrajectoryHeader& header,
                                   std::vector<std::uint64_t> steps, bool overwrite)
    : file_(std::make_unique<File>(path, header, std::move(steps))) {
    if (!file_->continue_leftover(overwrite)) file_->writing([&] { file_->start(); });
    file_->record.first = file_->rows;
    file_->record.hash = {};
    file_->lock.admit_readers();
}

TrajectoryWriter::~TrajectoryWriter() {
    if (!file_->file || file_->failed) return;
    try {
        file_->writing([&] { file_->flush(); });
    } catch (const std::exception&) {
        // The flush before still stands.
    }
}

const std::string& TrajectoryWriter::note() const { return file_->note; }

std::uint64_t TrajectoryWriter::rows() const { return file_->rows; }

std::optional<TrajectoryWriter::Resume> TrajectoryWriter::resume(Bodies& bodies) const {
    if (file_->rows == 0) return std::nullopt;
    TSR_ASSERT(bodies.size() == file_->header.bodies);
    file_->writing([&] {
        StepFacts facts;
        read_row(file_->data, file_->rows - 1, facts, bodies);
    });
    return Resume{file_->record.step, file_->record.memory};
}

void TrajectoryWriter::append(const StepFacts& facts, const Bodies& bodies,
                              const StepMemory& memory) {
    File& f = *file_;
    TSR_ASSERT(bodies.size() == f.header.bodies);
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

void TrajectoryWriter::finish() {
    File& f = *file_;
    TSR_ASSERT(f.rows == f.steps.size());
    f.writing([&] {
        f.flush();
        for (hdf5::Handle& slot : f.slots) slot = {};
        if (hdf5::has_link(f.file.get(), kResume)) hdf5::remove_link(f.file.get(), kResume);
        f.data = {};
        f.file.close();
    });
    f.lock.publish();
}

}  // namespace tesserae::scenes

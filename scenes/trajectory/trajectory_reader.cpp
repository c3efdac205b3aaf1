// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.hpp"
#include "scenes/trajectory/entry_datasets.hpp"
#include "scenes/trajectory/trajectory.hpp"
#include "scenes/trajectory/trajectory_layout.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

/// How far the square of a stored rotor's length may be from 1: far more than rounding, far less
/// than shows.
constexpr double kRotorLength = 1e-6;

}  // namespace

struct TrajectoryReader::File {
    fs::path path;
    std::uint64_t bytes = 0;
    TrajectoryHeader header;
    std::vector<std::uint64_t> steps;
    std::vector<double> times;
    hdf5::Handle file;
    TrajectoryDatasets data;

    void open();

    template <class Work>
    void reading(Work&& work) const {
        try {
            work();
        } catch (const hdf5::Failure& failure) {
            // Under this name another process may be amid a flush.
            const bool grows = path.extension() == ".partial";
            const char* hint = grows ? "; if it is being written, try again" : "";
            throw InputError(fmt::format("{}: not a readable trajectory: {}{}", path.string(),
                                         failure.what(), hint));
        }
    }
};

void TrajectoryReader::File::open() {
    bytes = checked_file_bytes(path);
    file = hdf5::open_file(path, false);
    header = read_header(file, bytes);
    data = open_datasets(file, header.bodies, header.joints.size(), bytes, Opened::kToRead);
    const std::uint64_t rows = data.whole_rows();
    steps.resize(rows);
    times.resize(rows);
    if (rows == 0) return;
    hdf5::read_rows(data.step, 0, rows, H5T_NATIVE_UINT64, steps.data());
    hdf5::read_rows(data.time, 0, rows, H5T_NATIVE_DOUBLE, times.data());
    if (std::adjacent_find(steps.begin(), steps.end(), std::greater_equal<>()) != steps.end())
        throw hdf5::Failure("its steps do not ascend");
    if (!std::all_of(times.begin(), times.end(), [](double t) { return std::isfinite(t); }))
        throw hdf5::Failure("a time is not finite");
}

TrajectoryReader::TrajectoryReader(const fs::path& path) : file_(std::make_unique<File>()) {
    file_->path = path;
    file_->reading([&] { file_->open(); });
}

TrajectoryReader::~TrajectoryReader() = default;

const TrajectoryHeader& TrajectoryReader::header() const { return file_->header; }

std::uint64_t TrajectoryReader::rows() const { return file_->steps.size(); }

const std::vector<std::uint64_t>& TrajectoryReader::steps() const { return file_->steps; }

const std::vector<double>& TrajectoryReader::times() const { return file_->times; }

std::vector<std::string> TrajectoryReader::names() const {
    std::vector<std::string> names;
    file_->reading([&] {
        const hdf5::Handle group = hdf5::open_group(file_->file.get(), kBodies);
        names = read_texts(group.get(), "name", kBodies, file_->header.bodies, file_->bytes);
    });
    return names;
}

std::vector<double> TrajectoryReader::masses() const {
    std::vector<double> masses;
    file_->reading([&] {
        const hdf5::Handle group = hdf5::open_group(file_->file.get(), kBodies);
        masses = read_reals(group.get(), "mass", kBodies, file_->header.bodies, file_->bytes);
    });
    return masses;
}

void TrajectoryReader::read_row(std::uint64_t row, Bodies& bodies) const {
    TSR_ASSERT(row < rows() && bodies.size() == file_->header.bodies);
    file_->reading([&] {
        StepFacts facts;
        scenes::read_row(file_->data, row, facts, bodies);
        const auto arrays = state_arrays(std::as_const(bodies));
        for (std::size_t i = 0; i < arrays.size(); ++i) {
            const std::size_t width = kStateElements[i].width;
            const double* end = arrays[i] + bodies.size() * width;
            const double* bad =
                std::find_if(arrays[i], end, [](double value) { return !std::isfinite(value); });
            if (bad != end)
                throw hdf5::Failure(fmt::format("step {}: {} of body {} is not finite",
                                                file_->steps[row], kStateElements[i].name,
                                                static_cast<std::size_t>(bad - arrays[i]) / width));
        }
        for (std::size_t id = 0; id < bodies.size(); ++id) {
            const Rotor& r = bodies.rotor[id];
            const double square = r.s * r.s + dot(r.b, r.b) + r.p * r.p;
            if (!(std::abs(square - 1) <= kRotorLength))
                throw hdf5::Failure(fmt::format("step {}: rotor of body {} is not of length 1",
                                                file_->steps[row], id));
        }
    });
}

Vec4 TrajectoryReader::position(std::uint64_t row, BodyId body) const {
    TSR_ASSERT(row < rows() && body < file_->header.bodies);
    Vec4 position;
    file_->reading([&] {
        hdf5::read_item(file_->data.state[0], row, body, H5T_NATIVE_DOUBLE, position.data());
        if (!position.allFinite())
            throw hdf5::Failure(fmt::format("step {}: {} of body {} is not finite",
                                            file_->steps[row], kStateElements[0].name, body));
    });
    return position;
}

std::vector<StepFacts> TrajectoryReader::facts() const {
    const File& f = *file_;
    std::vector<StepFacts> facts(rows());
    if (facts.empty()) return facts;
    for (std::size_t i = 0; i < facts.size(); ++i) {
        facts[i].step = f.steps[i];
        facts[i].time = f.times[i];
    }
    for (std::size_t o = 0; o < kObservables.size(); ++o) {
        if (!f.data.observable[o]) continue;
        const std::size_t bytes = 8 * kObservables[o].width;
        std::string column(facts.size() * bytes, '\0');
        f.reading([&] {
            hdf5::read_rows(f.data.observable[o], 0, facts.size(),
                            kObservables[o].is_count ? H5T_NATIVE_UINT64 : H5T_NATIVE_DOUBLE,
                            column.data());
        });
        for (std::size_t i = 0; i < facts.size(); ++i)
            std::memcpy(observable_values(facts[i])[o], column.data() + i * bytes, bytes);
    }
    return facts;
}

JointFacts TrajectoryReader::joints(std::uint64_t row) const {
    TSR_ASSERT(row < rows());
    JointFacts joints;
    file_->reading([&] { joints = read_joints(file_->data, row); });
    return joints;
}

}  // namespace tesserae::scenes

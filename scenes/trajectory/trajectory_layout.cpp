// SPDX-License-Identifier: Apache-2.0
#include "scenes/trajectory/trajectory_layout.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <limits>
#include <numeric>
#include <type_traits>

#include "core/error.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/versions.hpp"
#include "scenes/trajectory/body_datasets.hpp"
#include "scenes/trajectory/dataset_storage.hpp"

namespace tesserae::scenes {
namespace {

using hdf5::checked;
using hdf5::Extent;
using hdf5::Handle;

static_assert(sizeof(Vec4) == 32 && sizeof(Rotor) == 64 && sizeof(Bivector) == 48 &&
                  std::is_standard_layout_v<Rotor>,
              "states are written as they lie in memory");

constexpr const char* kScene = "/parameters/scene";
constexpr const char *kMotionVersionName = "motion_version", *kLastStepName = "last_step";
/// The number of joints; none where there are no joints.
constexpr const char* kJointsName = "joints";

/// Bytes of a chunk of states, usual 1 MiB (HDF5's chunk cache holds one). A chunk never spans
/// rows: compressed chunks that grow are moved, and their old place, which the last flush still
/// points to, is used again; so a chunk is written once.
constexpr std::uint64_t kChunkBytes = 1 << 20;
/// Numbers in a chunk of a column: uncompressed, rewritten in place with the same old rows.
constexpr std::uint64_t kColumnChunk = 1024;
/// Bytes of a chunk of a finished file's record, usual 8 KiB.
constexpr hsize_t kRecordChunk = 8 * 1024;

std::string element_path(const char* name) { return std::string(kBodies) + "/" + name; }
std::string observable_path(const char* name) { return std::string("/observables/") + name; }

/// A column of numbers, or of `width` numbers a row.
Handle create_column(hid_t parent, const std::string& name, hid_t type, const char* unit,
                     std::size_t width = 1) {
    Extent extent = {0}, chunk = {kColumnChunk / width};
    if (width > 1) extent.push_back(width), chunk.push_back(width);
    Handle column = hdf5::create_growing(parent, name, type, extent, chunk, false);
    if (*unit) hdf5::add_text_attribute(column.get(), "unit", unit);
    return column;
}

void create_h5md(const Handle& file, const std::string& name, const std::string& version) {
    const Handle root = hdf5::create_group(file.get(), "/h5md");
    const int h5md_version[2] = {1, 1}, module_version[2] = {1, 0};
    hdf5::add_attribute(root.get(), "version", H5T_STD_I32LE, H5T_NATIVE_INT, {2}, h5md_version);
    const Handle author = hdf5::create_group(root.get(), "author");
    // H5MD wants a name; a person's would make the bytes depend on who ran it.
    hdf5::add_text_attribute(author.get(), "name", "tesserae");
    const Handle creator = hdf5::create_group(root.get(), "creator");
    hdf5::add_text_attribute(creator.get(), "name", name);
    hdf5::add_text_attribute(creator.get(), "version", version);
    const Handle modules = hdf5::create_group(root.get(), "modules");
    for (const char* part : {"tesserae", "units"}) {
        const Handle module = hdf5::create_group(modules.get(), part);
        hdf5::add_attribute(module.get(), "version", H5T_STD_I32LE, H5T_NATIVE_INT, {2},
                            module_version);
    }
}

void create_box(hid_t bodies) {
    const Handle box = hdf5::create_group(bodies, "box");
    const int dimension = 4;
    hdf5::add_attribute(box.get(), "dimension", H5T_STD_I32LE, H5T_NATIVE_INT, {}, &dimension);
    Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
    checked(H5Tset_size(text.get(), 4));
    checked(H5Tset_strpad(text.get(), H5T_STR_NULLPAD));
    hdf5::add_attribute(box.get(), "boundary", text.get(), text.get(), {4}, "nonenonenonenone");
}

void create_bodies(const Handle& file, const TrajectoryHeader& header) {
    const std::uint64_t bodies = header.bodies;
    TSR_ASSERT(header.described.type.size() == bodies);
    hdf5::create_group(file.get(), "/particles");
    const Handle group = hdf5::create_group(file.get(), kBodies);
    create_box(group.get());
    for (const StateElement& element : kStateElements) {
        const Handle parent = hdf5::create_group(group.get(), element.name);
        const std::uint64_t chunk =
            std::clamp<std::uint64_t>(bodies, 1, kChunkBytes / (8 * element.width));
        const Handle value =
            hdf5::create_growing(parent.get(), "value", H5T_IEEE_F64LE, {0, bodies, element.width},
                                 {1, chunk, element.width}, true);
        if (*element.unit) hdf5::add_text_attribute(value.get(), "unit", element.unit);
        hdf5::add_text_attribute(value.get(), "components", element.components);
    }
    const Handle position = hdf5::open_group(group.get(), "position");
    create_column(position.get(), "step", H5T_STD_I64LE, "");
    create_column(position.get(), "time", H5T_IEEE_F64LE, "s");

    std::vector<std::uint32_t> ids(bodies);
    std::iota(ids.begin(), ids.end(), 0u);
    const Handle id =
        hdf5::create_growing(group.get(), "id", H5T_STD_I64LE, {bodies},
                             {std::clamp<std::uint64_t>(bodies, 1, kChunkBytes / 8)}, true);
    if (bodies > 0) hdf5::write_rows(id, 0, bodies, H5T_NATIVE_UINT32, ids.data());
    create_body_datasets(group, header.described);
}

void create_observables(const Handle& file) {
    const Handle group = hdf5::create_group(file.get(), "/observables");
    for (const Observable& o : kObservables) {
        const Handle parent = hdf5::create_group(group.get(), o.name);
        const Handle value = create_column(
            parent.get(), "value", o.is_count ? H5T_STD_I64LE : H5T_IEEE_F64LE, o.unit, o.width);
        if (*o.components) hdf5::add_text_attribute(value.get(), "components", o.components);
    }
}

/// All elements were stored at the same steps: H5MD has them share the datasets.
void share_steps(const Handle& file, bool has_joints) {
    const std::string from = element_path("position");
    std::vector<std::string> to;
    for (std::size_t i = 1; i < kStateElements.size(); ++i)
        to.push_back(element_path(kStateElements[i].name));
    for (const Observable& o : kObservables) to.push_back(observable_path(o.name));
    if (has_joints)
        for (const JointElement& element : kJointElements)
            to.push_back(joint_element_path(element));
    for (const std::string& element : to)
        for (const char* name : {"/step", "/time"})
            hdf5::hard_link(file.get(), from + name, element + name);
}

void fill_scene(const Handle& scene, const TrajectoryHeader& header) {
    hdf5::add_attribute(scene.get(), "bodies", H5T_STD_I64LE, H5T_NATIVE_UINT64, {},
                        &header.bodies);
    hdf5::add_attribute(scene.get(), "steps_per_second", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {},
                        &header.steps_per_second);
    hdf5::add_attribute(scene.get(), "store_every", H5T_STD_I64LE, H5T_NATIVE_UINT64, {},
                        &header.store_every);
    if (header.last_step)
        hdf5::add_attribute(scene.get(), kLastStepName, H5T_STD_I64LE, H5T_NATIVE_UINT64, {},
                            &*header.last_step);
    hdf5::add_attribute(scene.get(), kMotionVersionName, H5T_STD_I32LE, H5T_NATIVE_INT, {},
                        &header.motion_version);
    if (const std::uint64_t joints = header.joints.size(); joints > 0)
        hdf5::add_attribute(scene.get(), kJointsName, H5T_STD_I64LE, H5T_NATIVE_UINT64, {},
                            &joints);
    const std::pair<const char*, const std::string*> texts[] = {
        {"name", &header.scene_name},
        {"text", &header.source},
        {"effective", &header.effective},
        {"hash", &header.hash},
        {"motion_hash", &header.motion_hash}};
    for (const auto& [name, text] : texts) hdf5::create_text(scene.get(), name, *text);
}

/// Opens a dataset of numbers of so many bytes whose axes after the first are as given.
Handle open_numbers(hid_t file, const std::string& name, H5T_class_t kind, std::size_t bytes,
                    const Extent& row, std::uint64_t file_bytes, Opened opened) {
    const auto require = [&](bool good, const char* what) {
        if (!good) throw hdf5::Failure(name + ": " + what);
    };
    Handle dataset = hdf5::open_dataset(file, name);
    const Handle type(H5Dget_type(dataset.get()), H5Tclose);
    require(H5Tget_class(type.get()) == kind && H5Tget_size(type.get()) == bytes,
            kind == H5T_FLOAT ? "is not of 64-bit reals"
            : bytes == 1      ? "is not of bytes"
                              : "is not of 64-bit integers");
    const Extent extent = hdf5::extent_of(dataset);
    require(extent.size() == row.size() + 1 && std::equal(row.begin(), row.end(), ++extent.begin()),
            "has another shape");
    const DatasetStorage storage = checked_storage(dataset, name, file_bytes);
    require(opened == Opened::kToRead || !storage.chunk.empty(), "is not stored in chunks");
    return dataset;
}

hid_t memory_type(const JointElement& element) {
    return element.is_byte ? H5T_NATIVE_UINT8 : H5T_NATIVE_DOUBLE;
}

template <class Pointer, class Facts>
std::array<Pointer, kObservables.size()> values_of(Facts& f) {
    return {
        &f.kinetic_energy,  &f.potential_energy,   f.momentum.data(),          &f.angular_momentum,
        &f.report.contacts, &f.report.penetration, &f.report.mean_penetration, &f.report.residual,
        &f.report.asleep,   &f.report.sweeps};
}

}  // namespace

std::vector<const Handle*> TrajectoryDatasets::all() const {
    std::vector<const Handle*> all = {&step, &time};
    for (const Handle& dataset : state) all.push_back(&dataset);
    for (const Handle& dataset : observable)
        if (dataset) all.push_back(&dataset);
    if (joints > 0)
        for (const Handle& dataset : joint) all.push_back(&dataset);
    return all;
}

std::uint64_t TrajectoryDatasets::whole_rows() const {
    std::uint64_t rows = std::numeric_limits<std::uint64_t>::max();
    for (const Handle* dataset : all())
        rows = std::min<std::uint64_t>(rows, hdf5::extent_of(*dataset)[0]);
    return rows;
}

void TrajectoryDatasets::resize(std::uint64_t rows) const {
    for (const Handle* dataset : all()) hdf5::resize(*dataset, rows);
}

std::array<double*, 4> state_arrays(Bodies& bodies) {
    return {reinterpret_cast<double*>(bodies.position.data()),
            reinterpret_cast<double*>(bodies.rotor.data()),
            reinterpret_cast<double*>(bodies.velocity.data()),
            reinterpret_cast<double*>(bodies.angular_velocity.data())};
}

std::array<const double*, 4> state_arrays(const Bodies& bodies) {
    return {reinterpret_cast<const double*>(bodies.position.data()),
            reinterpret_cast<const double*>(bodies.rotor.data()),
            reinterpret_cast<const double*>(bodies.velocity.data()),
            reinterpret_cast<const double*>(bodies.angular_velocity.data())};
}

std::array<void*, kObservables.size()> observable_values(StepFacts& facts) {
    return values_of<void*>(facts);
}

std::array<const void*, kObservables.size()> observable_values(const StepFacts& facts) {
    return values_of<const void*>(facts);
}

void create_layout(const Handle& file, const TrajectoryHeader& header) {
    create_h5md(file, header.creator, header.program_version);
    create_bodies(file, header);
    create_observables(file);
    if (!header.joints.empty()) create_joint_datasets(file, header.joints);
    share_steps(file, !header.joints.empty());
    hdf5::create_group(file.get(), "/parameters");
    // The group that goes at the end is named first: see trajectory_driver.hpp.
    hdf5::create_group(file.get(), kResume);
    hdf5::create_growing(file.get(), kCheckpoint, H5T_STD_U8LE, {0}, {kRecordChunk}, false);
    fill_scene(hdf5::create_group(file.get(), kScene), header);
}

void replace_scene(const Handle& file, const TrajectoryHeader& header) {
    const Handle scene = hdf5::create_unnamed_group(file.get());
    fill_scene(scene, header);
    checked(H5Fflush(file.get(), H5F_SCOPE_LOCAL));
    hdf5::replace_link(file.get(), kScene, scene);
    checked(H5Fflush(file.get(), H5F_SCOPE_LOCAL));
}

TrajectoryDatasets open_datasets(const Handle& file, std::uint64_t bodies, std::uint64_t joints,
                                 std::uint64_t file_bytes, Opened opened) {
    const auto column = [&](const std::string& name, H5T_class_t kind) {
        return open_numbers(file.get(), name, kind, 8, {}, file_bytes, opened);
    };
    TrajectoryDatasets data;
    data.joints = joints;
    data.step = column(element_path("position") + "/step", H5T_INTEGER);
    data.time = column(element_path("position") + "/time", H5T_FLOAT);
    for (std::size_t i = 0; i < kStateElements.size(); ++i)
        data.state[i] =
            open_numbers(file.get(), element_path(kStateElements[i].name) + "/value", H5T_FLOAT, 8,
                         {bodies, kStateElements[i].width}, file_bytes, opened);
    for (std::size_t i = 0; i < kObservables.size(); ++i) {
        const Observable& o = kObservables[i];
        if (o.may_lack && !hdf5::has_link(file.get(), observable_path(o.name))) continue;
        data.observable[i] = open_numbers(
            file.get(), observable_path(o.name) + "/value", o.is_count ? H5T_INTEGER : H5T_FLOAT, 8,
            o.width > 1 ? Extent{o.width} : Extent{}, file_bytes, opened);
    }
    for (std::size_t i = 0; joints > 0 && i < kJointElements.size(); ++i) {
        const JointElement& element = kJointElements[i];
        data.joint[i] = open_numbers(file.get(), joint_element_path(element) + "/value",
                                     element.is_byte ? H5T_INTEGER : H5T_FLOAT, bytes_of(element),
                                     {joints}, file_bytes, opened);
    }
    return data;
}

TrajectoryHeader read_header(const Handle& file, std::uint64_t file_bytes) {
    TrajectoryHeader header;
    const Handle scene = hdf5::open_group(file.get(), kScene);
    header.scene_name = hdf5::read_text(scene.get(), "name", file_bytes);
    header.source = hdf5::read_text(scene.get(), "text", file_bytes);
    header.effective = hdf5::read_text(scene.get(), "effective", file_bytes);
    header.hash = hdf5::read_text(scene.get(), "hash", file_bytes);
    header.motion_hash = hdf5::read_text(scene.get(), "motion_hash", file_bytes);
    hdf5::read_attribute(scene.get(), "bodies", H5T_NATIVE_UINT64, &header.bodies);
    hdf5::read_attribute(scene.get(), "steps_per_second", H5T_NATIVE_DOUBLE,
                         &header.steps_per_second);
    hdf5::read_attribute(scene.get(), "store_every", H5T_NATIVE_UINT64, &header.store_every);
    if (hdf5::has_attribute(scene.get(), kLastStepName))
        hdf5::read_attribute(scene.get(), kLastStepName, H5T_NATIVE_UINT64,
                             &header.last_step.emplace());
    if (hdf5::has_attribute(scene.get(), kMotionVersionName))
        hdf5::read_attribute(scene.get(), kMotionVersionName, H5T_NATIVE_INT,
                             &header.motion_version);
    // A trajectory of the solver that was removed stays one of another motion.
    if (std::string text = without_solver(header.effective);
        text != header.effective && with_solver(text) == header.effective) {
        header.motion_hash = motion_hash(text, header.motion_version);
        header.effective = std::move(text);
    }
    if (hdf5::has_attribute(scene.get(), kJointsName)) {
        std::uint64_t joints = 0;
        hdf5::read_attribute(scene.get(), kJointsName, H5T_NATIVE_UINT64, &joints);
        if (joints > 0) header.joints = read_joint_descriptions(file, joints, file_bytes);
    }
    if (header.motion_version < 1)
        throw hdf5::Failure(std::string(kMotionVersionName) + ": is not a version from 1 on");
    const Handle creator = hdf5::open_group(file.get(), "/h5md/creator");
    header.creator = hdf5::read_text_attribute(creator.get(), "name");
    header.program_version = hdf5::read_text_attribute(creator.get(), "version");
    return header;
}

std::uint64_t checked_file_bytes(const std::filesystem::path& path) {
    std::error_code error;
    const bool regular = std::filesystem::is_regular_file(path, error);
    if (error) throw hdf5::SystemFailure(error.message());
    if (!regular) throw hdf5::Failure("is not a file");
    const std::uint64_t bytes = std::filesystem::file_size(path, error);

    // HDF5 File Format Specification 3.0, II.A: superblock version 0, at the file's beginning.
    unsigned char block[96] = {};
    std::ifstream in(path, std::ios::binary);
    if (!in) throw hdf5::SystemFailure(std::strerror(errno));
    if (!in.read(reinterpret_cast<char*>(block), sizeof block) && !in.eof())
        throw hdf5::SystemFailure(std::strerror(errno));
    if (static_cast<std::size_t>(in.gcount()) < sizeof block ||
        std::memcmp(block, "\211HDF\r\n\032\n", 8) != 0)
        throw hdf5::Failure("is not an HDF5 file");
    const auto word = [&](std::size_t at) {
        std::uint64_t value;
        std::memcpy(&value, block + at, 8);
        return value;
    };
    static_assert(std::endian::native == std::endian::little);
    if (block[8] != 0 || block[13] != 8 || block[14] != 8 || word(24) != 0)
        throw hdf5::Failure("is not in HDF5's default format");
    if (word(40) > bytes)
        throw hdf5::Failure("is cut off: " + std::to_string(bytes) + " of " +
                            std::to_string(word(40)) + " bytes");
    return bytes;
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

void write_row(const TrajectoryDatasets& data, std::uint64_t row, const StepFacts& facts,
               const Bodies& bodies) {
    data.resize(row + 1);
    hdf5::write_rows(data.step, row, 1, H5T_NATIVE_UINT64, &facts.step);
    hdf5::write_rows(data.time, row, 1, H5T_NATIVE_DOUBLE, &facts.time);
    const auto values = observable_values(facts);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (data.observable[i])
            hdf5::write_rows(data.observable[i], row, 1,
                             kObservables[i].is_count ? H5T_NATIVE_UINT64 : H5T_NATIVE_DOUBLE,
                             values[i]);
    const auto of_joints = joint_values(facts.joints);
    for (std::size_t i = 0; data.joints > 0 && i < of_joints.size(); ++i)
        hdf5::write_rows(data.joint[i], row, 1, memory_type(kJointElements[i]), of_joints[i]);
    const auto arrays = state_arrays(bodies);
    if (bodies.size() == 0) return;
    for (std::size_t i = 0; i < arrays.size(); ++i)
        hdf5::write_rows(data.state[i], row, 1, H5T_NATIVE_DOUBLE, arrays[i]);
}

void read_row(const TrajectoryDatasets& data, std::uint64_t row, StepFacts& facts, Bodies& bodies) {
    hdf5::read_rows(data.step, row, 1, H5T_NATIVE_UINT64, &facts.step);
    hdf5::read_rows(data.time, row, 1, H5T_NATIVE_DOUBLE, &facts.time);
    const auto values = observable_values(facts);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (data.observable[i])
            hdf5::read_rows(data.observable[i], row, 1,
                            kObservables[i].is_count ? H5T_NATIVE_UINT64 : H5T_NATIVE_DOUBLE,
                            values[i]);
    facts.joints = read_joints(data, row);
    const auto arrays = state_arrays(bodies);
    if (bodies.size() == 0) return;
    for (std::size_t i = 0; i < arrays.size(); ++i)
        hdf5::read_rows(data.state[i], row, 1, H5T_NATIVE_DOUBLE, arrays[i]);
}

JointFacts read_joints(const TrajectoryDatasets& data, std::uint64_t row) {
    JointFacts facts = room_for_joints(data.joints);
    const auto values = joint_values(facts);
    for (std::size_t i = 0; data.joints > 0 && i < values.size(); ++i)
        hdf5::read_rows(data.joint[i], row, 1, memory_type(kJointElements[i]), values[i]);
    return facts;
}

}  // namespace tesserae::scenes

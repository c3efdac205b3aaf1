// SPDX-License-Identifier: Apache-2.0
// Unfinished trajectories that are continued: the file as HDF5 has it, and the record of what one
// step leaves to the next (resume_record.hpp), damaged and given its hash again.
#include <fstream>
#include <limits>
#include <optional>

#include "core/dynamics/stepper.hpp"
#include "scenes/trajectory/resume_record.hpp"
#include "scenes/trajectory/trajectory_layout.hpp"
#include "tests/fuzz/example.hpp"
#include "tests/fuzz/hdf5_changes.hpp"
#include "tests/fuzz/reading.hpp"

namespace tesserae::fuzz {
namespace {

namespace fs = std::filesystem;
namespace hdf5 = scenes::hdf5;

constexpr const char* kRecords[] = {"/parameters/resume/a", "/parameters/resume/b",
                                    scenes::kCheckpoint};

BodyId any_body(FuzzedDataProvider& input) {
    constexpr BodyId kBodies[] = {0, 1, 2, 3, 4, 5, 1000, 1u << 30, kAwake - 1, kAwake};
    return input.PickValueInArray(kBodies);
}

double any_real(FuzzedDataProvider& input) {
    constexpr double kReals[] = {0,
                                 -1,
                                 1e-300,
                                 1e300,
                                 0.3,
                                 std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN()};
    return input.ConsumeBool() ? input.PickValueInArray(kReals)
                               : input.ConsumeFloatingPoint<double>();
}

void change(scenes::ResumeRecord& record, FuzzedDataProvider& input) {
    StepMemory& memory = record.memory;
    switch (input.ConsumeIntegralInRange(0, 7)) {
        case 0:
            record.rows = input.ConsumeIntegralInRange<std::uint64_t>(0, 20);
            break;
        case 1:
            record.first = input.ConsumeIntegral<std::uint64_t>();
            break;
        case 2:
            record.step = input.ConsumeIntegralInRange<std::uint64_t>(0, 40);
            break;
        case 3:
            if (!memory.asleep.empty())
                memory.asleep[input.ConsumeIntegralInRange<std::size_t>(
                    0, memory.asleep.size() - 1)] = any_body(input);
            break;
        case 4:
            if (!memory.still.empty())
                memory
                    .still[input.ConsumeIntegralInRange<std::size_t>(0, memory.still.size() - 1)] =
                    any_real(input);
            break;
        case 5: {
            KeptImpulse impulse;
            impulse.a = any_body(input), impulse.b = any_body(input);
            impulse.feature = input.ConsumeIntegralInRange<std::uint32_t>(0, 20);
            impulse.normal = any_real(input);
            for (float& part : impulse.slope) part = static_cast<float>(any_real(input));
            memory.impulses.push_back(impulse);
            if (!memory.angular_impulses.empty())
                memory.angular_impulses.push_back({any_real(input), 0, 0, 0, 0, 0});
            break;
        }
        case 6: {
            auto manifold = std::make_shared<KeptManifold>();
            manifold->a = any_body(input), manifold->b = any_body(input);
            for (int axis = 0; axis < 4; ++axis) manifold->offset[axis] = any_real(input);
            manifold->rotor.s = any_real(input);
            memory.kept.emplace_back().push_back(manifold);
            break;
        }
        default:
            memory.asleep.resize(input.ConsumeIntegralInRange<std::size_t>(0, 8), any_body(input));
            memory.still.resize(memory.asleep.size(), any_real(input));
    }
}

/// Opens one of the datasets of records; none if it is not in a row any more.
std::optional<hdf5::Handle> any_record(hid_t file, FuzzedDataProvider& input) {
    hdf5::Handle dataset = hdf5::open_dataset(
        file, kRecords[input.ConsumeIntegralInRange<std::size_t>(0, std::size(kRecords) - 1)]);
    if (hdf5::extent_of(dataset).size() != 1) return std::nullopt;
    return dataset;
}

/// One of the file's records in another's place, changed or not.
void change_record(hid_t file, FuzzedDataProvider& input) {
    const auto from = any_record(file, input), to = any_record(file, input);
    if (!from || !to) return;
    std::string bytes(std::min<hsize_t>(hdf5::extent_of(*from)[0], 1 << 20), '\0');
    if (bytes.empty()) return;
    hdf5::read_rows(*from, 0, bytes.size(), H5T_NATIVE_UINT8, bytes.data());
    auto record = scenes::to_record(bytes);
    if (!record) return;
    while (input.ConsumeBool()) change(*record, input);
    bytes = scenes::to_bytes(*record);
    if (hdf5::extent_of(*to)[0] < bytes.size()) hdf5::resize(*to, bytes.size());
    hdf5::write_rows(*to, 0, bytes.size(), H5T_NATIVE_UINT8, bytes.data());
}

/// Continues what is there and finishes it.
void continue_file(const ExampleTrajectory& example, const fs::path& file, bool overwrite) {
    try {
        scenes::TrajectoryWriter writer(file, example.header(), example.steps(), overwrite);
        require(writer.rows() <= example.steps().size(), "more rows than steps");
        example.finish(writer);
    } catch (const RunError&) {
        return;  // HDF5 cannot write into what was damaged, or a body left the finite range
    }
    const scenes::TrajectoryReader reader(file);
    require(reader.steps() == example.steps(), "a finished file has other steps");
}

}  // namespace
}  // namespace tesserae::fuzz

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    tesserae::fuzz::limit_memory();
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tesserae;
    namespace fs = std::filesystem;
    static const fuzz::ExampleTrajectory example;
    static const fuzz::Hdf5Changes unfinished(example.unfinished(3), fuzz::change_record);
    static const fuzz::Hdf5Changes whole(example.whole(), fuzz::change_record);
    static const fs::path folder = fuzz::memory_folder("resume");
    const fs::path file = folder / "film.h5", partial = folder / "film.h5.partial";
    FuzzedDataProvider input(data, size);
    const bool overwrite = input.ConsumeBool(), is_whole = input.ConsumeIntegralInRange(0, 3) == 0;
    fs::remove(file), fs::remove(partial);
    std::ofstream(is_whole && input.ConsumeBool() ? file : partial, std::ios::binary)
        << (is_whole ? whole : unfinished).changed(input);
    fuzz::accepts([&] { fuzz::continue_file(example, file, overwrite); });
    return 0;
}

// SPDX-License-Identifier: Apache-2.0
// Trajectories in which bytes are damaged: of every four bytes of the input three say where in a
// valid file, and one what is there instead. Then the file may be cut off. Damage in HDF5's own
// structures is left to HDF5 to notice (see TrajectoryReader): a crash inside of it is its own.
#include <algorithm>

#include "tests/fuzz/example.hpp"
#include "tests/fuzz/trajectory_reading.hpp"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    tesserae::fuzz::limit_memory();
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tesserae;
    static const std::string whole = fuzz::ExampleTrajectory().whole();
    static const fuzz::MemoryFile whole_file(whole);
    if (size < 2) return 0;
    std::string bytes = whole;
    for (std::size_t i = 2; i + 4 <= size; i += 4) {
        const std::size_t at = data[i] + (data[i + 1] << 8) + (data[i + 2] << 16);
        bytes[at % bytes.size()] = static_cast<char>(data[i + 3]);
    }
    if (data[0] % 4 == 0) bytes.resize(bytes.size() * data[1] / 255);
    const fuzz::MemoryFile file(bytes);
    fuzz::read_trajectory(file.path(), whole_file.path());
    return 0;
}

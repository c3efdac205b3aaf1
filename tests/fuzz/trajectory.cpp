// SPDX-License-Identifier: Apache-2.0
// Trajectories that are HDF5 files, but not those that this program writes.
#include "tests/fuzz/example.hpp"
#include "tests/fuzz/hdf5_changes.hpp"
#include "tests/fuzz/trajectory_reading.hpp"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    tesserae::fuzz::limit_memory();
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tesserae;
    static const std::string whole = fuzz::ExampleTrajectory().whole();
    static const fuzz::MemoryFile whole_file(whole);
    static const fuzz::Hdf5Changes changes(whole);
    FuzzedDataProvider input(data, size);
    const fuzz::MemoryFile file(changes.changed(input));
    fuzz::read_trajectory(file.path(), whole_file.path());
    return 0;
}

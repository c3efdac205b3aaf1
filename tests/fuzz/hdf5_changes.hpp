// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <functional>
#include <string>
#include <vector>

#include "scenes/trajectory/hdf5.hpp"

// Damage to HDF5 files that keeps them HDF5 files: libFuzzer's bytes are read as a list of changes
// to a valid file, made with HDF5's own interface, in memory. So a fuzzer gets past HDF5's checks
// of its structures to what this project's readers look at.
namespace tesserae::fuzz {

/// Another change than those below, of a file that is open for writing.
using MoreChange = std::function<void(hid_t file, FuzzedDataProvider& input)>;

/// Changes one valid file in many ways: links (missing, soft, external, in circles), objects of
/// other kinds, datasets of other types, extents, layouts and filters, other values, texts and
/// attributes.
class Hdf5Changes {
  public:
    /// @param file   the bytes of a valid one
    explicit Hdf5Changes(std::string file, MoreChange more = {});

    /// @return the bytes of the changed file; empty if it cannot be made
    std::string changed(FuzzedDataProvider& input) const;

  private:
    void change(hid_t file, FuzzedDataProvider& input) const;
    const std::string& any_path(FuzzedDataProvider& input) const;

    std::string bytes_;
    MoreChange more_;
    std::vector<std::string> paths_, attributes_;
};

}  // namespace tesserae::fuzz

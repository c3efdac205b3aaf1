// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/world/inside.hpp"

namespace tesserae {

/// A World as bytes: what it is made of, the numbers of bodies and joints, and what one step leaves
/// to the next. What follows from these is computed again.
class WorldBytes {
  public:
    static std::string write(World::Inside& inside);
    /// @throws InputError   see World::load()
    static std::unique_ptr<World::Inside> read(std::string_view bytes,
                                               std::shared_ptr<Workers> workers);
};

}  // namespace tesserae

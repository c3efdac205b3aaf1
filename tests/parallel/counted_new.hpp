// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace tesserae::testing {

/// Calls of operator new in this executable so far, by any thread. The operators are replaced where
/// this is defined. oneTBB's tasks and graph messages don't come by: they are taken from its own
/// pools by tbb::detail::r1::allocate.
std::uint64_t allocations();

}  // namespace tesserae::testing

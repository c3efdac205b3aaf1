// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace tesserae::scenes {

/// Bytes that this process may still take: the least of what the machine has available and what its
/// control groups (v1 and v2, with all their parents), its address space limit and its Slurm job
/// leave.
std::uint64_t available_memory();

/// From now on every piece of more than 128 KiB of memory goes back to the system once it is freed.
/// A step's lists move to new places as they grow; with glibc what they leave stays in the heap
/// otherwise, in pieces that fit nothing. For programs, at their start; does nothing with other C
/// libraries.
void return_large_memory();

}  // namespace tesserae::scenes

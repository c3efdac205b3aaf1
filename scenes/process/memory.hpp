#pragma once

#include <cstdint>

namespace tesserae::scenes {

/// Bytes that this process may still take: the least of what the machine has available and what its
/// control groups (v1 and v2, with all their parents), its address space limit and its Slurm job
/// leave.
std::uint64_t available_memory();

}  // namespace tesserae::scenes

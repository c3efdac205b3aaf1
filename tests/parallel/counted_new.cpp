// SPDX-License-Identifier: Apache-2.0
#include "tests/parallel/counted_new.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::uint64_t> count = 0;

void* allocated(std::size_t size, std::size_t alignment = alignof(std::max_align_t)) {
    ++count;
    // aligned_alloc() takes whole multiples only.
    const std::size_t whole = (std::max<std::size_t>(size, 1) + alignment - 1) & ~(alignment - 1);
    return std::aligned_alloc(alignment, whole);
}

void* not_null(void* memory) {
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

}  // namespace

std::uint64_t tesserae::testing::allocations() { return count; }

void* operator new(std::size_t size) { return not_null(allocated(size)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    return not_null(allocated(size, static_cast<std::size_t>(alignment)));
}
// Those that do not throw may have memory of their own otherwise, as the address sanitizer's have.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocated(size); }
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
    return allocated(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cpuid.h>

#include <cstring>

// Asks whether this CPU runs what the rest was compiled for. It is included by sources that are
// compiled for any CPU, alone: its functions have no other name than theirs, so that no copy of
// another source is taken instead.
namespace {

constexpr const char* kCpuMessage =
    "tesserae: this CPU lacks x86-64-v3 (AVX2, FMA, BMI2: Intel Haswell or AMD Excavator and "
    "later), which this program was built for; build it with cmake -DTESSERAE_ARCH=x86-64";

/// The operating system saves the upper halves of the vector registers (XCR0 bits 1 and 2).
bool os_keeps_avx_state() {
    unsigned low, high;
    asm volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return (low & 6u) == 6u;
}

/// All of x86-64-v3 (System V ABI, AMD64 supplement, table 3.1) that v2 does not have.
bool has_x86_64_v3() {
    unsigned a, b, c, d;
    if (!__get_cpuid(1, &a, &b, &c, &d)) return false;
    const unsigned leaf1 = bit_FMA | bit_MOVBE | bit_OSXSAVE | bit_AVX | bit_F16C | bit_POPCNT;
    if ((c & leaf1) != leaf1 || !os_keeps_avx_state()) return false;
    if (!__get_cpuid_count(7, 0, &a, &b, &c, &d)) return false;
    const unsigned leaf7 = bit_BMI | bit_AVX2 | bit_BMI2;
    if ((b & leaf7) != leaf7) return false;
    return __get_cpuid(0x80000001, &a, &b, &c, &d) && (c & bit_ABM) != 0;
}

/// Whether the CPU runs what was built for TESSERAE_ARCH.
bool cpu_suffices() { return std::strcmp(TESSERAE_ARCH, "x86-64-v3") != 0 || has_x86_64_v3(); }

}  // namespace

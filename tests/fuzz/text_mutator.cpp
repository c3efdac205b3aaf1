// SPDX-License-Identifier: Apache-2.0
// Changes texts as libFuzzer does and, now and then, as it would hardly ever: by a piece that is
// repeated many times, which finds what grows with the square or takes the stack.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <string_view>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

constexpr std::string_view kPieces[] = {
    "[", "{",  "a={", "a.",         "[[", "(",  "\"", "\"\"\"",    "'''",         "\n",
    ",", "-1", "0,",  "[[body]]\n", "#",  "\\", "9",  "0-9999x1,", "[[light]]\n", "[0,0,0,0],"};

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
    std::minstd_rand random(seed);
    if (random() % 8 != 0) return LLVMFuzzerMutate(data, size, most);
    std::string text(reinterpret_cast<const char*>(data), size);
    const auto below = [&](std::size_t n) { return n == 0 ? std::size_t{0} : random() % n; };
    // A piece of the list, or of the text itself: up to a few lines.
    std::string piece(kPieces[below(std::size(kPieces))]);
    if (random() % 2 == 0) piece = text.substr(below(text.size()), 1 + below(60));
    const std::size_t at = below(text.size() + 1), times = std::size_t{1} << below(12);
    std::string repeated;
    while (repeated.size() + piece.size() + size <= most && !piece.empty() &&
           repeated.size() < times * piece.size())
        repeated += piece;
    text.insert(at, repeated);
    const std::size_t length = std::min(text.size(), most);
    std::memcpy(data, text.data(), length);
    return length;
}

// SPDX-License-Identifier: Apache-2.0
#include "scenes/process/messages.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.hpp"

namespace tesserae::scenes {
namespace {

/// A character and the bytes that it takes.
struct CodePoint {
    std::uint32_t value;
    std::size_t bytes;
};

/// The first character of UTF-8 text; none if its first bytes are not one.
std::optional<CodePoint> first_code_point(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    if (lead < 0x80) return CodePoint{lead, 1};
    const std::size_t count = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < count) return {};
    std::uint32_t value = lead & (0xffu >> (count + 1));
    for (std::size_t i = 1; i < count; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return {};
        value = value << 6 | (byte(i) & 0x3fu);
    }
    constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    if (value < kLeast[count] || value > 0x10ffff || (value >= 0xd800 && value < 0xe000)) return {};
    return CodePoint{value, count};
}

/// Controls (C0, DEL, C1), line and paragraph separators, and what embeds, overrides, isolates or
/// marks a direction of writing (Unicode 15, chapter 23.2; UAX 9).
bool steers_terminal(std::uint32_t c) {
    if (c == '\n' || c == '\t') return false;
    return c < 0x20 || (c >= 0x7f && c < 0xa0) || c == 0x061c || c == 0x200e || c == 0x200f ||
           (c >= 0x2028 && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069);
}

/// @return the call's errno, 0 if all is written
int write_whole(int descriptor, std::string_view bytes) noexcept {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return 0;
}

/// A handler, unlike an ignored signal, is not handed down to ffmpeg, gnuplot and Slurm's programs.
void on_broken_pipe(int) {}

}  // namespace

std::string terminal_text(std::string_view text) {
    std::string shown;
    shown.reserve(text.size());
    while (!text.empty()) {
        const std::optional<CodePoint> c = first_code_point(text);
        const std::size_t bytes = c ? c->bytes : 1;
        if (!c)
            shown += fmt::format("\\x{:02X}", static_cast<unsigned char>(text[0]));
        else if (steers_terminal(c->value))
            shown += fmt::format("\\u{:04X}", c->value);
        else
            shown += text.substr(0, bytes);
        text.remove_prefix(bytes);
    }
    return shown;
}

void open_standard_streams() {
    // Opened the wrong way round, so that using them is an error as it was before.
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF)
            (void)!::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    std::signal(SIGPIPE, on_broken_pipe);
}

void write_error(std::string_view bytes) noexcept { (void)write_whole(STDERR_FILENO, bytes); }

void tell(std::string_view text) noexcept {
    try {
        write_error("tesserae: " + terminal_text(text) + "\n");
    } catch (const std::bad_alloc&) {
        write_error("tesserae: out of memory\n");
    }
}

void put(std::string_view text) {
    const int error = write_whole(STDOUT_FILENO, terminal_text(text));
    if (error == 0) return;
    if (error == EPIPE) {
        std::signal(SIGPIPE, SIG_DFL);
        std::raise(SIGPIPE);
    }
    throw RunError(fmt::format("standard output: cannot be written: {}", std::strerror(error)));
}

void put_json(const nlohmann::ordered_json& json) {
    put(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace tesserae::scenes

// SPDX-License-Identifier: Apache-2.0
#include "scenes/process/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "scenes/process/messages.hpp"

namespace tesserae::scenes {
namespace {

constexpr std::chrono::milliseconds kTerminalInterval{200};
constexpr std::chrono::seconds kPlainInterval{30};

}  // namespace

std::string duration_text(double seconds) {
    if (seconds < 10) return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<std::int64_t>(seconds + 0.5);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

Progress::Progress(std::string what, std::string unit, std::uint64_t total, bool quiet)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      total_(total),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      begin_(Clock::now()),
      last_(begin_) {}

Progress::~Progress() {
    if (shown_ && terminal_) write_error("\n");
}

void Progress::start_at(std::uint64_t done) { start_ = done; }

std::string Progress::line(std::uint64_t done) const {
    const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
    std::string text = fmt::format("{} {}/{} {}", what_, done, total_, unit_);
    if (done > start_ && seconds > 0) {
        const double rate = static_cast<double>(done - start_) / seconds;
        text += fmt::format(", {:.3g} {}/s, {} left", rate, unit_,
                            duration_text(static_cast<double>(total_ - done) / rate));
    }
    return text;
}

void Progress::update(std::uint64_t done) {
    if (quiet_) return;
    const auto now = Clock::now();
    const bool last = done == total_;
    if (terminal_ ? !last && now - last_ < kTerminalInterval : now - last_ < kPlainInterval) return;
    last_ = now;
    shown_ = true;
    write_error(terminal_ ? "\r" + line(done) + "\033[K" : line(done) + "\n");
}

}  // namespace tesserae::scenes

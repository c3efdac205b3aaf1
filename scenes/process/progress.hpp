// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace tesserae::scenes {

/// One line on standard error that says how far a piece of work is: done, rate, time left.
/// Rewritten in place where standard error is a terminal, a plain line every 30 s where it is not.
class Progress {
  public:
    /// @param what    "simulating", "rendering"
    /// @param unit    "steps", "frames"
    Progress(std::string what, std::string unit, std::uint64_t total, bool quiet);
    ~Progress();

    /// Work already there from an earlier run: counts as done, not into the rate.
    void start_at(std::uint64_t done);
    void update(std::uint64_t done);

  private:
    using Clock = std::chrono::steady_clock;

    std::string line(std::uint64_t done) const;

    std::string what_, unit_;
    std::uint64_t total_, start_ = 0;
    bool quiet_, terminal_;
    bool shown_ = false;
    Clock::time_point begin_, last_;
};

/// "1 h 02 min", "3 min 20 s", "4.2 s".
std::string duration_text(double seconds);

}  // namespace tesserae::scenes

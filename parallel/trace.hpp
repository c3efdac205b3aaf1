// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace tesserae::parallel {

/// The name of a message of islands, within solve_islands or apply_corrections. Its size is
/// contacts.
inline constexpr const char* kIslandsSpan = "islands";

/// Records which thread did what when, to see how the work of a step overlaps. At most a million
/// spans a thread are kept, the first ones.
class Trace {
  public:
    Trace();
    ~Trace();
    Trace(const Trace&) = delete;
    Trace& operator=(const Trace&) = delete;

    /// The life of one is a piece of work. Without a trace it costs a comparison.
    class Span {
      public:
        /// @param name   lives as long as the trace: a literal
        /// @param size   of the work, in items
        Span(Trace* trace, const char* name, std::uint64_t size = 0);
        ~Span();
        Span(const Span&) = delete;
        Span& operator=(const Span&) = delete;

      private:
        Trace* trace_;
        const char* name_;
        std::uint64_t size_;
        std::chrono::steady_clock::time_point begin_;
    };

    // Not while spans are open.

    /// Sum of the spans of each name, over all threads [s].
    std::map<std::string, double> seconds() const;
    /// All spans in the trace event format of Chrome's tracing and of Perfetto: complete events
    /// ("X"), times in microseconds since the trace was made, a row a thread.
    std::string json() const;
    void clear();

  private:
    struct Lists;
    std::unique_ptr<Lists> lists_;
};

}  // namespace tesserae::parallel

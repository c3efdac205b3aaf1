// SPDX-License-Identifier: Apache-2.0
#include "parallel/trace.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <iterator>
#include <vector>

namespace tesserae::parallel {

using Clock = std::chrono::steady_clock;

struct Trace::Lists {
    static constexpr std::size_t kMost = 1'000'000;

    struct Event {
        const char* name;
        std::uint64_t size;
        Clock::time_point begin, end;
    };

    Clock::time_point start = Clock::now();
    tbb::enumerable_thread_specific<std::vector<Event>> of_threads;
};

Trace::Trace() : lists_(std::make_unique<Lists>()) {}
Trace::~Trace() = default;

Trace::Span::Span(Trace* trace, const char* name, std::uint64_t size)
    : trace_(trace), name_(name), size_(size) {
    if (trace_ != nullptr) begin_ = Clock::now();
}

Trace::Span::~Span() {
    if (trace_ == nullptr) return;
    const Clock::time_point end = Clock::now();
    auto& list = trace_->lists_->of_threads.local();
    if (list.size() < Lists::kMost) list.push_back({name_, size_, begin_, end});
}

std::map<std::string, double> Trace::seconds() const {
    std::map<std::string, double> sums;
    for (const auto& list : lists_->of_threads)
        for (const auto& event : list)
            sums[event.name] += std::chrono::duration<double>(event.end - event.begin).count();
    return sums;
}

std::string Trace::json() const {
    const auto micros = [](Clock::duration d) {
        return std::chrono::duration<double, std::micro>(d).count();
    };
    std::string text = "{\"traceEvents\": [";
    int thread = 0;
    bool first = true;
    for (const auto& list : lists_->of_threads) {
        for (const auto& e : list) {
            fmt::format_to(std::back_inserter(text),
                           "{}\n{{\"name\": \"{}\", \"ph\": \"X\", \"pid\": 1, \"tid\": {}, "
                           "\"ts\": {:.3f}, \"dur\": {:.3f}, \"args\": {{\"size\": {}}}}}",
                           first ? "" : ",", e.name, thread, micros(e.begin - lists_->start),
                           micros(e.end - e.begin), e.size);
            first = false;
        }
        ++thread;
    }
    return text + "\n]}\n";
}

void Trace::clear() { lists_->of_threads.clear(); }

}  // namespace tesserae::parallel

// SPDX-License-Identifier: Apache-2.0
#include "parallel/trace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace tesserae::parallel {
namespace {

using namespace std::chrono_literals;

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

TEST(Trace, SumsSpansByNameOverThreads) {
    Trace trace;
    const auto work = [&] {
        const Trace::Span outer(&trace, "outer");
        for (int i = 0; i < 3; ++i) {
            const Trace::Span inner(&trace, "inner", 7);
            std::this_thread::sleep_for(2ms);
        }
    };
    std::thread other(work);
    work();
    other.join();
    const auto seconds = trace.seconds();
    ASSERT_EQ(seconds.size(), 2u);
    EXPECT_GE(seconds.at("inner"), 0.012);
    EXPECT_GE(seconds.at("outer"), seconds.at("inner"));
    trace.clear();
    EXPECT_TRUE(trace.seconds().empty());
}

TEST(Trace, HasARowForEveryThread) {
    Trace trace;
    const auto work = [&] { const Trace::Span span(&trace, "work", 42); };
    std::thread(work).join();
    work();
    const std::string json = trace.json();
    EXPECT_EQ(count(json, "\"name\": \"work\""), 2u);
    EXPECT_EQ(count(json, "\"size\": 42"), 2u);
    EXPECT_EQ(count(json, "\"tid\": 0"), 1u);
    EXPECT_EQ(count(json, "\"tid\": 1"), 1u);
    EXPECT_EQ(std::count(json.begin(), json.end(), '{'), std::count(json.begin(), json.end(), '}'));
}

TEST(Trace, NothingIsRecordedWithoutOne) { const Trace::Span span(nullptr, "nothing"); }

TEST(TraceSlow, KeepsABoundedNumber) {
    Trace trace;
    for (int i = 0; i < 1'000'100; ++i) const Trace::Span span(&trace, "short");
    EXPECT_EQ(count(trace.json(), "short"), 1'000'000u);
}

}  // namespace
}  // namespace tesserae::parallel

// SPDX-License-Identifier: Apache-2.0
#include "parallel/island_graph.hpp"

#include <tbb/flow_graph.h>

#include <algorithm>
#include <vector>

namespace tesserae::parallel {
namespace {

/// Contacts that make a message: some 20 us of work at 10 sweeps. Fewer, and the overhead of a
/// task shows; many more, and the threads run out of messages.
constexpr std::uint32_t kContactsOfMessage = 32;

}  // namespace

struct IslandGraph::Graph {
    struct Message {
        std::size_t begin, end;  ///< places in `order`
        std::uint32_t contacts;
    };

    Graph()
        : node(graph, tbb::flow::unlimited, [this](const Message& message) {
              const Trace::Span span(trace, kIslandsSpan, message.contacts);
              if (order.size() > 1) ranges.look_for_stop();
              for (std::size_t i = message.begin; i < message.end; ++i) {
                  const std::uint32_t island = order[i];
                  if (step->islands.is_coloured(island))
                      of_coloured(*simulation, *step, island, ranges);
                  else
                      of_plain(*simulation, *step, island);
              }
              return tbb::flow::continue_msg();
          }) {}

    const Simulation* simulation = nullptr;
    StepData* step = nullptr;
    Ranges ranges;
    Work* of_plain = nullptr;
    ColouredWork* of_coloured = nullptr;
    Trace* trace = nullptr;
    std::vector<std::uint32_t> order;  ///< islands, those worth a message first, by falling size
    tbb::flow::graph graph;
    tbb::flow::function_node<Message> node;
};

IslandGraph::IslandGraph() : graph_(std::make_unique<Graph>()) {}
IslandGraph::~IslandGraph() = default;

void IslandGraph::run(const Simulation& simulation, StepData& step, const Ranges& ranges,
                      Work& of_plain, ColouredWork& of_coloured, Trace* trace) {
    Graph& g = *graph_;
    g.trace = trace;
    g.ranges = ranges;
    g.of_plain = &of_plain;
    g.of_coloured = &of_coloured;
    g.simulation = &simulation;
    g.step = &step;
    const auto size = [&](std::uint32_t island) { return step.size_of_group(island); };

    // Those worth a message by falling size. The order of the small ones is all the same.
    g.order.clear();
    const auto count = static_cast<std::uint32_t>(step.islands.size());
    for (std::uint32_t island = 0; island < count; ++island)
        if (size(island) >= kContactsOfMessage) g.order.push_back(island);
    std::sort(g.order.begin(), g.order.end(), [&](std::uint32_t i, std::uint32_t j) {
        return size(i) != size(j) ? size(i) > size(j) : i < j;
    });
    for (std::uint32_t island = 0; island < count; ++island)
        if (size(island) > 0 && size(island) < kContactsOfMessage) g.order.push_back(island);

    for (std::size_t begin = 0; begin < g.order.size();) {
        Graph::Message message{begin, begin, 0};
        while (message.end < g.order.size() && message.contacts < kContactsOfMessage)
            message.contacts += size(g.order[message.end++]);
        g.node.try_put(message);
        begin = message.end;
    }
    try {
        g.graph.wait_for_all();
    } catch (...) {
        g.graph.reset();
        throw;
    }
}

}  // namespace tesserae::parallel

// SPDX-License-Identifier: Apache-2.0
#include "scenes/program/compare_commands.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "parallel/threads.hpp"
#include "scenes/compare/difference.hpp"
#include "scenes/process/messages.hpp"
#include "scenes/trajectory/trajectory_layout.hpp"

namespace tesserae::scenes {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Content& content, const std::string& file) {
    Json json = {{"file", file}, {"kind", name_of(content.kind)}, {"hash", content.hash()}};
    if (content.kind == FileKind::kScene) json["motion_hash"] = content.entries.back().hash;
    if (content.kind == FileKind::kFrames)
        for (const ContentEntry& frame : content.entries) json["frames"][frame.name] = frame.hash;
    return json;
}

Json to_json(const LoneSteps& steps) {
    Json json = {{"count", steps.count}};
    if (steps.count > 0) json["first"] = steps.first, json["last"] = steps.last;
    return json;
}

Json to_json(const FirstDifference& first) {
    Json json = {{"step", first.step}, {"time", first.time}};
    if (first.body) json["body"] = *first.body;
    if (!first.body_name.empty()) json["name"] = first.body_name;
    if (first.joint) json["joint"] = *first.joint, json["name"] = first.joint_name;
    json["component"] = first.component;
    json["a"] = first.a, json["b"] = first.b;
    json["difference"] = first.difference;
    return json;
}

Json to_json(const StepDifference& row) {
    Json json = {{"step", row.step}, {"time", row.time}, {"bodies", row.bodies}};
    for (std::size_t e = 0; e < kStateElements.size(); ++e)
        json[kStateElements[e].name] = row.largest[e];
    return json;
}

Json to_json(const TrajectoryDifference& difference) {
    Json json = {{"bodies", {difference.bodies_a, difference.bodies_b}},
                 {"joints", {difference.joints_a, difference.joints_b}},
                 {"scene", difference.scene},
                 {"motion", difference.motion},
                 {"steps_only_a", to_json(difference.only_a)},
                 {"steps_only_b", to_json(difference.only_b)}};
    if (difference.first) json["first"] = to_json(*difference.first);
    json["growth"] = Json::array();
    for (const StepDifference& row : difference.growth) json["growth"].push_back(to_json(row));
    if (!difference.not_compared.empty()) json["not_compared"] = difference.not_compared;
    return json;
}

Json to_json(const render::Crop& window) { return {window.x0, window.y0, window.x1, window.y1}; }

Json to_json(const ImageDifference& difference) {
    Json json = {{"windows", {to_json(difference.window_a), to_json(difference.window_b)}},
                 {"channels_only_a", difference.only_a},
                 {"channels_only_b", difference.only_b},
                 {"channels_of_other_type", difference.other_type}};
    if (const auto& first = difference.first)
        json["first"] = {{"x", first->x}, {"y", first->y}, {"channel", first->channel},
                         {"a", first->a}, {"b", first->b}, {"difference", first->difference}};
    json["channels"] = Json::array();
    for (const ChannelDifference& c : difference.channels)
        json["channels"].push_back({{"name", c.name},
                                    {"pixels", c.pixels},
                                    {"not_finite", c.not_finite},
                                    {"largest", c.largest},
                                    {"at", {c.x, c.y}},
                                    {"rms", c.rms}});
    return json;
}

Json to_json(const Difference& difference, const CommandLine& line) {
    Json json = {{"equal", difference.is_equal()},
                 {"kind", name_of(difference.kind)},
                 {"a", {{"file", line.files[0].string()}, {"hash", difference.hash_a}}},
                 {"b", {{"file", line.files[1].string()}, {"hash", difference.hash_b}}}};
    if (difference.is_equal()) return json;
    json["entries"] = Json::array();
    for (const EntryDifference& e : difference.entries)
        json["entries"].push_back({{"name", e.name}, {"a", e.a}, {"b", e.b}});
    if (difference.kind == FileKind::kScene)
        json["scene"] = difference.scene, json["motion"] = difference.motion;
    if (difference.trajectory) json["trajectory"] = to_json(*difference.trajectory);
    if (!difference.frame.empty()) json["frame"] = difference.frame;
    if (difference.image) json["image"] = to_json(*difference.image);
    return json;
}

}  // namespace

void hash_command(const CommandLine& line) {
    Json hashes = Json::array();
    for (const auto& path : line.files) {
        const std::string file = path.string();
        Content content;
        parallel::Threads(line.threads).run([&] { content = read_content(path); });
        hashes.push_back(to_json(content, file));
        if (line.json) continue;
        put_line("{}  {}", content.hash(), file);
        if (content.kind == FileKind::kScene)
            put_line("{}  {} (motion)", content.entries.back().hash, file);
    }
    if (!line.json) return;
    Json json;
    json["hashes"] = std::move(hashes);
    put_json(json);
}

int diff_command(const CommandLine& line) {
    Difference difference;
    parallel::Threads(line.threads).run([&] {
        difference = compare(line.files[0], line.files[1]);
    });
    if (line.json)
        put_json(to_json(difference, line));
    else
        put_line("{}", text_of(difference));
    return difference.is_equal() ? 0 : 1;
}

}  // namespace tesserae::scenes

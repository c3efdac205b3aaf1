#include <algorithm>
#include <array>

#include "core/error.hpp"
#include "scenes/load/load_parts.hpp"

namespace tesserae::scenes {
namespace {

constexpr int kMaxSize = 65536;
constexpr int kMaxSamples = 1 << 20;
/// A sphere trace of a million steps is stuck.
constexpr int kMaxSteps = 1'000'000;
constexpr int kMaxBounces = 1'000'000;

constexpr std::string_view kIntegrators[] = {"direct", "path"};
constexpr std::string_view kIntersectors[] = {"trace", "analytic"};

struct ChannelName {
    std::string_view name;
    bool render::Channels::*member;
};
constexpr ChannelName kBuiltChannels[] = {
    {"color", &render::Channels::color},   {"depth", &render::Channels::depth},
    {"normal", &render::Channels::normal}, {"albedo", &render::Channels::albedo},
    {"id", &render::Channels::id},         {"position", &render::Channels::position}};
constexpr std::string_view kChannels[] = {"color", "depth",    "normal",   "albedo",
                                          "id",    "position", "variance", "samples"};

void read_channels(TableReader& reader, render::Channels& channels) {
    std::vector<std::string> names;
    if (!reader.read("channels", names, kChannels)) return;
    if (names.empty()) reader.fail("channels", "expected at least one channel");
    for (const char* later : {"variance", "samples"})
        require_built(reader, "channels",
                      std::find(names.begin(), names.end(), later) == names.end());
    for (const auto& [name, member] : kBuiltChannels)
        channels.*member = std::find(names.begin(), names.end(), name) != names.end();
}

std::string channels_text(const render::Channels& channels) {
    std::string text;
    for (const auto& [name, member] : kBuiltChannels)
        if (channels.*member) text += (text.empty() ? "" : ", ") + toml_text(name);
    return "[" + text + "]";
}

/// Features to come: checked like the others, and only their defaults pass.
void read_unbuilt(TableReader& reader, int samples) {
    int max_samples = samples;
    std::string filter = "box";
    if (reader.read("filter", filter)) require_built(reader, "filter", filter == "box");
    double filter_width = 1, noise_target = 0;
    if (reader.read("filter_width", filter_width, Rule::kPositive))
        require_built(reader, "filter_width", filter_width == 1);
    if (reader.read("noise_target", noise_target, Rule::kNonNegative))
        require_built(reader, "noise_target", noise_target == 0);
    if (reader.read("max_samples", max_samples, 1, kMaxSamples))
        require_built(reader, "max_samples", max_samples == samples);
}

/// Known to overrides only: a crop is a way to look at a scene, not a part of one.
void read_crop(TableReader& reader, render::Settings& settings) {
    if (!reader.has("crop")) return;
    if (!reader.is_override("crop"))
        reader.fail("crop", "is no key of scene files; use --crop x0,y0,x1,y1");
    std::array<std::int64_t, 4> c = {};
    reader.read("crop", c.data(), c.size(), 0, kMaxSize);
    if (c[0] >= c[2] || c[1] >= c[3] || c[2] > settings.width || c[3] > settings.height)
        reader.fail("crop",
                    fmt::format("expected [x0, y0, x1, y1] with x0 < x1 <= {} and y0 < y1 <= {}",
                                settings.width, settings.height));
    settings.crop = {static_cast<int>(c[0]), static_cast<int>(c[1]), static_cast<int>(c[2]),
                     static_cast<int>(c[3])};
}

void write_render(const render::Settings& s, EffectiveWriter& out) {
    out.table("[render]");
    out.line("size", fmt::format("[{}, {}]", s.width, s.height));
    out.key("frames_per_second", s.frames_per_second);
    out.key("samples", std::int64_t{s.samples});
    out.key("integrator", kIntegrators[static_cast<std::size_t>(s.integrator)]);
    out.key("bounces", std::int64_t{s.bounces});
    out.key("intersector", kIntersectors[static_cast<std::size_t>(s.intersector)]);
    out.key("max_steps", std::int64_t{s.max_steps});
    out.key("max_distance", s.max_distance);
    out.key("tile", std::int64_t{s.tile});
    out.key("filter", "box");
    out.key("filter_width", 1.0);
    out.key("noise_target", 0.0);
    out.key("max_samples", std::int64_t{s.samples});
    out.line("channels", channels_text(s.channels));
    out.key("exposure", s.exposure);
    // Last, and only where given: a text without it can be loaded again.
    if (s.crop)
        out.line("crop",
                 fmt::format("[{}, {}, {}, {}]", s.crop->x0, s.crop->y0, s.crop->x1, s.crop->y1));
}

}  // namespace

void load_render(TableReader& root, const Origin& origin, Scene& scene, EffectiveWriter& out) {
    render::Settings& s = scene.render;
    if (const auto* table = root.table("render")) {
        TableReader reader(*table, origin, "[render]");
        std::array<std::int64_t, 2> size = {s.width, s.height};
        reader.read("size", size.data(), size.size(), 1, kMaxSize);
        s.width = static_cast<int>(size[0]);
        s.height = static_cast<int>(size[1]);
        reader.read("frames_per_second", s.frames_per_second, Rule::kPositive);
        reader.read("samples", s.samples, 1, kMaxSamples);
        std::size_t integrator = 0, intersector = 0;
        reader.read("integrator", integrator, kIntegrators);
        s.integrator = static_cast<render::Integrator>(integrator);
        reader.read("bounces", s.bounces, 0, kMaxBounces);
        reader.read("intersector", intersector, kIntersectors);
        s.intersector = static_cast<render::Intersector>(intersector);
        reader.read("max_steps", s.max_steps, 1, kMaxSteps);
        reader.read("max_distance", s.max_distance, Rule::kPositive);
        reader.read("tile", s.tile, 8, 512);
        read_channels(reader, s.channels);
        reader.read("exposure", s.exposure, Interval{-1000, 1000});
        read_unbuilt(reader, s.samples);
        read_crop(reader, s);
        reader.finish();
    }
    write_render(s, out);
}

}  // namespace tesserae::scenes

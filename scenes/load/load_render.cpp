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
constexpr std::string_view kFilters[] = {"box", "triangle", "gaussian", "blackman-harris"};
constexpr std::string_view kCompressions[] = {"none", "rle", "zips", "zip", "piz"};
constexpr double kMaxFilterWidth = 100;

struct ChannelName {
    std::string_view name;
    bool render::Channels::*member;
};
constexpr ChannelName kChannels[] = {{"color", &render::Channels::color},
                                     {"depth", &render::Channels::depth},
                                     {"normal", &render::Channels::normal},
                                     {"albedo", &render::Channels::albedo},
                                     {"id", &render::Channels::id},
                                     {"position", &render::Channels::position},
                                     {"variance", &render::Channels::variance},
                                     {"samples", &render::Channels::samples}};

void read_channels(TableReader& reader, render::Channels& channels) {
    std::vector<std::string> names;
    std::vector<std::string_view> allowed;
    for (const auto& [name, member] : kChannels) allowed.push_back(name);
    if (!reader.read("channels", names, allowed)) return;
    if (names.empty()) reader.fail("channels", "expected at least one channel");
    for (const auto& [name, member] : kChannels)
        channels.*member = std::find(names.begin(), names.end(), name) != names.end();
}

std::string channels_text(const render::Channels& channels) {
    std::string text;
    for (const auto& [name, member] : kChannels)
        if (channels.*member) text += (text.empty() ? "" : ", ") + toml_text(name);
    return "[" + text + "]";
}

void read_sampling(TableReader& reader, render::Settings& settings) {
    reader.read("samples", settings.samples, 1, kMaxSamples);
    auto filter = static_cast<std::size_t>(settings.filter);
    reader.read("filter", filter, kFilters);
    settings.filter = static_cast<render::FilterKind>(filter);
    reader.read("filter_width", settings.filter_width, Interval{0, kMaxFilterWidth, true});
    reader.read("noise_target", settings.noise_target, Rule::kNonNegative);
    settings.max_samples = settings.samples;
    reader.read("max_samples", settings.max_samples, 1, kMaxSamples);
    // So that --samples alone can ask for more than the scene's most.
    settings.max_samples = std::max(settings.samples, settings.max_samples);
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
    out.key("clamp_indirect", s.clamp_indirect);
    out.key("intersector", kIntersectors[static_cast<std::size_t>(s.intersector)]);
    out.key("max_steps", std::int64_t{s.max_steps});
    out.key("max_distance", s.max_distance);
    out.key("tile", std::int64_t{s.tile});
    out.key("filter", kFilters[static_cast<std::size_t>(s.filter)]);
    out.key("filter_width", s.filter_width);
    out.key("noise_target", s.noise_target);
    out.key("max_samples", std::int64_t{s.max_samples});
    out.line("channels", channels_text(s.channels));
    out.key("compression", kCompressions[static_cast<std::size_t>(s.compression)]);
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
        read_sampling(reader, s);
        std::size_t integrator = 0, intersector = 0;
        reader.read("integrator", integrator, kIntegrators);
        s.integrator = static_cast<render::Integrator>(integrator);
        reader.read("bounces", s.bounces, 0, kMaxBounces);
        reader.read("clamp_indirect", s.clamp_indirect, Rule::kNonNegative);
        reader.read("intersector", intersector, kIntersectors);
        s.intersector = static_cast<render::Intersector>(intersector);
        reader.read("max_steps", s.max_steps, 1, kMaxSteps);
        reader.read("max_distance", s.max_distance, Rule::kPositive);
        reader.read("tile", s.tile, 8, 512);
        read_channels(reader, s.channels);
        auto compression = static_cast<std::size_t>(s.compression);
        reader.read("compression", compression, kCompressions);
        s.compression = static_cast<render::Compression>(compression);
        reader.read("exposure", s.exposure, Interval{-1000, 1000});
        read_crop(reader, s);
        reader.finish();
    }
    write_render(s, out);
}

}  // namespace tesserae::scenes

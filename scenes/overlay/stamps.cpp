// SPDX-License-Identifier: Apache-2.0
#include "scenes/overlay/stamps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "render/camera/camera.hpp"
#include "render/file/image_info.hpp"
#include "render/file/preview.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

/// The dial's radius and margins, in lines of text.
constexpr double kDialRadius = 1.6, kMargin = 0.7;
/// Lines of the title, as a part of others.
constexpr double kTitle = 1.3;
constexpr double kDegrees = 180 / std::numbers::pi;  ///< in a radian

std::uint8_t srgb_code(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    const double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

/// How far a point is from the segment between two others.
double from_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d along = b - a;
    const double part = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (p - a - part * along).norm();
}

/// A circle with a mark at the top, where w is, and a needle along the slice's fourth axis.
Coverage dial(int radius, double angle) {
    const int side = 2 * radius + 1;
    const double line = std::max(1.0, radius / 16.0), rim = radius - 0.5 * line - 0.5;
    const double turn = angle / kDegrees;
    const Eigen::Vector2d tip = 0.78 * rim * Eigen::Vector2d(std::sin(turn), -std::cos(turn));
    Coverage picture(side, side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const Eigen::Vector2d p(x - radius, y - radius);
            const double circle = std::abs(p.norm() - rim);
            const double mark = from_segment(p, {0, -rim}, {0, -0.8 * rim});
            const double needle = from_segment(p, {0, 0}, tip) - 0.5 * line;
            const double away = std::min({circle, mark, needle}) - 0.5 * line;
            picture.at(x, y) =
                static_cast<std::uint8_t>(std::lround(255 * std::clamp(0.5 - away, 0.0, 1.0)));
        }
    return picture;
}

/// Minus zero reads as zero.
std::string number(double value, int digits) {
    const std::string text = fmt::format("{:.{}f}", value, digits);
    return text.find_first_not_of("-0.") == text.npos && text[0] == '-' ? text.substr(1) : text;
}

std::string gauges(const Overlay& overlay, double time, const SlicePose& slice) {
    std::string text;
    if (overlay.time) text += fmt::format("t = {} s", number(time, 2));
    if (overlay.w)
        text += fmt::format("{}w = {} m", text.empty() ? "" : "    ",
                            number(slice.fourth.dot(slice.position), 2));
    return text;
}

Vec4 vector_in(const render::ImageInfo& info, const char* name, const std::filesystem::path& exr) {
    for (const render::ImageAttribute& attribute : info.attributes)
        if (const auto* four = std::get_if<std::vector<double>>(&attribute.value);
            four && four->size() == 4 && attribute.name == name)
            return Vec4(four->data());
    throw InputError(fmt::format("{}: has no {}, which is to be shown", exr.string(), name));
}

}  // namespace

SlicePose::SlicePose(const render::CameraDescription& camera)
    : position(camera.position), fourth(render::Camera(camera, 1, 1).fourth()) {}

SlicePose::SlicePose(const std::filesystem::path& exr) {
    const render::ImageInfo info = render::read_image_info(exr);
    position = vector_in(info, "tesserae/cameraOrigin", exr);
    fourth = vector_in(info, "tesserae/cameraFourth", exr);
}

OverlayPainter::OverlayPainter(const Scene& scene) : scene_(scene), path_(scene.camera_path()) {
    if (!is_empty()) font_.emplace(scene.overlay.font);
}

/// Between the frame before and the frame after.
bool OverlayPainter::slice_turns(int frame) const {
    const auto fourth = [&](int number) {
        return SlicePose(path_.at(frame_instant(scene_, number).time)).fourth;
    };
    return (fourth(frame + 1) - fourth(frame - 1)).norm() > 1e-6;
}

std::vector<render::Stamp> OverlayPainter::stamps(int frame, const SlicePose& slice) const {
    std::vector<render::Stamp> stamps;
    if (!font_) return stamps;
    const Overlay& overlay = scene_.overlay;
    const auto [width, height] = render::preview_size_of(scene_.render, scene_.render.window());
    const double time = frame_instant(scene_, frame).time;
    const int line = std::clamp(static_cast<int>(std::lround(overlay.text_size * height)), 1, 1000);
    const int margin = static_cast<int>(std::lround(kMargin * line)), rim = std::max(2, line / 6);
    const int room = std::max(1, width - 2 * margin);
    const std::array<std::uint8_t, 3> color = {
        srgb_code(overlay.color[0]), srgb_code(overlay.color[1]), srgb_code(overlay.color[2])};
    const auto add = [&](const Coverage& coverage, int x, int y) {
        render::Stamp stamp = with_rim(coverage, color, rim);
        stamp.x += x, stamp.y += y;
        stamps.push_back(std::move(stamp));
    };
    if (!overlay.title.empty())
        add(font_->line(overlay.title, static_cast<int>(std::lround(kTitle * line)), room), margin,
            margin);
    int bottom = height - margin;
    if (const std::string text = gauges(overlay, time, slice); !text.empty()) {
        const Coverage written = font_->line(text, line, room);
        bottom -= written.height;
        add(written, margin, bottom);
    }
    // Several captions at once stand one above the other, the first on top.
    for (auto c = overlay.captions.rbegin(); c != overlay.captions.rend(); ++c) {
        if (!(c->from <= time && time < c->to)) continue;
        const Coverage written = font_->line(c->text, line, room);
        bottom -= written.height;
        add(written, (width - written.width) / 2, bottom);
    }
    if (overlay.dial && slice_turns(frame)) {
        const int radius = static_cast<int>(std::lround(kDialRadius * line));
        const double angle = std::acos(std::clamp(slice.fourth[3], -1.0, 1.0)) * kDegrees;
        const int left = width - margin - 2 * radius - 1;
        add(dial(radius, angle), left, margin);
        const Coverage written = font_->line(number(angle, 0) + "\u00b0", line, room);
        add(written, left + radius - written.width / 2, margin + 2 * radius + 1);
    }
    return stamps;
}

}  // namespace tesserae::scenes

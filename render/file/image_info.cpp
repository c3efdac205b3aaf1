// SPDX-License-Identifier: Apache-2.0
#include "render/file/image_info.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/ranges.h>

#include <charconv>
#include <string_view>

#include "core/error.hpp"
#include "render/file/exr_header.hpp"

namespace tesserae::render {
namespace {

/// The four numbers of a camera's vector, which ExrWriter stores as a text; none: it is none.
std::vector<double> camera_vector(std::string_view name, const std::string& text) {
    if (!name.starts_with("tesserae/camera")) return {};
    std::vector<double> numbers(4);
    const char *at = text.data(), *const end = at + text.size();
    for (double& number : numbers) {
        const auto [next, error] = std::from_chars(at, end, number);
        const bool is_last = &number == &numbers.back();
        if (error != std::errc() || (next == end) != is_last) return {};
        if (!is_last && *next != ' ') return {};
        at = next + (is_last ? 0 : 1);
    }
    return numbers;
}

/// An attribute of a simple type; one without a text for all others.
ImageAttribute attribute_of(const char* name, const Imf::Attribute& attribute) {
    if (const auto* a = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
        if (auto vector = camera_vector(name, a->value()); !vector.empty())
            return {name, std::move(vector), a->value()};
        return {name, a->value(), a->value()};
    }
    if (const auto* a = dynamic_cast<const Imf::IntAttribute*>(&attribute))
        return {name, std::int64_t{a->value()}, fmt::format("{}", a->value())};
    if (const auto* a = dynamic_cast<const Imf::FloatAttribute*>(&attribute))
        return {name, double{a->value()}, fmt::format("{}", a->value())};
    if (const auto* a = dynamic_cast<const Imf::DoubleAttribute*>(&attribute))
        return {name, a->value(), fmt::format("{}", a->value())};
    if (const auto* a = dynamic_cast<const Imf::RationalAttribute*>(&attribute))
        return {name, std::vector<std::int64_t>{a->value().n, a->value().d},
                fmt::format("{}/{}", a->value().n, a->value().d)};
    if (const auto* a = dynamic_cast<const Imf::FloatVectorAttribute*>(&attribute))
        return {name, std::vector<double>(a->value().begin(), a->value().end()),
                fmt::format("{}", fmt::join(a->value(), ", "))};
    return {name, {}, {}};
}

void read_version(const Imf::Header& header, const char* name, int& version) {
    if (const auto* found = header.findTypedAttribute<Imf::IntAttribute>(name))
        version = found->value();
}

}  // namespace

ImageInfo read_image_info(const std::filesystem::path& file) {
    ImageInfo info;
    try {
        const Imf::Header header = read_exr_header(file);
        const auto &full = header.displayWindow(), &data = header.dataWindow();
        info.width = full.max.x - full.min.x + 1;
        info.height = full.max.y - full.min.y + 1;
        info.x0 = data.min.x, info.y0 = data.min.y;
        info.x1 = data.max.x + 1, info.y1 = data.max.y + 1;
        for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
            info.channels.emplace_back(c.name());
        for (auto a = header.begin(); a != header.end(); ++a)
            if (ImageAttribute found = attribute_of(a.name(), a.attribute()); !found.text.empty())
                info.attributes.push_back(std::move(found));
        if (const auto* hash = header.findTypedAttribute<Imf::StringAttribute>(kSceneHashAttribute))
            info.scene_hash = hash->value();
        read_version(header, kMotionVersionAttribute, info.motion_version);
        read_version(header, kPictureVersionAttribute, info.picture_version);
    } catch (const std::exception& error) {
        throw InputError(
            fmt::format("{}: not a readable OpenEXR image: {}", file.string(), error.what()));
    }
    return info;
}

}  // namespace tesserae::render

#include "render/file/image_info.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/ranges.h>

#include "core/error.hpp"

namespace tesserae::render {
namespace {

/// The value of an attribute of a simple type as text; empty for all others.
std::string text_of(const Imf::Attribute& attribute) {
    if (const auto* a = dynamic_cast<const Imf::StringAttribute*>(&attribute)) return a->value();
    if (const auto* a = dynamic_cast<const Imf::IntAttribute*>(&attribute))
        return fmt::format("{}", a->value());
    if (const auto* a = dynamic_cast<const Imf::FloatAttribute*>(&attribute))
        return fmt::format("{}", a->value());
    if (const auto* a = dynamic_cast<const Imf::DoubleAttribute*>(&attribute))
        return fmt::format("{}", a->value());
    if (const auto* a = dynamic_cast<const Imf::RationalAttribute*>(&attribute))
        return fmt::format("{}/{}", a->value().n, a->value().d);
    if (const auto* a = dynamic_cast<const Imf::FloatVectorAttribute*>(&attribute))
        return fmt::format("{}", fmt::join(a->value(), ", "));
    return {};
}

}  // namespace

ImageInfo read_image_info(const std::filesystem::path& file) {
    ImageInfo info;
    try {
        const Imf::InputFile in(file.c_str());
        const Imf::Header& header = in.header();
        const auto &full = header.displayWindow(), &data = header.dataWindow();
        info.width = full.max.x - full.min.x + 1;
        info.height = full.max.y - full.min.y + 1;
        info.x0 = data.min.x, info.y0 = data.min.y;
        info.x1 = data.max.x + 1, info.y1 = data.max.y + 1;
        for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
            info.channels.emplace_back(c.name());
        for (auto a = header.begin(); a != header.end(); ++a)
            if (std::string text = text_of(a.attribute()); !text.empty())
                info.attributes.emplace_back(a.name(), std::move(text));
        if (const auto* hash = header.findTypedAttribute<Imf::StringAttribute>(kSceneHashAttribute))
            info.scene_hash = hash->value();
    } catch (const std::exception& error) {
        throw InputError(
            fmt::format("{}: not a readable OpenEXR image: {}", file.string(), error.what()));
    }
    return info;
}

}  // namespace tesserae::render

// SPDX-License-Identifier: Apache-2.0
#include "scenes/overlay/text.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <fstream>

#include "core/error.hpp"

namespace tesserae::scenes {
namespace {

/// Fonts are some megabytes; Chinese ones some tens.
constexpr std::uint64_t kMostBytes = 256u << 20;

/// Calls use(code point) for each character. What is not UTF-8 is U+FFFD, a byte each.
template <class Use>
void for_each_character(std::string_view utf8, Use&& use) {
    for (std::size_t i = 0; i < utf8.size();) {
        const auto byte = [&](std::size_t at) {
            return at < utf8.size() ? static_cast<unsigned char>(utf8[at]) : 0u;
        };
        const unsigned first = byte(i);
        const std::size_t length = first < 0x80 ? 1 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
        unsigned long code = length == 1 ? first : first & (0xffu >> (length + 1));
        bool is_whole = first < 0x80 || (first >= 0xc2 && first < 0xf5);
        for (std::size_t k = 1; k < length; ++k) {
            is_whole = is_whole && (byte(i + k) & 0xc0) == 0x80;
            code = code << 6 | (byte(i + k) & 0x3f);
        }
        use(is_whole ? code : 0xfffdul);
        i += is_whole ? length : 1;
    }
}

/// The most of a coverage within `radius`, faded towards the edge.
std::uint8_t near(const Coverage& coverage, int x, int y, int radius) {
    int most = 0;
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx) {
            const int square = dx * dx + dy * dy, all = (radius + 1) * (radius + 1);
            if (square < all)
                most = std::max(most, coverage.at(x + dx, y + dy) * (all - square) / all);
        }
    return static_cast<std::uint8_t>(most);
}

}  // namespace

render::Stamp with_rim(const Coverage& coverage, const std::array<std::uint8_t, 3>& color,
                       int rim) {
    render::Stamp stamp = {-rim, -rim, coverage.width + 2 * rim, coverage.height + 2 * rim, {}};
    for (int y = -rim; y < coverage.height + rim; ++y)
        for (int x = -rim; x < coverage.width + rim; ++x) {
            const int own = coverage.at(x, y);
            const int dark = 3 * near(coverage, x, y, rim) / 4;
            // The rim shows where the colour does not cover.
            const int alpha = own + (255 - own) * dark / 255;
            for (const std::uint8_t c : color)
                stamp.rgba.push_back(static_cast<std::uint8_t>(alpha > 0 ? c * own / alpha : 0));
            stamp.rgba.push_back(static_cast<std::uint8_t>(alpha));
        }
    return stamp;
}

struct Font::Library {
    std::vector<unsigned char> bytes;
    FT_Library library = nullptr;
    FT_Face face = nullptr;

    ~Library() {
        if (face) FT_Done_Face(face);
        if (library) FT_Done_FreeType(library);
    }
    /// Calls use(left edge of the character's bitmap, its glyph) from left to right.
    /// @return where the next character would begin [pixels]
    template <class Use>
    int walk(std::string_view utf8, int pixels, FT_Int32 flags, Use&& use) const {
        if (FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(pixels)) != 0) return 0;
        FT_Pos pen = 0;  // in 64ths of a pixel
        FT_UInt last = 0;
        for_each_character(utf8, [&](unsigned long code) {
            const FT_UInt glyph = FT_Get_Char_Index(face, code);
            FT_Vector kerning = {0, 0};
            if (last != 0 && FT_HAS_KERNING(face))
                FT_Get_Kerning(face, last, glyph, FT_KERNING_DEFAULT, &kerning);
            last = glyph;
            pen += kerning.x;
            if (FT_Load_Glyph(face, glyph, flags) != 0) return;
            use(static_cast<int>(pen >> 6), face->glyph);
            pen += face->glyph->advance.x;
        });
        return static_cast<int>((pen + 63) >> 6);
    }
};

Font::Font(const std::filesystem::path& file) : file_(file), library_(new Library) {
    const auto fail = [&](const char* why) {
        throw InputError(fmt::format("overlay.font: {}: {}; expected a font file, such as {}",
                                     file_.string(), why,
                                     "DejaVuSans.ttf of Debian's package fonts-dejavu-core"));
    };
    std::error_code error;
    const std::uint64_t size = std::filesystem::file_size(file, error);
    std::ifstream in(file, std::ios::binary);
    if (error || !in) fail(error ? error.message().c_str() : "cannot be read");
    if (size > kMostBytes) fail("is larger than 256 MB");
    library_->bytes.resize(size);
    in.read(reinterpret_cast<char*>(library_->bytes.data()), static_cast<std::streamsize>(size));
    if (!in) fail("cannot be read");
    if (FT_Init_FreeType(&library_->library) != 0) throw std::bad_alloc();
    if (FT_New_Memory_Face(library_->library, library_->bytes.data(), static_cast<FT_Long>(size), 0,
                           &library_->face) != 0 ||
        !FT_IS_SCALABLE(library_->face))
        fail("is no font with outlines");
}

Font::~Font() = default;

int Font::width_of(std::string_view utf8, int pixels) const {
    return library_->walk(utf8, pixels, FT_LOAD_DEFAULT, [](int, FT_GlyphSlot) {});
}

Coverage Font::line(std::string_view utf8, int pixels, int most) const {
    int size = std::clamp(pixels, 1, 1000);
    const int width = width_of(utf8, size);
    if (width > most)
        size = std::max(1, static_cast<int>(static_cast<std::int64_t>(size) * most / width));
    while (size > 1 && width_of(utf8, size) > most) --size;
    return line_of(utf8, size);
}

Coverage Font::line_of(std::string_view utf8, int pixels) const {
    const int width = std::clamp(width_of(utf8, pixels), 0, 1 << 16);
    const FT_Size_Metrics& size = library_->face->size->metrics;
    const int above = static_cast<int>((size.ascender + 63) >> 6);
    const int below = static_cast<int>((63 - size.descender) >> 6);
    Coverage line(width, std::clamp(above + below, 0, 4000));
    library_->walk(utf8, pixels, FT_LOAD_RENDER, [&](int pen, FT_GlyphSlot glyph) {
        const FT_Bitmap& bitmap = glyph->bitmap;
        if (bitmap.pixel_mode != FT_PIXEL_MODE_GRAY) return;
        for (int row = 0; row < static_cast<int>(bitmap.rows); ++row)
            for (int column = 0; column < static_cast<int>(bitmap.width); ++column) {
                const int x = pen + glyph->bitmap_left + column;
                const int y = above - glyph->bitmap_top + row;
                if (x < 0 || x >= line.width || y < 0 || y >= line.height) continue;
                std::uint8_t& part = line.at(x, y);
                part = std::max(part, bitmap.buffer[row * bitmap.pitch + column]);
            }
    });
    return line;
}

}  // namespace tesserae::scenes

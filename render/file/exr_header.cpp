// SPDX-License-Identifier: Apache-2.0
#include "render/file/exr_header.hpp"

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfVersion.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>

namespace tesserae::render {
namespace {

void require_header(bool good, const char* what) {
    if (!good) throw std::runtime_error(what);
}

/// The system has not failed.
void require_system(bool good) {
    if (!good) throw ReadFailure(std::strerror(errno));
}

/// Reads a file from its beginning to the end of its headers.
class HeaderWalk {
  public:
    explicit HeaderWalk(const std::filesystem::path& path)
        : in_(path, std::ios::binary), bytes_(std::filesystem::file_size(path)) {
        require_system(in_.good());
    }

    std::int32_t number() {
        std::int32_t value = 0;
        in_.read(reinterpret_cast<char*>(&value), sizeof value);
        require_system(!in_.bad());
        return value;
    }
    /// Attributes as name, type, length and value up to an empty name (OpenEXR File Layout).
    /// @return false: there is none
    bool skip_attributes() {
        std::string name = word();
        if (name.empty()) return false;
        for (; !name.empty(); name = word()) {
            const std::string type = word();
            const std::int64_t length = number();
            const std::int64_t begin = in_.tellg(), end = begin + length;
            require_whole(in_.good() && length >= 0 && end <= static_cast<std::int64_t>(bytes_));
            // OpenEXR reads such a value by its type: of another length it would take what follows
            // for something else.
            const auto fixed = kLengths.find(type);
            bool is_right = fixed == kLengths.end() || fixed->second == length;
            if (type == "chlist") is_right = skip_channels() == end;
            if (type == "preview" && length >= 8) {
                const std::int64_t width = number(), height = number();
                is_right = width >= 0 && height >= 0 && length % 4 == 0 &&
                           width * height == (length - 8) / 4;
            }
            require_header(is_right, "a value of its header has another length than its type");
            in_.seekg(end);
        }
        return true;
    }

    std::uint64_t position() { return static_cast<std::uint64_t>(in_.tellg()); }

  private:
    static constexpr std::size_t kLongestName = 255;

    /// Of values whose type tells it [bytes].
    static inline const std::map<std::string, std::int64_t> kLengths = {{"box2f", 16},
                                                                        {"box2i", 16},
                                                                        {"chromaticities", 32},
                                                                        {"compression", 1},
                                                                        {"deepImageState", 1},
                                                                        {"double", 8},
                                                                        {"envmap", 1},
                                                                        {"float", 4},
                                                                        {"int", 4},
                                                                        {"keycode", 28},
                                                                        {"lineOrder", 1},
                                                                        {"m33d", 72},
                                                                        {"m33f", 36},
                                                                        {"m44d", 128},
                                                                        {"m44f", 64},
                                                                        {"rational", 8},
                                                                        {"tiledesc", 9},
                                                                        {"timecode", 8},
                                                                        {"v2d", 16},
                                                                        {"v2f", 8},
                                                                        {"v2i", 8},
                                                                        {"v3d", 24},
                                                                        {"v3f", 12},
                                                                        {"v3i", 12}};

    /// Channels: a name and 16 bytes each, up to an empty name.
    /// @return where they end
    std::int64_t skip_channels() {
        while (!word().empty()) in_.seekg(16, std::ios::cur);
        return in_.tellg();
    }
    /// The bytes up to the next zero.
    std::string word() {
        std::string text;
        require_whole(std::getline(in_, text, '\0') && !in_.eof());
        // OpenEXR takes so many bytes for a whole name, and what follows for something else.
        require_header(text.size() <= kLongestName, "its header has a name that is too long");
        return text;
    }

    /// A file that ends too early is cut off, unless it is the system that fails.
    void require_whole(bool good) const {
        require_system(!in_.bad());
        require_header(good, "its header is cut off");
    }

    std::ifstream in_;
    std::uint64_t bytes_;
};

}  // namespace

ExrHeader checked_exr_header(const std::filesystem::path& path) {
    require_header(std::filesystem::is_regular_file(path), "is not a file");
    HeaderWalk walk(path);
    require_header(walk.number() == Imf::MAGIC, "has another magic number");
    const int version = walk.number();
    require_header(
        Imf::getVersion(version) == Imf::EXR_VERSION && Imf::supportsFlags(Imf::getFlags(version)),
        "is of another version of OpenEXR");
    // Headers of several parts end with an empty one.
    while (walk.skip_attributes() && Imf::isMultiPart(version)) continue;
    return {version, walk.position()};
}

Imf::Header read_exr_header(const std::filesystem::path& path) {
    int version = checked_exr_header(path).version;
    Imf::StdIFStream stream(path.c_str());
    stream.seekg(sizeof Imf::MAGIC + sizeof version);
    Imf::Header header;
    header.readFrom(stream, version);
    // Of several parts each says itself what it is.
    const bool several = Imf::isMultiPart(version);
    header.sanityCheck(
        several ? header.hasType() && Imf::isTiled(header.type()) : Imf::isTiled(version), several);
    return header;
}

}  // namespace tesserae::render

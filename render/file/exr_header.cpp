#include "render/file/exr_header.hpp"

#include <OpenEXR/ImfVersion.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>

namespace tesserae::render {
namespace {

void require_header(bool good, const char* what) {
    if (!good) throw std::runtime_error(what);
}

/// Reads a file from its beginning to the end of its headers.
class HeaderWalk {
  public:
    explicit HeaderWalk(const std::filesystem::path& path)
        : in_(path, std::ios::binary), bytes_(std::filesystem::file_size(path)) {
        require_header(in_.good(), std::strerror(errno));
    }

    std::int32_t number() {
        std::int32_t value = 0;
        in_.read(reinterpret_cast<char*>(&value), sizeof value);
        require_header(!in_.bad(), std::strerror(errno));
        return value;
    }
    /// Attributes as name, type, length and value up to an empty name (OpenEXR File Layout).
    /// @return false: there is none
    bool skip_attributes() {
        std::string name = word();
        if (name.empty()) return false;
        for (; !name.empty(); name = word()) {
            word();
            const std::int64_t length = number();
            const std::int64_t left = static_cast<std::int64_t>(bytes_) - in_.tellg();
            require_header(in_.good() && length >= 0 && length <= left, kCut);
            in_.seekg(length, std::ios::cur);
        }
        return true;
    }

  private:
    static constexpr const char* kCut = "its header is cut off";

    /// The bytes up to the next zero.
    std::string word() {
        std::string text;
        require_header(std::getline(in_, text, '\0') && !in_.eof(), kCut);
        return text;
    }

    std::ifstream in_;
    std::uint64_t bytes_;
};

}  // namespace

int checked_exr_version(const std::filesystem::path& path) {
    require_header(std::filesystem::is_regular_file(path), "is not a file");
    HeaderWalk walk(path);
    require_header(walk.number() == Imf::MAGIC, "has another magic number");
    const int version = walk.number();
    // Headers of several parts end with an empty one.
    while (walk.skip_attributes() && Imf::isMultiPart(version)) continue;
    return version;
}

}  // namespace tesserae::render

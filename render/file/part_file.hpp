// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/file/exr_writer.hpp"
#include "render/file/preview.hpp"
#include "render/frame.hpp"

namespace tesserae::render {

/// What a part says of itself before its tiles.
struct PartInfo {
    FramePart part;
    Crop window;
    Sky sky = Sky::kOpaque;   ///< of the preview
    int preview_size = 0;     ///< as Settings has it
    std::uint64_t tiles = 0;  ///< of the whole frame
    std::string exr_header;  ///< with an empty table of tiles: the frame's scene, number and camera

    /// Of one frame, cut in the same way.
    bool goes_with(const PartInfo& o) const {
        return part.count == o.part.count && preview_size == o.preview_size &&
               exr_header == o.exr_header && tiles == o.tiles && window.x0 == o.window.x0 &&
               window.y0 == o.window.y0 && window.x1 == o.window.x1 && window.y1 == o.window.y1;
    }
};

/// Writes a part of a frame: the frame's own EXR header, tiles as the image will hold them, the
/// part's share of the preview's sums, and a checksum. Without finish() nothing is left.
class PartWriter {
  public:
    /// @throws RunError   as FileWriter
    PartWriter(const std::filesystem::path& path, const PartInfo& info);
    ~PartWriter();

    void write(const PackedTile& tile);
    void finish(const Preview& preview);

  private:
    struct File;
    std::unique_ptr<File> file_;
};

/// Reads what a part says of itself, not its tiles.
/// @throws InputError   it does not begin as a part
PartInfo read_part_info(const std::filesystem::path& file);

/// What is wrong with a part's file, with its path: it is cut off, or its checksum is not that of
/// its bytes. Empty where it is whole.
std::string damage_of_part(const std::filesystem::path& file);

/// Returns whether a whole image is the frame that a part belongs to.
/// @throws InputError   as is_whole_image()
bool is_made_of(const std::filesystem::path& exr, const PartInfo& info);

/// Makes the frame and its preview, with the bytes of rendering it at once.
/// @param parts   all parts of the frame, in their order
/// @throws InputError   they are not; a file is damaged. RunError: a file cannot be written
void join_parts(std::span<const std::filesystem::path> parts, const std::filesystem::path& exr,
                const std::filesystem::path& preview);

}  // namespace tesserae::render

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "render/description.hpp"

namespace tesserae::render {

enum class PixelType { kHalf, kFloat, kUint };

/// "half", "float", "uint".
const char* name_of(PixelType type);
std::size_t bytes_of(PixelType type);
/// A stored value as a real, which holds each of the three exactly.
double value_of(PixelType type, const unsigned char* bytes);

struct ImageChannel {
    std::string name;
    PixelType type = PixelType::kHalf;

    friend bool operator==(const ImageChannel&, const ImageChannel&) = default;
};

/// The pixels of some lines, for each channel: little-endian values, from left to right and from
/// the top down.
using PixelPlanes = std::vector<std::vector<unsigned char>>;

/// Reads any OpenEXR image of one part, tiled or by lines, in blocks of lines. Each object may be
/// used by one thread at a time.
/// Memory is bounded: at most 65536 pixels a side, 64 channels, and 1 GiB for what is compressed
/// together (a row of tiles); attributes no longer than the file.
/// Everything throws InputError with the path and the reason: not such an image, several parts,
/// deep or subsampled channels, levels of several sizes, a tile or line that is missing or damaged.
class ImagePixels {
  public:
    explicit ImagePixels(const std::filesystem::path& file);
    ~ImagePixels();
    ImagePixels(const ImagePixels&) = delete;
    ImagePixels& operator=(const ImagePixels&) = delete;

    /// The data window, half open: the pixels that the file holds.
    const Crop& window() const;
    const std::vector<ImageChannel>& channels() const;  ///< ascending by name, at least one

    /// Reads lines y0 <= y < y1 of the window into `planes`, in the order of channels().
    void read(int y0, int y1, PixelPlanes& planes) const;
    /// Lines of a block of some MiB.
    int block_lines() const;
    /// Calls work(y0, y1, planes) for all lines, from the top down.
    void for_each_block(const std::function<void(int, int, const PixelPlanes&)>& work) const;

  private:
    struct File;
    std::unique_ptr<File> file_;
};

}  // namespace tesserae::render

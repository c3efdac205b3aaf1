// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "render/camera/camera.hpp"
#include "render/picture.hpp"
#include "render/tile/tile_image.hpp"

namespace tesserae::render {

/// A tile as it is stored in the file.
struct PackedTile {
    std::uint64_t index = 0;  ///< in the file's table: by rows
    std::vector<char> bytes;
};

/// Compresses tiles to what a frame's file holds of them.
class TilePacker {
  public:
    /// As ExrWriter.
    TilePacker(const Settings& settings, const Crop& window, const FrameInfo& info,
               const CameraDescription& description, const Camera& camera, const Mattes* mattes);
    ~TilePacker();

    /// On any thread, while others do the same.
    PackedTile pack(const TileImage& tile);
    /// The file up to its first tile: the header, and a table without tiles.
    std::string file_header() const;
    /// How many tiles the file has.
    std::uint64_t tiles() const;

  private:
    friend class ExrWriter;
    struct Packers;
    std::unique_ptr<Packers> packers_;
};

/// Writes a frame as a tiled, ZIP-compressed OpenEXR file, tiles in the order of the calls. Without
/// finish() nothing is left.
/// Header attributes beside the standard ones, all of them functions of the scene:
///   tesserae/scene, tesserae/sceneHash, tesserae/version, tesserae/idNames (JSON)   string
///   tesserae/frame, tesserae/samples, tesserae/motionVersion, tesserae/pictureVersion   int
///   tesserae/time [s], tesserae/fieldOfView [degrees]                               double
///   tesserae/cameraOrigin, cameraRight, cameraUp, cameraForward, cameraFourth
///                                                   string: four numbers that read back exactly
///   framesPerSecond (rational), chromaticities (Rec. 709)
///   cryptomatte/KEY/name, hash, conversion, manifest or manif_file   string, see Mattes
class ExrWriter {
  public:
    /// @param window   data window, half open; the display window is the full frame
    /// @param mattes   where Channels::cryptomatte is asked for
    /// @throws InputError   no channel is asked for; RunError as FileWriter
    ExrWriter(const std::filesystem::path& path, const Settings& settings, const Crop& window,
              const FrameInfo& info, const CameraDescription& description, const Camera& camera,
              const Mattes* mattes = nullptr);
    ~ExrWriter();

    /// Compresses a tile, on any thread, while others do the same.
    PackedTile pack(const TileImage& tile) { return packer_.pack(tile); }
    /// One tile at a time.
    void write(const PackedTile& tile);
    /// Instead: all tiles of another file, as they are stored there. It must have been written with
    /// the same settings and window.
    /// @throws RunError   it cannot be read
    void copy_tiles(const std::filesystem::path& other);
    /// After the last tile: the file appears under its name.
    void finish();

  private:
    struct File;
    TilePacker packer_;
    std::unique_ptr<File> file_;
};

}  // namespace tesserae::render

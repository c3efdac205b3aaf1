// SPDX-License-Identifier: Apache-2.0
#include "render/file/copied_frame.hpp"

#include "core/file/file_writer.hpp"
#include "core/file/read_file.hpp"
#include "render/camera/camera.hpp"
#include "render/file/exr_writer.hpp"
#include "render/file/preview_file.hpp"

namespace tesserae::render {
namespace {

void copy_bytes(const std::filesystem::path& from, const std::filesystem::path& to) {
    write_file(to, read_file(from));
}

}  // namespace

void copy_frame(const FrameFiles& from, bool is_same_overlay, const Picture& picture,
                const FrameInfo& info, const FrameFiles& to) {
    const Settings& settings = picture.settings;
    const Crop window = settings.window();
    const Camera camera(picture.camera, settings.width, settings.height);
    ExrWriter image(to.exr, settings, window, info, picture.camera, camera, picture.mattes);
    image.copy_tiles(from.exr);
    // The preview first: where the image exists, its preview does.
    if (is_same_overlay)
        copy_bytes(from.preview, to.preview);
    else
        remake_preview(from.exr, settings, picture.overlay, to.preview);
    image.finish();
}

}  // namespace tesserae::render

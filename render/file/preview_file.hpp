// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "render/description.hpp"
#include "render/file/preview.hpp"
#include "render/file/stamp.hpp"

// Previews that lie beside their images.
namespace tesserae::render {

/// What is wrong with a preview's file, with its path: it cannot be read, it is cut off, a chunk's
/// checksum is not that of its bytes, or it has another size. Empty where it is whole.
std::string damage_of_preview(const std::filesystem::path& file, const PreviewSize& size);

/// Makes the preview of an image from the image, with the bytes that rendering it gave.
/// @param settings, overlay   as it was made
/// @return false: the image holds no colour
/// @throws InputError   the image cannot be read; RunError: the preview cannot be written
bool remake_preview(const std::filesystem::path& exr, const Settings& settings,
                    std::span<const Stamp> overlay, const std::filesystem::path& preview);

}  // namespace tesserae::render

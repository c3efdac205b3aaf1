// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/picture.hpp"

namespace tesserae::render {

/// What a picture needs beside a ray through every sample's pixel, decided from what it is made of.
/// What is false is left out of the whole frame. The renderer acts on it, `tesserae plan` tells it.
struct PictureNeeds {
    bool shadow_rays;    ///< a light shines, and a visible body is neither mirror nor glass
    bool lamp_choice;    ///< of many lamps one is asked for light: see Lamps
    bool bounce_rays;    ///< from surface to surface: light paths, or a visible mirror or glass
    bool specular_rays;  ///< of them, by way of a visible mirror or glass
    bool centre_rays;    ///< beside several samples, for what is as at the pixel's centre
    bool more_samples;   ///< where a pixel is noisy
    bool lens;           ///< view rays start anywhere in its disc
    bool slices;         ///< several, side by side
    bool thick_slice;    ///< view rays start anywhere in it
    bool ghosts;         ///< bodies beside the slice are drawn
    bool moving;         ///< the shutter is open while something moves
    bool moving_noise;   ///< something is random, and differs from frame to frame

    /// Rays leave the slice, or view rays have slices of their own, as bodies are not where they
    /// were at the opening.
    bool tree() const { return shadow_rays || bounce_rays || moving; }
};

PictureNeeds needs_of(const Picture& picture);

/// View rays of a pixel at most: every sample's, and that of the centre.
int most_view_rays(const Settings& settings);

}  // namespace tesserae::render

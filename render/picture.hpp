// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <string>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/motion_version.hpp"
#include "render/description.hpp"
#include "render/file/stamp.hpp"
#include "render/mattes.hpp"
#include "render/picture_version.hpp"

// What a frame is asked to show, and what was counted while it was rendered.
namespace tesserae::render {

/// A moment while the shutter is open.
struct ShutterMoment {
    double time;  ///< since the opening [s], > 0
    Bodies bodies;
    CameraDescription camera;
};

/// The frame before or after.
struct Neighbour {
    Bodies bodies;
    CameraDescription camera;
};

/// Everything that decides a frame's pixels. Refers to its parts; they must outlive it.
struct Picture {
    const Bodies& bodies;                    ///< poses at the frame's time, when the shutter opens
    std::span<const Appearance> appearance;  ///< by body type
    std::span<const Material> materials;
    const CameraDescription& camera;
    const Lights& lights;
    const Settings& settings;
    /// What is known of the time after the opening, ascending: the last moment is when the shutter
    /// closes; none for one that is open for no time. Between moments bodies move evenly.
    std::span<const ShutterMoment> path = {};
    int frame = 0;  ///< its number: frames have random numbers of their own
    /// Of the same bodies: for Channels::motion only. Without one its vectors are 0.
    const Neighbour *next = nullptr, *last = nullptr;
    const Mattes* mattes = nullptr;       ///< where Channels::cryptomatte is asked for
    std::span<const Stamp> overlay = {};  ///< lies over the preview
};

/// What goes into the header beside the pixels.
struct FrameInfo {
    std::string scene_name, scene_hash, program_version;
    int frame = 0;
    double time = 0;                      ///< [s]
    std::string id_names;                 ///< JSON: names of the object ids
    int motion_version = kMotionVersion;  ///< by which the bodies came to where they are
    int picture_version = kPictureVersion;
};

/// A sample of a pixel; by rows, then columns.
struct SampleNumber {
    int y = 0, x = 0;  ///< pixel from the full frame's top left
    std::uint32_t sample = 0;

    friend auto operator<=>(const SampleNumber&, const SampleNumber&) = default;
};

struct FrameStats {
    std::uint64_t view_rays = 0, shadow_rays = 0, bounce_rays = 0, distance_evaluations = 0;
    /// Sphere traces that used up their steps; they count as hits, so that no ray leaks through.
    std::uint64_t unresolved = 0;
    /// Light paths that ended at a mirror or glass as they had used up Settings::specular_bounces.
    std::uint64_t cut_paths = 0;
    /// Samples whose colour was infinite or no number: left out of their pixels, as black.
    std::uint64_t invalid_samples = 0;
    SampleNumber first_invalid;  ///< the lowest of them, if there is any
    /// Pixels of which a stored colour is beyond what a half holds, +-65504: stored as that.
    std::uint64_t clamped_pixels = 0;
    SampleNumber first_clamped;  ///< the lowest of them, if there is any; sample 0

    FrameStats& operator+=(const FrameStats& o) {
        view_rays += o.view_rays, shadow_rays += o.shadow_rays;
        bounce_rays += o.bounce_rays;
        distance_evaluations += o.distance_evaluations, unresolved += o.unresolved;
        cut_paths += o.cut_paths;
        if (o.invalid_samples > 0) count_invalid(o.first_invalid, o.invalid_samples);
        if (o.clamped_pixels > 0) count_clamped(o.first_clamped, o.clamped_pixels);
        return *this;
    }
    void count_invalid(const SampleNumber& sample, std::uint64_t count) {
        if (invalid_samples == 0 || sample < first_invalid) first_invalid = sample;
        invalid_samples += count;
    }
    void count_clamped(const SampleNumber& pixel, std::uint64_t count) {
        if (clamped_pixels == 0 || pixel < first_clamped) first_clamped = pixel;
        clamped_pixels += count;
    }
};

}  // namespace tesserae::render

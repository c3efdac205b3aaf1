#pragma once

namespace tesserae::scenes {

/// How the camera moves beside its keys.
struct CameraMotion {
    bool closed = false;  ///< its path goes on round after the last key
};

}  // namespace tesserae::scenes

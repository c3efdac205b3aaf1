// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include "scenes/scene_file.hpp"

namespace tesserae::python {

using SceneClass = pybind11::class_<Scene>;

/// Adds what shows a scene in a browser.
void add_views(SceneClass& scene);

}  // namespace tesserae::python

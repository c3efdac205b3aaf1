// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "render/finished_picture.hpp"
#include "scenes/python/arrays.hpp"
#include "scenes/python/topics.hpp"

namespace tesserae::python {
namespace {

using py::arg;
namespace fs = std::filesystem;

/// Returns a layer as an array (height, width, channels) that keeps the picture. It cannot be
/// written.
py::array layer_of(const Picture& self, const std::string& name) {
    const std::span<const float> values = self.layer(name);
    const auto channels = static_cast<py::ssize_t>(self.channels(name).size());
    py::array_t<float> view({py::ssize_t{self.height()}, py::ssize_t{self.width()}, channels},
                            values.data(), owner_of(std::make_shared<Picture>(self)));
    view.attr("flags").attr("writeable") = false;
    return view;
}

std::string text_of(const Picture& self) {
    std::string layers;
    for (const std::string& name : self.layers()) layers += (layers.empty() ? "" : ", ") + name;
    return fmt::format("<Picture: {} x {}, {}>", self.width(), self.height(), layers);
}

/// The preview as the bytes of a PNG file, which notebooks show.
py::object preview_of(const Picture& self) {
    if (!self.has("color")) return py::none();
    const py::object folder = py::module_::import("tempfile").attr("TemporaryDirectory")();
    const fs::path file = fs::path(folder.attr("name").cast<std::string>()) / "picture.png";
    self.write_preview(file);
    py::object bytes =
        py::module_::import("pathlib").attr("Path")(file.string()).attr("read_bytes")();
    folder.attr("cleanup")();
    return bytes;
}

}  // namespace

void add_pictures(py::module_& module) {
    py::class_<Picture>(module, "Picture", R"(A rendered picture in memory. Notebooks show it.

picture["color"] is a layer as an array (height, width, channels) of float32 that cannot be written:
rows from the top down, in each the pixels from left to right. A scene's render.channels says which
layers there are:

  color        4  R, G, B, A: linear Rec. 709; the alpha is the bodies' coverage
  depth        1  distance along the view ray [m], infinite where no body is
  normal       4  x, y, z, w, world
  albedo       3  R, G, B
  id           1  number of the body + 1; 0: none
  position     4  x, y, z, w, world [m]
  variance     3  of the pixel's mean colour
  samples      1  how many the pixel took
  motion       4  to where the point is in the next frame, right and up, and was in the last [pixels]
  zplanar      1  along the camera's forward axis [m]
  normal3      3  of the cross-section, in the camera's right, up, forward
  light        6  direct, then indirect: R, G, B each
  cryptomatte 24  six ranks of objects, then of materials: id and coverage each
  ghost        4  bodies beside the slice: R, G, B, A)")
        .def_static("read", &Picture::read, arg("path"), R"(read(path)
--

Reads an OpenEXR image that tesserae has written.
)")
        .def_property_readonly("width", &Picture::width, "[pixels]")
        .def_property_readonly("height", &Picture::height, "[pixels]")
        .def_property_readonly("left", &Picture::left,
                               "Where it is in the full frame, 0 but for a crop [pixels].")
        .def_property_readonly("top", &Picture::top, "As left, from the top [pixels].")
        .def_property_readonly(
            "layers", [](const Picture& self) { return py::tuple(py::cast(self.layers())); },
            "The names of its layers.")
        .def_property_readonly("warnings", &Picture::warnings,
                               "A line for each thing that is wrong with the pixels.")
        .def("__getitem__", &layer_of, arg("layer"))
        .def(
            "__contains__",
            [](const Picture& self, const std::string& layer) { return self.has(layer); },
            arg("layer"))
        .def(
            "channels",
            [](const Picture& self, const std::string& layer) {
                return py::tuple(py::cast(self.channels(layer)));
            },
            arg("layer"), R"(channels(self, layer)
--

Returns the names of a layer's channels in OpenEXR files, such as "albedo.R".
)")
        .def("write_image", &Picture::write_image, arg("path"), R"(write_image(self, path)
--

Writes an OpenEXR file.
)")
        .def("write_preview", &Picture::write_preview, arg("path"), R"(write_preview(self, path)
--

Writes a PNG file for the eye, in sRGB.
)")
        .def("__repr__", &text_of)
        .def("_repr_png_", &preview_of);
}

}  // namespace tesserae::python

# SPDX-License-Identifier: Apache-2.0
"""A frame of `tesserae export --format ply` in Blender: an object a body, with its name, its object id as
pass index and custom property, and the camera of camera.json, with keys for the whole film.

    blender --python scenes/export/in_blender.py -- DIR/NAME.0000.ply
"""

import json
import math
import pathlib
import re
import struct
import sys

import bpy
import mathutils


def read_ply(file):
    """Vertices, and of every body its polygons and name."""
    data = file.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode("ascii")
    count = {what: int(number) for what, number in re.findall(r"^element (\w+) (\d+)$", header, re.M)}
    names = {}
    for first, last, name in re.findall(r'^comment body (\d+)(?:-(\d+))? (".*")$', header, re.M):
        ids = range(int(first), int(last or first) + 1)
        for place, body in enumerate(ids):
            names[body] = json.loads(name) + (f".{place}" if len(ids) > 1 else "")
    vertices = list(struct.iter_unpack("<3fI", data[end:end + 16 * count["vertex"]]))
    polygons = {}
    at = end + 16 * count["vertex"]
    for _ in range(count["face"]):
        corners = data[at]
        *polygon, body = struct.unpack_from(f"<{corners}iI", data, at + 1)
        at += 1 + 4 * corners + 4
        polygons.setdefault(body, []).append(polygon)
    return vertices, polygons, names


def add_bodies(file):
    vertices, polygons, names = read_ply(file)
    for body, faces in polygons.items():
        used = sorted({corner for face in faces for corner in face})
        place = {corner: i for i, corner in enumerate(used)}
        mesh = bpy.data.meshes.new(names[body])
        mesh.from_pydata([vertices[corner][:3] for corner in used], [],
                         [[place[corner] for corner in face] for face in faces])
        thing = bpy.data.objects.new(names[body], mesh)
        thing.pass_index = body
        thing["body"] = body
        bpy.context.scene.collection.objects.link(thing)


def add_camera(path, frame):
    scene = bpy.context.scene
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.clip_start, camera.clip_end = 1e-3, 1e7
    thing = bpy.data.objects.new("camera", camera)
    scene.collection.objects.link(thing)
    scene.camera = thing
    scene.render.resolution_x, scene.render.resolution_y = path["size"]
    scene.render.resolution_percentage = 100
    for at in path["frames"]:
        # A camera of Blender looks along its -z.
        right, up, forward = (mathutils.Vector(at[axis]) for axis in ("right", "up", "forward"))
        turn = mathutils.Matrix((right, up, -forward)).transposed()
        thing.matrix_world = mathutils.Matrix.Translation(at["position"]) @ turn.to_4x4()
        camera.angle_y = math.radians(at["field_of_view"])
        for key in ("location", "rotation_euler"):
            thing.keyframe_insert(key, frame=at["frame"])
        camera.keyframe_insert("lens", frame=at["frame"])
    scene.frame_start, scene.frame_end = 0, len(path["frames"]) - 1
    scene.frame_set(frame)


def main(file):
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    add_bodies(file)
    frame = int(re.search(rb"^comment scene .*, frame (\d+), time", file.read_bytes(), re.M)[1])
    add_camera(json.loads((file.parent / "camera.json").read_text()), frame)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[sys.argv.index("--") + 1]))

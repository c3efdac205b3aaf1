# SPDX-License-Identifier: Apache-2.0
"""The still in Blender's Cycles. Our (x, y, z) is Blender's (x, z, y), which has z up."""

import math

import bpy
import mathutils

import still

FLOOR_HALF_SIDE = 200  # [m]; ours has no end


def to_blender(v):
    return mathutils.Vector((v[0], v[2], v[1]))


def material_of(color):
    material = bpy.data.materials.new("diffuse")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*color, 1)
    output = nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    return material


def add(scene, name, data):
    thing = bpy.data.objects.new(name, data)
    scene.collection.objects.link(thing)
    return thing


def add_points(scene, balls, material):
    """A point cloud, of which Cycles draws true spheres: a mesh of vertices made into points."""
    mesh = bpy.data.meshes.new("centres")
    mesh.from_pydata([to_blender(b) for b in balls], [], [])
    radii = mesh.attributes.new("ball_radius", "FLOAT", "POINT")
    radii.data.foreach_set("value", [b.radius for b in balls])
    tree = bpy.data.node_groups.new("points", "GeometryNodeTree")
    tree.inputs.new("NodeSocketGeometry", "Geometry")
    tree.outputs.new("NodeSocketGeometry", "Geometry")
    begin, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    radius = tree.nodes.new("GeometryNodeInputNamedAttribute")
    radius.data_type = "FLOAT"
    radius.inputs["Name"].default_value = "ball_radius"
    points = tree.nodes.new("GeometryNodeMeshToPoints")
    paint = tree.nodes.new("GeometryNodeSetMaterial")
    paint.inputs["Material"].default_value = material
    tree.links.new(begin.outputs[0], points.inputs["Mesh"])
    tree.links.new(next(o for o in radius.outputs if o.type == "VALUE" and o.enabled),
                   points.inputs["Radius"])
    tree.links.new(points.outputs[0], paint.inputs["Geometry"])
    tree.links.new(paint.outputs[0], end.inputs[0])
    add(scene, "balls", mesh).modifiers.new("points", "NODES").node_group = tree


def add_meshes(scene, balls, material, subdivisions):
    """The same balls as smooth icospheres, all in one mesh."""
    import bmesh
    whole = bmesh.new()
    for ball in balls:
        place = mathutils.Matrix.Translation(to_blender(ball))
        bmesh.ops.create_icosphere(whole, subdivisions=subdivisions, radius=ball.radius,
                                   matrix=place)
    for face in whole.faces:
        face.smooth = True
    mesh = bpy.data.meshes.new("balls")
    whole.to_mesh(mesh)
    whole.free()
    mesh.materials.append(material)
    add(scene, "balls", mesh)


def add_lights(scene, sky_method):
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy = still.SUN_IRRADIANCE
    sun.angle = 2 * math.radians(still.SUN_HALF_ANGLE)
    direction = to_blender(still.SUN_DIRECTION)
    add(scene, "sun", sun).rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (*still.SKY, 1)
    scene.world.cycles.sampling_method = sky_method


def add_camera(scene):
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle = math.radians(still.FIELD_OF_VIEW)
    thing = add(scene, "camera", camera)
    thing.location = to_blender(still.POSITION)
    toward = to_blender(still.LOOK_AT) - thing.location
    thing.rotation_euler = toward.to_track_quat("-Z", "Y").to_euler()
    scene.camera = thing


def build(balls_as="points", sky_method="AUTOMATIC", pattern="PROGRESSIVE_MULTI_JITTER"):
    """An empty file with the still, and Cycles set to do what ours does and no more."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    for i, albedo in enumerate(still.ALBEDOS):
        of_material = [b for b in still.balls() if b.material == i]
        if balls_as == "points":
            add_points(scene, of_material, material_of(albedo))
        else:
            add_meshes(scene, of_material, material_of(albedo), subdivisions=4)
    floor = bpy.data.meshes.new("floor")
    s = FLOOR_HALF_SIDE
    floor.from_pydata([(-s, -s, 0), (s, -s, 0), (s, s, 0), (-s, s, 0)], [], [(0, 1, 2, 3)])
    floor.materials.append(material_of(still.FLOOR))
    add(scene, "floor", floor)
    add_lights(scene, sky_method)
    add_camera(scene)

    scene.render.engine = "CYCLES"
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.use_compositing = scene.render.use_sequencer = False
    c = scene.cycles
    c.device = "CPU"
    c.use_adaptive_sampling = c.use_denoising = c.use_auto_tile = False
    c.sampling_pattern = pattern
    c.pixel_filter_type, c.filter_width = "BOX", 1
    c.max_bounces = c.diffuse_bounces = still.BOUNCES
    c.sample_clamp_direct = c.sample_clamp_indirect = 0
    c.blur_glossy = 0
    return scene


def set_job(scene, width, height, samples, seed, threads=1):
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.threads = threads
    scene.cycles.samples, scene.cycles.seed = samples, seed

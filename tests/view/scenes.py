# SPDX-License-Identifier: Apache-2.0
"""Scenes by which pages are held against the renderer."""

LIGHT = """
[[light]]
type = "sun"
direction = [0.4, -1, 0.5, 0.2]
strength = 4
[[light]]
type = "sky"
strength = 0.3
[[material]]
name = "tiles"
pattern = "checker"
albedo_variation = 0.5
"""

SHAPES = {
    "hypersphere": "radius = 0.7",
    "hypercapsule": "radius = 0.4\nheight = 1.1",
    "hyperbox": "size = [1.1, 0.8, 1.3, 0.9]",
    "5-cell": 'shape = "polychoron"\nregular = "5-cell"\nradius = 1.1',
    "8-cell": 'shape = "polychoron"\nregular = "8-cell"\nradius = 0.9',
    "16-cell": 'shape = "polychoron"\nregular = "16-cell"\nradius = 0.9',
    "24-cell": 'shape = "polychoron"\nregular = "24-cell"\nradius = 0.9',
    "600-cell": 'shape = "polychoron"\nregular = "600-cell"\nradius = 0.8',
    "duoprism": "polygons = [5, 7]\nradii = [0.6, 0.7]",
    "spherinder": "radius = 0.6\nheight = 0.9",
    "cubinder": "radius = 0.6\nsize = [0.8, 1.0]",
    "duocylinder": "radii = [0.5, 0.7]",
}


def body(name, text, position, rotation):
    """One [[body]]; `text` names its shape unless the name does."""
    shape = "" if "shape =" in text else f'shape = "{name}"\n'
    turns = ", ".join(f"{plane} = {angle}" for plane, angle in rotation.items())
    return (f'[[body]]\nname = "{name}"\n{shape}{text}\nmaterial = "tiles"\n'
            f"position = {list(position)}\nrotation = {{ {turns} }}\n")


def camera(position, look_at, more=""):
    return f"[camera]\nposition = {list(position)}\nlook_at = {list(look_at)}\n{more}\n"


def all_shapes(origin=(0, 0, 0, 0), more=""):
    """Every shape on a plane, in rows, each turned its own way and off the slice by its own bit."""
    def at(*offset):
        return [a + b for a, b in zip(origin, offset)]
    text = camera(at(0, 3.2, -7.5, 0), at(0, 0.3, 0.6, 0), more) + LIGHT
    text += (f'[[body]]\nname = "floor"\nshape = "hyperplane"\nnormal = [0, 1, 0.02, 0.1]\n'
             f"offset = {plane_offset(at(0, -1.2, 0, 0), (0, 1, 0.02, 0.1))}\n")
    for i, (name, shape) in enumerate(SHAPES.items()):
        place = at(2.1 * (i % 4 - 1.5), 0.0, 2.1 * (i // 4), 0.11 * (i % 3 - 1))
        turn = {"xy": 20 + 13 * i, "xw": 10 + 7 * i, "yz": 5 * i, "zw": 30 - 4 * i}
        text += body(name, shape, place, turn)
    return text


PATTERNS = ["noise", "grid", "edges", "cells", "w", "stripes"]


def patterns(more=""):
    """Every pattern on several shapes; hues that differ from body to body."""
    text = camera((0, 3.2, -7.5, 0.2), (0, 0.3, 0.6, 0), TURNED) + LIGHT
    for pattern in PATTERNS:
        text += (f'[[material]]\nname = "{pattern}"\npattern = "{pattern}"\nline_width = 0.15\n'
                 f'albedo = [0.9, 0.5, 0.3]\nw_of = "{"body" if more else "point"}"\n')
    for i, (name, shape) in enumerate(SHAPES.items()):
        turn = {"xy": 20 + 13 * i, "xw": 10 + 7 * i, "yz": 5 * i, "zw": 30 - 4 * i}
        place = (2.1 * (i % 4 - 1.5), 0, 2.1 * (i // 4), 0.11 * (i % 3 - 1))
        text += (body(name, shape, place, turn).replace('"tiles"', f'"{PATTERNS[i % 6]}"') +
                 ("hue_jitter = 0.5\n" if i % 2 else ""))
    return text


def ghosts():
    """Every shape beside the slice, near and far."""
    text = camera((0, 3.2, -7.5, 0), (0, 0.3, 0.6, 0)) + LIGHT
    text += "[render]\nghost_depth = 2.5\nghosts = \"over\"\nghost_plus = [0.9, 0.7, 0.1]\n"
    for i, (name, shape) in enumerate(SHAPES.items()):
        turn = {"xy": 20 + 13 * i, "xw": 10 + 7 * i, "yz": 5 * i, "zw": 30 - 4 * i}
        place = (1.7 * (i % 4 - 1.5), 0, 1.5 * (i // 4), (0.9 + 0.15 * i) * (-1) ** i)
        text += body(name, shape, place, turn)
    return text


def plane_offset(point, normal):
    length = sum(n * n for n in normal) ** 0.5
    return sum(p * n for p, n in zip(point, normal)) / length


def one_120_cell():
    text = camera((0, 0.9, -2.6, 0), (0, 0, 0, 0)) + LIGHT
    return text + body("120-cell", 'shape = "polychoron"\nregular = "120-cell"\nradius = 1',
                       (0, 0, 0, 0.1), {"xw": 20, "yz": 33})


# The slice turned out of w, so that all of its axes have a part of all others.
TURNED = "fourth = [0.3, -0.2, 0.15, 0.9]\nup = [0.1, 1, 0, 0.2]\nfield_of_view = 47"
FAR = (1000.0, -1000.0, 1000.0, 1000.0)

HOSTILE = "</script><script>window.hit = 1</script><img src=x onerror='window.hit=1'>\n[camera]"


def hostile():
    """A ball whose name would be markup, a script and TOML if it were not text."""
    name = HOSTILE.replace("\n", "\\n")
    return (camera((0, 0, -5, 0), (0, 0, 0, 0)) + LIGHT +
            f'[[body]]\nname = "{name}"\nshape = "hypersphere"\nradius = 1\n')


def crossing():
    """A ball of radius 1 that goes through the slice along w: in it from 1 s to 3 s. A moving
    camera."""
    return """
[physics]
duration = 4
gravity = [0, 0, 0, 0]
[render]
frames_per_second = 10
[camera]
look_at = [0, 0, 0, 0]
[[camera.key]]
time = 0
position = [0, 1, -6, 0]
[[camera.key]]
time = 4
position = [4, 2, -4, 0]
""" + LIGHT + """
[[body]]
name = "crosser"
shape = "hypersphere"
radius = 1
position = [0, 0, 0, -2]
velocity = [0, 0, 0, 1]
[[body]]
name = "stays"
shape = "hyperbox"
size = [1, 1, 1, 1]
position = [2.7, 0, 0, 0]
angular_velocity = { xw = 1, yz = 2 }
"""


def jointed():
    """Joints of all sorts of ends: a door on a hinge, a box on a swivel that turns fast, a spring
    from a ball to a box beside the slice, and a weight whose thread breaks at once."""
    return """
[physics]
duration = 2
[render]
frames_per_second = 10
[camera]
position = [0, 0, -8, 0]
look_at = [0, 0, 0, 0]
""" + LIGHT + """
[[body]]
name = "door"
shape = "hyperbox"
size = [1, 0.1, 0.4, 0.4]
position = [-2, 1, 0, 0]
[[body]]
name = "spinner"
shape = "hypersphere"
radius = 0.3
position = [0, 1, 0, 0]
angular_velocity = { xy = 3 }
[[body]]
name = "nail"
shape = "hypersphere"
radius = 0.2
position = [1.5, 1.5, 0, 0]
fixed = ["position", "rotation"]
[[body]]
name = "beside"
shape = "hyperbox"
size = [0.5, 0.5, 0.5, 0.5]
position = [2.5, 0, 0, 0.8]
[[body]]
name = "weight"
shape = "hypersphere"
radius = 0.2
position = [-3, 1, 0, 0]
[[joint]]
name = "hinge"
type = "hinge"
a = "door"
anchor = [-2.5, 1, 0, 0]
plane = "xy"
[[joint]]
name = "arm"
type = "point"
a = "spinner"
anchor = [-0.5, 1.5, 0, 0]
[[joint]]
name = "spring"
type = "spring"
a = "nail"
b = "beside"
anchor_b = [2.5, 0.25, 0, 0.8]
frequency = 1
damping = 0.1
[[joint]]
name = "thread"
type = "rope"
a = "weight"
anchor_a = [-3, 1, 0, 0]
anchor_b = [-3, 1.5, 0, 0]
length = 0.8
break = { force = 1 }
"""

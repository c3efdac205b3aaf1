"use strict";
// The scene's shapes and materials as textures of four floats a texel; shapes.glsl reads them.

const kKinds = {sphere: 0, capsule: 1, box: 2, plane: 3, hull: 4, product: 5};
const kPatterns = {none: 0, checker: 1, stripes: 2, noise: 3, grid: 4, edges: 5, cells: 6, w: 7};

/// Two texels a type: (kind, radius of the ball that holds it, first, count), (material, 0, 0, 0);
/// then `count` texels at `first` that say the rest. A hull's half-spaces are n . x <= 1.
function formTexels(scene) {
  const texels = [], more = [], base = 2 * scene.types.length;
  const add = (...four) => more.push([...four, 0, 0, 0].slice(0, 4));
  const hullAt = scene.hulls.map((hull) => {
    const first = base + more.length;
    for (const [x, y, z, w, offset] of hull.planes) add(x / offset, y / offset, z / offset, w / offset);
    return first;
  });
  for (const type of scene.types) {
    let first = base + more.length, count = 1;
    if (type.kind === "capsule") add(type.radius, type.half);
    if (type.kind === "box") add(...type.half);
    if (type.kind === "plane") add(...type.normal);
    if (type.kind === "hull") [first, count] = [hullAt[type.hull], scene.hulls[type.hull].planes.length];
    if (type.kind === "product") {
      count = type.axes.length;
      type.axes.forEach((axes, i) => (add(...axes), add(type.radii[i])));
    }
    texels.push([kKinds[type.kind], type.bound || 0, first, count], [type.material, 0, 0, 0]);
  }
  return texels.concat(more);
}

function materialTexels(scene) {
  return scene.materials.flatMap((m) => [
    [...m.albedo, 0], [...m.pattern_albedo, kPatterns[m.pattern]], [...m.emission, m.pattern_size],
    [m.line_width, m.w_of === "body" ? 1 : 0, 0, 0]]);
}

/// What each body of the page's albedo is multiplied by, and how far its hue is turned.
function tintTexels(scene, poses) {
  const bytes = bytesOfBase64(scene.tints);
  return Array.from(poses.id, (id) => {
    const [red, green, blue, turn] = bytes.subarray(4 * id, 4 * id + 4);
    return [red / 255, green / 255, blue / 255, turn / 256];
  });
}

/// The most of |direction . x| over a type's shape, for a direction in its own frame at f[at], ...
function halfExtent(scene, type, f, at) {
  const [x, y, z, w] = [f[at], f[at + 1], f[at + 2], f[at + 3]];
  if (type.kind === "sphere") return type.bound;
  if (type.kind === "capsule") return type.radius + type.half * Math.abs(y);
  if (type.kind === "box")
    return type.half[0] * Math.abs(x) + type.half[1] * Math.abs(y) + type.half[2] * Math.abs(z) +
           type.half[3] * Math.abs(w);
  if (type.kind === "product") {
    let sum = 0;
    type.axes.forEach((a, i) => (sum += type.radii[i] * Math.hypot(a[0] * x, a[1] * y, a[2] * z, a[3] * w)));
    return sum;
  }
  return Infinity;
}

/// How far a bounded type's shape reaches from its centre along a direction in its own frame at
/// f[at], ...: the least and the most.
function extentAlong(scene, type, f, at) {
  if (type.kind !== "hull") {
    const half = halfExtent(scene, type, f, at);
    return [-half, half];
  }
  let low = Infinity, high = -Infinity;
  for (const v of scene.hulls[type.hull].vertices) {
    const along = v[0] * f[at] + v[1] * f[at + 1] + v[2] * f[at + 2] + v[3] * f[at + 3];
    low = Math.min(low, along), high = Math.max(high, along);
  }
  return [low, high];
}

/// Whether a slice at distance `offset` along the direction meets the shape.
function isCut(scene, type, f, at, offset) {
  if (type.kind === "plane") return true;
  if (Math.abs(offset) > type.bound) return false;
  const [low, high] = extentAlong(scene, type, f, at);
  return low <= offset && offset <= high;
}

"use strict";
// The bodies about a camera, for one picture: what shapes.glsl reads of them, which of them the
// slice meets, and where on the film they may be seen.

const kTexels = 6;          // a body, of four floats
const kBodiesARow = 256;    // of the texture
const kSolid = 1, kGhost = 2;

class PlacedBodies {
  constructor(scene, poses) {
    const count = poses.count;
    this.scene = scene;
    this.poses = poses;
    this.count = count;
    this.rows = Math.max(1, Math.ceil(count / kBodiesARow));
    this.texels = new Float32Array(4 * kTexels * kBodiesARow * this.rows);
    this.state = new Uint8Array(count);         // 0: neither
    this.centre = new Float64Array(3 * count);  // right, up, forward of what is seen [m]
    this.radius = new Float64Array(count);      // of the ball about it that holds what is seen [m]
    this.nearest = new Float64Array(count);     // how near a view ray may meet it [m]
    this.offset = new Float64Array(count);      // of the centre along the fourth axis [m]
    this.order = [];                            // of those seen: by state, then by `nearest`
  }

  /// @param camera       as View.shown()
  /// @param ghostDepth   ghosts are bodies that the slice misses by less than this [m]; 0: none
  place(camera, ghostDepth, maxDistance) {
    const {scene, poses} = this;
    this.order = [];
    for (let body = 0; body < this.count; ++body) {
      const type = scene.types[poses.type[body]];
      if (type.kind === "plane") this.placePlane(body, type, camera);
      else this.placeBounded(body, type, camera, ghostDepth, maxDistance);
      if (this.state[body] !== 0) this.order.push(body);
    }
    const {state, nearest} = this;
    this.order.sort((a, b) => state[a] - state[b] || nearest[a] - nearest[b] || a - b);
  }

  placeBounded(body, type, camera, ghostDepth, maxDistance) {
    const {poses, texels} = this, {position, turn} = poses, o = camera.position;
    const at = 4 * kTexels * body, p = 4 * body, q = 8 * body;
    const x = position[p] - o[0], y = position[p + 1] - o[1];
    const z = position[p + 2] - o[2], w = position[p + 3] - o[3];
    const axes = [camera.right, camera.up, camera.forward, camera.fourth];
    for (let i = 0; i < 4; ++i)
      turnBack(turn, q, axes[i][0], axes[i][1], axes[i][2], axes[i][3], texels, at + 4 * i);
    turnBack(turn, q, -x, -y, -z, -w, texels, at + 16);

    const seen = (a) => a[0] * x + a[1] * y + a[2] * z + a[3] * w;
    const offset = seen(camera.fourth);
    this.offset[body] = offset;
    this.state[body] = 0;
    if (Math.abs(offset) > type.bound + ghostDepth) return;
    const [low, high] = extentAlong(this.scene, type, texels, at + 12);
    const gap = Math.max(offset + low, -(offset + high)), isSolid = gap <= 0;
    if (!isSolid && gap >= ghostDepth) return;
    // A ghost is cut by the slice through its centre, or as near to it as the depth allows.
    const shift = isSolid ? 0 : clamp(offset, -ghostDepth, ghostDepth), off = offset - shift;
    texels[at + 20] = poses.type[body];
    texels[at + 21] = shift;
    texels[at + 23] = isSolid ? 1 : 1 - gap / ghostDepth;

    const radius = Math.sqrt(type.bound * type.bound - off * off);
    const right = seen(camera.right), up = seen(camera.up), forward = seen(camera.forward);
    const nearest = Math.max(0, Math.hypot(right, up, forward) - radius);
    if (forward + radius < 0 || nearest > maxDistance) return;
    this.centre.set([right, up, forward], 3 * body);
    // Rounding to floats must not cut off a rim.
    this.radius[body] = radius * (1 + 1e-6);
    this.nearest[body] = nearest * (1 - 1e-6);
    this.state[body] = isSolid ? kSolid : kGhost;
  }

  /// A plane's own frame is the world. Its pattern is so large that the world's origin may be far:
  /// the start of rays is taken modulo two cells.
  placePlane(body, type, camera) {
    const {texels} = this, at = 4 * kTexels * body, o = camera.position;
    [camera.right, camera.up, camera.forward, camera.fourth].forEach((a, i) => texels.set(a, at + 4 * i));
    const period = 2 * this.scene.materials[type.material].pattern_size;
    const start = along(o, -type.offset, type.normal).map((v) => v - period * Math.floor(v / period));
    texels.set(start, at + 16);
    texels.set([this.poses.type[body], 0, dot(type.normal, o) - type.offset, 1], at + 20);
    this.state[body] = kSolid;
    this.nearest[body] = 0;
    this.radius[body] = Infinity;
    this.offset[body] = 0;
  }

  /// The rectangle of the film that holds a body: [x0, x1, y0, y1], by slopes x/z and y/z.
  slopes(body) {
    const r = this.radius[body];
    if (r === Infinity) return [-Infinity, Infinity, -Infinity, Infinity];
    const [x, y, z] = this.centre.subarray(3 * body, 3 * body + 3);
    return [...slopeRange(x, z, r), ...slopeRange(y, z, r)];
  }
}

/// The slopes a/z of all points in front of the camera in a disc about (a, z).
function slopeRange(a, z, radius) {
  const away = Math.hypot(a, z);
  if (away <= radius) return [-Infinity, Infinity];
  const middle = Math.atan2(a, z), half = Math.asin(radius / away);
  const low = middle - half, high = middle + half;
  return [low <= -Math.PI / 2 ? -Infinity : Math.tan(low), high >= Math.PI / 2 ? Infinity : Math.tan(high)];
}

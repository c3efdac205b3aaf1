"use strict";
// Which bodies may stand between a point and a sun. Along the sun's light only the three directions
// across it matter: in them every body is a ball, and a grid of cells lists the balls that touch
// each. It depends on the bodies only, not on the camera.

const kMostCells = 48;         // along a direction
const kManyCells = 1500;       // a body that touches more is tested everywhere
const kMostSuns = 4;

class SunGrids {
  constructor(scene, poses) {
    this.scene = scene;
    this.poses = poses;
    const brightness = (sun) => Math.max(...sun.irradiance);
    this.suns = [...scene.lights.suns].sort((a, b) => brightness(b) - brightness(a)).slice(0, kMostSuns);
    this.frames = this.suns.map((sun) => {
      const across = [];
      for (const axis of [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {
        const part = across.length < 3 && orthogonalPart(axis, sun.toward, ...across);
        if (part) across.push(part);
      }
      return across;
    });
  }

  /// Grids for the bodies as they stand now.
  build() {
    const {position} = this.poses, count = this.poses.count;
    this.reference = count > 0 ? Array.from(position.subarray(0, 4)) : [0, 0, 0, 0];
    this.words = [];
    this.grids = this.frames.map((across) => this.gridAcross(across));
    const words = new Uint32Array(Math.max(1, this.words.reduce((sum, w) => sum + w.length, 0)));
    let at = 0;
    for (const part of this.words) words.set(part, at), (at += part.length);
    this.words = words;
  }

  gridAcross(across) {
    const {poses, scene} = this, count = poses.count, bound = new Float64Array(count);
    const place = new Float64Array(3 * count), low = [1e300, 1e300, 1e300], high = [-1e300, -1e300, -1e300];
    const bounds = [], planes = [];
    for (let body = 0; body < count; ++body) {
      const type = scene.types[poses.type[body]];
      bound[body] = type.kind === "plane" ? Infinity : type.bound * (1 + 1e-5);
      if (type.kind === "plane") planes.push(body);
      else bounds.push(type.bound);
      for (let i = 0; i < 3; ++i) {
        let sum = 0;
        for (let k = 0; k < 4; ++k) sum += across[i][k] * (poses.position[4 * body + k] - this.reference[k]);
        place[3 * body + i] = sum;
      }
    }
    bounds.sort((a, b) => a - b);
    const median = bounds.length > 0 ? bounds[bounds.length >> 1] : 1;
    // Huge bodies do not stretch the grid over empty space: they are tested everywhere.
    for (let body = 0; body < count; ++body)
      if (bound[body] <= 8 * median)
        for (let i = 0; i < 3; ++i) {
          low[i] = Math.min(low[i], place[3 * body + i] - bound[body]);
          high[i] = Math.max(high[i], place[3 * body + i] + bound[body]);
        }
    if (!(low[0] <= high[0])) low.fill(0), high.fill(1);
    const widest = Math.max(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    const cell = Math.max(2 * median, widest / kMostCells, 1e-9);
    const size = low.map((l, i) => Math.max(1, Math.ceil((high[i] - l) / cell)));
    return {across, low, cell, size, ...this.fill(place, bound, low, cell, size)};
  }

  /// @return where in the words the cells and the large bodies begin
  fill(place, bound, low, cell, size) {
    const cells = size[0] * size[1] * size[2], counts = new Uint32Array(cells + 1), large = [], small = [];
    const range = (body) => [0, 1, 2].map((i) => {
      const middle = place[3 * body + i] - low[i];
      return [clamp(Math.floor((middle - bound[body]) / cell), 0, size[i]),
              clamp(Math.floor((middle + bound[body]) / cell), -1, size[i] - 1)];
    });
    for (let body = 0; body < bound.length; ++body) {
      const r = bound[body] === Infinity ? null : range(body);
      const touched = r ? r.reduce((product, [a, b]) => product * (b - a + 1), 1) : Infinity;
      if (touched > kManyCells) large.push(body);
      else small.push([body, r]);
    }
    const visit = (use) => {
      for (const [body, [xs, ys, zs]] of small)
        for (let z = zs[0]; z <= zs[1]; ++z)
          for (let y = ys[0]; y <= ys[1]; ++y)
            for (let x = xs[0]; x <= xs[1]; ++x) use(x + size[0] * (y + size[1] * z), body);
    };
    visit((at) => ++counts[at]);
    const before = this.words.reduce((sum, w) => sum + w.length, 0);
    const starts = new Uint32Array(cells + 1);
    let entries = before + cells + 1;
    for (let at = 0; at < cells; ++at) (starts[at] = entries), (entries += counts[at]);
    starts[cells] = entries;
    const next = starts.slice(), listed = new Uint32Array(entries - before - cells - 1);
    visit((at, body) => (listed[next[at]++ - before - cells - 1] = body));
    this.words.push(starts, listed, Uint32Array.from(large));
    return {firstCell: before, firstLarge: entries, large: large.length};
  }
}

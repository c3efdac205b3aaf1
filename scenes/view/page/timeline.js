"use strict";
// When each named body is in the slice: a row a name, darker where only some of its bodies are.

const kRowHeight = 17;   // [CSS pixels]
const kLabelWidth = 150;
const kSlot = 6;         // worked on at a time [ms]

class Timeline {
  constructor(canvas, scene, poses) {
    this.canvas = canvas;
    this.scene = scene;
    this.poses = poses;
    const names = scene.names.map(([name, first, count]) => ({name, first, count, bodies: []}));
    let at = 0;
    for (let body = 0; body < poses.count; ++body) {
      while (poses.id[body] >= names[at].first + names[at].count) ++at;
      if (scene.types[poses.type[body]].kind !== "plane") names[at].bodies.push(body);
    }
    this.rows = names.filter((row) => row.bodies.length > 0);
    this.parts = this.rows.map(() => new Float32Array(scene.times.length));
    this.done = 0;
    this.slice = null;
  }

  /// @param sliceAt   the slice at a moment: {position, fourth}
  /// @param key       changes when the slices do
  follow(sliceAt, key) {
    if (this.slice === key) return;
    this.slice = key;
    this.sliceAt = sliceAt;
    this.done = 0;
  }

  get height() {
    return kRowHeight * this.rows.length;
  }

  /// Goes on finding out for a short time. True when there was something to do.
  work() {
    const {scene, poses} = this, moments = scene.times.length, end = performance.now() + kSlot;
    if (this.done === moments) return false;
    for (; this.done < moments && performance.now() < end; ++this.done) {
      const slice = this.sliceAt(this.done), numbers = new Float64Array(12), fourth = new Float64Array(4);
      this.rows.forEach((row, i) => {
        let cut = 0;
        for (const body of row.bodies) cut += this.isCut(body, this.done, slice, numbers, fourth) ? 1 : 0;
        this.parts[i][this.done] = cut / row.bodies.length;
      });
    }
    return true;
  }

  isCut(body, moment, {position, fourth}, numbers, turned) {
    const {scene, poses} = this, type = scene.types[poses.type[body]];
    poses.read(body, moment, type.kind === "sphere" ? 4 : 12, numbers, 0);
    let offset = 0;
    for (let i = 0; i < 4; ++i) offset += fourth[i] * (numbers[i] - position[i]);
    if (Math.abs(offset) > type.bound) return false;
    if (type.kind === "sphere") return true;
    turnBack(numbers, 4, ...fourth, turned, 0);
    return isCut(scene, type, turned, 0, -offset);
  }

  /// @param view   width, height [CSS pixels] and scrolled: how many pixels of rows are above
  draw({width, height, scrolled, ratio}, time, chosenId) {
    const {canvas, scene, rows} = this, pen = canvas.getContext("2d");
    canvas.width = Math.round(width * ratio), canvas.height = Math.max(1, Math.round(height * ratio));
    canvas.style.width = `${width}px`, canvas.style.height = `${height}px`;
    pen.scale(ratio, ratio);
    pen.font = "11px system-ui, sans-serif";
    pen.textBaseline = "middle";
    this.width = width;
    this.scrolled = scrolled;
    const first = Math.floor(scrolled / kRowHeight);
    for (let i = first; i < rows.length && i * kRowHeight < scrolled + height; ++i) {
      const row = rows[i], isChosen = chosenId >= row.first && chosenId < row.first + row.count;
      this.drawRow(pen, i, i * kRowHeight - scrolled, isChosen);
    }
    pen.fillStyle = "#fff";
    pen.fillRect(this.x(time) - 0.5, 0, 1.5, height);
  }

  drawRow(pen, i, y, isChosen) {
    const {times} = this.scene, row = this.rows[i], step = this.x(times[1]) - this.x(times[0]) || this.width;
    pen.fillStyle = isChosen ? "#3a3026" : i % 2 ? "#262629" : "#232326";
    pen.fillRect(0, y, this.width, kRowHeight);
    pen.fillStyle = isChosen ? "#ff9a4d" : "#b9b9be";
    const label = row.count > 1 ? `${row.name} (${row.bodies.length})` : row.name;
    pen.fillText(label, 10, y + kRowHeight / 2, kLabelWidth - 16);
    pen.fillStyle = isChosen ? "#ff8a33" : "#4b8fe2";
    for (let k = 0; k < this.done; ++k) {
      if (this.parts[i][k] === 0) continue;
      pen.globalAlpha = 0.25 + 0.75 * this.parts[i][k];
      const from = Math.round(this.x(times[k])), to = Math.round(this.x(times[k]) + step);
      pen.fillRect(from, y + 4, Math.max(1, to - from), kRowHeight - 8);
    }
    pen.globalAlpha = 1;
  }

  x(time) {
    const {times} = this.scene, span = times[times.length - 1] - times[0];
    return span > 0 ? kLabelWidth + ((time - times[0]) / span) * (this.width - kLabelWidth - 14) : kLabelWidth;
  }

  timeAt(x) {
    const {times} = this.scene, span = times[times.length - 1] - times[0];
    return times[0] + clamp((x - kLabelWidth) / (this.width - kLabelWidth - 14), 0, 1) * span;
  }

  /// The row at a height of the canvas, if there is one.
  rowAt(y) {
    return this.rows[Math.floor((y + this.scrolled) / kRowHeight)];
  }
}

"use strict";
// Joints as lines over the picture: from one body's centre to where the joint is on it, to where it
// is on the other body, and on to that one's centre. Each body's part is shown as the body is: in
// full where the slice meets it, in a ghost's colour and as pale, or not at all. Reads what
// page_joints.hpp describes.

const kAtWorld = 0xffffffff, kNotInPage = 0xfffffffe;
const kJointColor = "#6ff2b0", kChosenJointColor = "#ff5200", kJointEdge = "#000a";
const kFades = 8;             // how many shades ghosts' lines have
const kMostNames = 12;        // of joints told of a body
const kLeastLine = 0.5, kDot = 2;  // [CSS pixels]
const kManyLines = 3000;      // of more than these neither edges nor dots are drawn: it takes too long

// Styles: nothing, in full, of the chosen body, then the shades of ghosts on either side.
const kNoStyle = 0, kFull = 1, kOfChosen = 2, kFirstShade = 3;

class JointLines {
  constructor(page) {
    const {names, data} = page.scene.joints, bytes = bytesOfBase64(data).buffer, count = names.length;
    this.page = page;
    this.names = names;
    this.onA = new Float64Array(bytes, 0, 4 * count);
    this.onB = new Float32Array(bytes, 32 * count, 4 * count);
    this.a = new Uint32Array(bytes, 48 * count, count);
    this.b = new Uint32Array(bytes, 52 * count, count);
    this.brokenAt = new Uint32Array(bytes, 56 * count, count);
    this.styles = this.allStyles(page.scene.ghost_colors);
    byId("joints").addEventListener("change", () => page.changed());
  }

  /// Of each style its colour, and what is to be drawn in it: ends of lines and dots as x, y.
  allStyles(ghostColors) {
    const style = (color, alpha) => ({color, alpha, lines: [], dots: []});
    const styles = [style("", 0), style(kJointColor, 1), style(kChosenJointColor, 1)];
    const coded = (v) => 255 * clamp(v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055, 0, 1);
    for (const color of ghostColors)
      for (let fade = 1; fade <= kFades; ++fade)
        styles.push(style(`rgb(${color.map(coded).join()})`, fade / kFades));
    return styles;
  }

  /// The last moment that is not after the time shown.
  moment() {
    return this.page.poses.instant(this.page.time).first;
  }

  /// @param shown, layout   as Overlay.draw()
  draw(pen, shown, layout) {
    if (!byId("joints").checked) return;
    for (const style of this.styles) (style.lines = []), (style.dots = []);
    this.shown = shown;
    this.layout = layout;
    this.scale = layout.frame[3] / 2 / Math.tan((shown.fieldOfView * Math.PI) / 360);
    const moment = this.moment();
    for (let joint = 0; joint < this.names.length; ++joint)
      if (this.brokenAt[joint] > moment) this.addJoint(joint);
    const isFine = this.styles.reduce((sum, style) => sum + style.lines.length / 4, 0) <= kManyLines;
    // What is in the slice lies over ghosts.
    const [, full, chosen, ...shades] = this.styles;
    for (const style of [...shades, full, chosen]) this.drawStyle(pen, style, isFine);
    pen.globalAlpha = 1;
  }

  addJoint(joint) {
    const {chosen} = this.page.options, a = this.a[joint], b = this.b[joint], at = 4 * joint;
    const isChosen = chosen >= 0 && (a === chosen || b === chosen);
    const styleB = this.styleOf(b, isChosen), onB = this.pointOn(b, this.onB, at);
    if (a >= kNotInPage) {
      if (styleB === kNoStyle) return;
      this.addPart(styleB, this.centreOf(b), onB);
      if (a === kAtWorld) this.addPart(styleB, onB, this.projected(...this.onA.subarray(at, at + 4)));
      return;
    }
    const styleA = this.styleOf(a, isChosen);
    if (styleA === kNoStyle && styleB === kNoStyle) return;
    const onA = this.pointOn(a, this.onA, at);
    const middle = onA && onB && {x: (onA.x + onB.x) / 2, y: (onA.y + onB.y) / 2};
    for (const [style, body, on] of [[styleA, a, onA], [styleB, b, onB]]) {
      if (style === kNoStyle) continue;
      this.addPart(style, this.centreOf(body), on);
      this.addLine(style, on, middle);
    }
  }

  /// How a body's part of a joint is drawn: as the body is.
  styleOf(body, isChosen) {
    const {placed} = this.page.renderer, state = placed.state[body];
    if (state !== kSolid && state !== kGhost) return kNoStyle;
    if (isChosen) return kOfChosen;
    if (state === kSolid) return kFull;
    const at = 4 * kTexels * body, shift = placed.texels[at + 21], opacity = placed.texels[at + 23];
    return kFirstShade + (shift > 0 ? kFades : 0) + clamp(Math.ceil(kFades * opacity), 1, kFades) - 1;
  }

  centreOf(body) {
    const {position} = this.page.poses, p = 4 * body;
    return this.projected(position[p], position[p + 1], position[p + 2], position[p + 3]);
  }

  /// Where a point of a body is: `on` from its centre, in its axes.
  pointOn(body, on, at) {
    const {position, turn} = this.page.poses, p = 4 * body, q = 8 * body, v = JointLines.turned;
    // Both quaternions conjugated turn the other way round.
    const back = JointLines.back;
    for (let i = 0; i < 8; ++i) back[i] = i % 4 === 0 ? turn[q + i] : -turn[q + i];
    turnBack(back, 0, on[at], on[at + 1], on[at + 2], on[at + 3], v, 0);
    return this.projected(position[p] + v[0], position[p + 1] + v[1], position[p + 2] + v[2],
                          position[p + 3] + v[3]);
  }

  /// Where a point of the world is on the canvas, as Overlay.project() has it.
  projected(x, y, z, w) {
    const {right, up, forward, position} = this.shown, {width, height} = this.layout;
    x -= position[0], y -= position[1], z -= position[2], w -= position[3];
    const ahead = forward[0] * x + forward[1] * y + forward[2] * z + forward[3] * w;
    if (!(ahead >= 1e-3)) return null;
    const scale = this.scale / ahead;
    return {x: width / 2 + scale * (right[0] * x + right[1] * y + right[2] * z + right[3] * w),
            y: height / 2 - scale * (up[0] * x + up[1] * y + up[2] * z + up[3] * w)};
  }

  /// A line with a dot at its second end: a joint at a body's centre is a dot.
  addPart(style, from, on) {
    this.addLine(style, from, on);
    if (on && this.isInside(on, on)) this.styles[style].dots.push(on.x, on.y);
  }

  addLine(style, from, to) {
    if (!from || !to || !this.isInside(from, to)) return;
    if (Math.abs(from.x - to.x) + Math.abs(from.y - to.y) < kLeastLine) return;
    this.styles[style].lines.push(from.x, from.y, to.x, to.y);
  }

  /// Whether a line may be seen.
  isInside(a, b) {
    const {width, height} = this.layout;
    return Math.max(a.x, b.x) >= 0 && Math.min(a.x, b.x) <= width && Math.max(a.y, b.y) >= 0 &&
           Math.min(a.y, b.y) <= height;
  }

  /// @param isFine   with dark edges, which lie under all lines, and dots
  drawStyle(pen, {color, alpha, lines, dots}, isFine) {
    pen.globalAlpha = alpha;
    for (const [ink, grow] of isFine ? [[kJointEdge, 1], [color, 0]] : [[color, 0]]) {
      pen.strokeStyle = pen.fillStyle = ink;
      pen.lineWidth = 1.5 + 2 * grow;
      pen.beginPath();
      for (let i = 0; i < lines.length; i += 4) {
        pen.moveTo(lines[i], lines[i + 1]);
        pen.lineTo(lines[i + 2], lines[i + 3]);
      }
      pen.stroke();
      const size = 2 * (kDot + grow);
      for (let i = 0; isFine && i < dots.length; i += 2) pen.fillRect(dots[i] - size / 2, dots[i + 1] - size / 2, size, size);
    }
  }

  /// The names of a body's joints.
  textOf(body) {
    const own = [], moment = this.moment();
    for (let joint = 0; joint < this.names.length; ++joint)
      if (this.a[joint] === body || this.b[joint] === body) own.push(joint);
    const told = own.slice(0, kMostNames).map((j) => this.names[j] + (this.brokenAt[j] <= moment ? " (broken)" : ""));
    if (own.length > kMostNames) told.push(`${own.length - kMostNames} more`);
    return told.join(", ") || "none";
  }
}
JointLines.turned = new Float64Array(4);
JointLines.back = new Float64Array(8);

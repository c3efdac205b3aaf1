"use strict";
// What is drawn over the picture: the film's frame, its camera's path, the directions of the axes.

const kAxisColors = ["#e2555f", "#7fbf3f", "#4b8fe2", "#c07be0"];

class Overlay {
  constructor(canvas, scene) {
    this.canvas = canvas;
    this.scene = scene;
  }

  /// @param shown   the camera, as View.shown()
  /// @param layout  width, height [CSS pixels], ratio of device pixels, margin, frame: the film
  ///                frame's rectangle [x, y, width, height]
  draw(shown, layout, {showsFrame, showsPath, film, joints}) {
    const {canvas} = this, {width, height, ratio} = layout, pen = canvas.getContext("2d");
    canvas.width = Math.round(width * ratio), canvas.height = Math.round(height * ratio);
    canvas.style.width = `${width}px`, canvas.style.height = `${height}px`;
    pen.scale(ratio, ratio);
    this.shown = shown;
    this.layout = layout;
    if (joints) joints.draw(pen, shown, layout);
    if (showsFrame) this.drawFrame(pen);
    if (showsPath) this.drawPath(pen, film);
    this.drawAxes(pen);
  }

  drawFrame(pen) {
    const {width, height, frame: [x, y, w, h]} = this.layout;
    pen.fillStyle = "#0006";
    pen.beginPath();
    pen.rect(0, 0, width, height);
    pen.rect(x, y, w, h);
    pen.fill("evenodd");
    pen.strokeStyle = "#fffb";
    pen.lineWidth = 1;
    pen.strokeRect(Math.round(x) - 0.5, Math.round(y) - 0.5, Math.round(w) + 1, Math.round(h) + 1);
  }

  /// Where a point of the world is on the canvas, and how far off the slice; null behind the camera.
  project(point) {
    const {shown, layout} = this, from = minus(point, shown.position), forward = dot(shown.forward, from);
    if (forward < 1e-3) return null;
    const scale = layout.frame[3] / 2 / Math.tan((shown.fieldOfView * Math.PI) / 360) / forward;
    return {x: layout.width / 2 + scale * dot(shown.right, from),
            y: layout.height / 2 - scale * dot(shown.up, from), off: Math.abs(dot(shown.fourth, from))};
  }

  line(pen, a, b) {
    const from = this.project(a), to = this.project(b);
    if (!from || !to) return;
    pen.beginPath();
    pen.moveTo(from.x, from.y);
    pen.lineTo(to.x, to.y);
    pen.stroke();
  }

  /// The way of the film's camera, a dot at each of its keys, and the camera as it stands.
  drawPath(pen, film) {
    const {cameras, key_times, times: moments} = this.scene;
    pen.lineWidth = 1.5;
    pen.strokeStyle = "#ffb347b0";
    for (let i = 1; i < cameras.length; ++i) this.line(pen, cameras[i - 1].position, cameras[i].position);
    pen.fillStyle = "#ffb347";
    for (const time of key_times) {
      const next = moments.findIndex((t) => t >= time - 1e-9);
      const moment = next < 0 ? cameras.length - 1 : Math.min(cameras.length - 1, next);
      const at = this.project(cameras[moment].position);
      if (!at) continue;
      pen.beginPath();
      pen.arc(at.x, at.y, 4, 0, 7);
      pen.fill();
    }
    const axes = axesOf(film);
    if (!axes || norm(minus(film.position, this.shown.position)) < 1e-6) return;
    this.drawCamera(pen, film, axes);
  }

  drawCamera(pen, film, axes) {
    const size = 0.12 * norm(minus(film.look_at, film.position));
    const up = Math.tan((film.field_of_view * Math.PI) / 360) * size;
    const right = (up * this.scene.size[0]) / this.scene.size[1];
    const middle = along(film.position, size, axes.forward);
    const corner = (x, y) => along(along(middle, x * right, axes.right), y * up, axes.up);
    const corners = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)];
    pen.strokeStyle = "#ffd9a0";
    corners.forEach((c, i) => {
      this.line(pen, film.position, c);
      this.line(pen, c, corners[(i + 1) % 4]);
    });
    this.line(pen, corner(-0.4, 1.1), corner(0, 1.6));
    this.line(pen, corner(0, 1.6), corner(0.4, 1.1));
  }

  /// The axes of space as the slice sees them; what is left of w shows how far it is turned.
  drawAxes(pen) {
    const {width} = this.layout, {shown} = this, [x, y, length] = [width - 52, 52, 32];
    const ends = ["x", "y", "z", "w"].map((name, i) => {
      const part = [shown.right[i], shown.up[i], shown.forward[i]];
      return {name, color: kAxisColors[i], part};
    }).sort((a, b) => b.part[2] - a.part[2]);
    pen.fillStyle = "#0005";
    pen.beginPath();
    pen.arc(x, y, 44, 0, 7);
    pen.fill();
    pen.font = "bold 11px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    for (const {name, color, part} of ends) {
      const size = Math.hypot(...part);
      if (size < 0.02) continue;
      const to = [x + length * part[0], y - length * part[1]];
      pen.strokeStyle = pen.fillStyle = color;
      pen.lineWidth = 2;
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(...to);
      pen.stroke();
      pen.beginPath();
      pen.arc(...to, 7, 0, 7);
      pen.fill();
      pen.fillStyle = "#000";
      pen.fillText(name, to[0], to[1] + 0.5);
    }
  }
}

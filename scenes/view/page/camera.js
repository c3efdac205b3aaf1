"use strict";
// The camera: a point and a frame of four axes, of which the picture shows three.

/// The orthonormal axes of a camera as a scene describes it, as render/camera/camera.cpp makes
/// them; null if its directions are not independent.
function axesOf({position, look_at, up, fourth}) {
  const view = minus(look_at, position);
  if (!(norm(view) > 0)) return null;
  const forward = unit(view);
  const across = orthogonalPart(fourth, forward);
  const upward = across && orthogonalPart(up, forward, across);
  if (!upward) return null;
  return {right: completingAxis(upward, forward, across), up: upward, forward, fourth: across};
}

/// What the page looks through: a camera that is moved about in its slice, and the slice, which is
/// moved along w and turned about the point that the camera looks at.
class View {
  constructor(camera) {
    this.look(camera);
  }

  /// Shows just what that camera sees.
  look(c) {
    const axes = axesOf(c);
    if (!axes) throw new Error("camera: its directions are not independent");
    this.axes = axes;
    this.pivot = c.look_at.slice();
    this.distance = norm(minus(c.look_at, c.position));
    // What orbiting turns about: the scene's up, which the camera may look down along.
    this.upright = orthogonalPart(c.up, axes.fourth) || axes.up;
    this.fieldOfView = c.field_of_view;
    this.shift = 0;               // of the slice along its fourth axis [m]
    this.angles = [0, 0, 0];      // xw, yw, zw [rad]
    this.described = {...c};      // as long as nothing moved it
  }

  touched() {
    this.described = null;
  }

  get position() {
    return along(this.pivot, -this.distance, this.axes.forward);
  }

  /// The camera with the slice turned and moved: axes and position of what is shown.
  shown() {
    const turned = (v) => turnedWithW(v, this.angles), {right, up, forward, fourth} = this.axes;
    const axes = {right: turned(right), up: turned(up), forward: turned(forward),
                  fourth: turned(fourth)};
    const pivot = along(this.pivot, this.shift, axes.fourth);  // of the turned slice
    const position = this.described && this.shift === 0 && !this.angles.some((a) => a !== 0)
      ? this.described.position.slice() : along(pivot, -this.distance, axes.forward);
    return {...axes, position, pivot, fieldOfView: this.fieldOfView};
  }

  /// The shown camera as a scene describes it.
  description() {
    const c = this.shown();
    if (this.described && this.shift === 0 && !this.angles.some((a) => a !== 0))
      return {...this.described, field_of_view: this.fieldOfView};
    return {position: c.position, look_at: c.pivot, up: c.up, fourth: c.fourth,
            field_of_view: this.fieldOfView};
  }

  /// Turns about the pivot: `yaw` about the upright, `pitch` about the right axis [rad].
  orbit(yaw, pitch) {
    this.touched();
    const {fourth} = this.axes;
    // The plane that is orthogonal to the upright and to the fourth axis.
    const a = orthogonalPart(this.axes.right, this.upright, fourth) || this.axes.right;
    const b = completingAxis(a, this.upright, fourth);
    const turn = (v) => turnedInPlane(v, a, times(-1, b), yaw);
    let forward = turn(this.axes.forward), up = turn(this.axes.up);
    [forward, up] = [turnedInPlane(forward, forward, up, pitch), turnedInPlane(up, forward, up, pitch)];
    this.setFrame(forward, up);
  }

  /// Turns about the camera's own place.
  lookAround(yaw, pitch) {
    const position = this.position;
    this.orbit(yaw, pitch);
    this.pivot = along(position, this.distance, this.axes.forward);
  }

  setFrame(forward, up) {
    const fourth = this.axes.fourth;
    forward = orthogonalPart(forward, fourth);
    up = orthogonalPart(up, forward, fourth);
    this.axes = {right: completingAxis(up, forward, fourth), up, forward, fourth};
  }

  /// Moves camera and pivot [m].
  move(right, up, forward) {
    this.touched();
    const {axes} = this;
    this.pivot = along(along(along(this.pivot, right, axes.right), up, axes.up), forward, axes.forward);
  }

  zoom(factor) {
    this.touched();
    this.distance = clamp(this.distance * factor, 1e-4, 1e7);
  }

  /// Looks along one of the axes of the slice, as Blender's keys 1, 3 and 7 do.
  lookAlong(forward, up) {
    this.touched();
    const f = orthogonalPart(forward, this.axes.fourth), u = f && orthogonalPart(up, f, this.axes.fourth);
    if (!u) return;
    this.upright = orthogonalPart(this.upright, this.axes.fourth) || u;
    this.setFrame(f, u);
  }
}

/// The film's camera at a time: that of each moment, mixed between two.
function filmCamera(scene, poses, time) {
  const {cameras} = scene;
  if (cameras.length === 1) return cameras[0];
  const {first, part} = poses.instant(time), a = cameras[first], b = cameras[first + 1];
  if (part === 0) return a;
  const camera = {field_of_view: a.field_of_view + part * (b.field_of_view - a.field_of_view)};
  for (const key of ["position", "look_at", "up", "fourth"]) camera[key] = mix(a[key], b[key], part);
  return camera;
}

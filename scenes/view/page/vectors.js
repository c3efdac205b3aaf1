"use strict";
// Points and directions of four dimensions as arrays [x, y, z, w].

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
const plus = (a, b) => a.map((v, i) => v + b[i]);
const minus = (a, b) => a.map((v, i) => v - b[i]);
const times = (k, a) => a.map((v) => k * v);
/// a + k b
const along = (a, k, b) => a.map((v, i) => v + k * b[i]);
const norm = (a) => Math.sqrt(dot(a, a));
const unit = (a) => times(1 / norm(a), a);
const mix = (a, b, t) => a.map((v, i) => v + t * (b[i] - v));
const clamp = (v, low, high) => Math.min(Math.max(v, low), high);

/// The unit part of `v` orthogonal to orthonormal `others`; null if there is none to speak of.
function orthogonalPart(v, ...others) {
  let rest = unit(v);
  for (const pass of [1, 2]) {
    for (const other of others) rest = along(rest, -dot(rest, other), other);
    if (!(norm(rest) > 1e-8)) return null;
    rest = unit(rest);
  }
  return rest;
}

/// The unit vector that makes (it, a, b, c) a frame of determinant +1, for orthonormal a, b, c.
function completingAxis(a, b, c) {
  const minor = (i, j, k) =>
    a[i] * (b[j] * c[k] - b[k] * c[j]) - b[i] * (a[j] * c[k] - a[k] * c[j]) +
    c[i] * (a[j] * b[k] - a[k] * b[j]);
  return unit([minor(1, 2, 3), -minor(0, 2, 3), minor(0, 1, 3), -minor(0, 1, 2)]);
}

/// Turns `v` in the planes xw, yw, zw at once, by angles [rad]: positive ones turn x, y, z toward w,
/// as `rotation = { xw = ... }` does in a scene.
function turnedWithW(v, angles) {
  const angle = Math.hypot(...angles);
  if (angle === 0) return v.slice();
  const axis = [...angles.map((a) => a / angle), 0];
  const own = dot(v, axis), cosine = Math.cos(angle) - 1, sine = Math.sin(angle);
  const turned = along(v, cosine * own - sine * v[3], axis);
  turned[3] += cosine * v[3] + sine * own;
  return turned;
}

/// Turns `v` in the plane of orthonormal a and b: positive angles turn a toward b.
function turnedInPlane(v, a, b, angle) {
  const va = dot(v, a), vb = dot(v, b), cosine = Math.cos(angle) - 1, sine = Math.sin(angle);
  return along(along(v, cosine * va - sine * vb, a), cosine * vb + sine * va, b);
}

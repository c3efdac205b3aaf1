"use strict";
// Cameras as text of a scene file.

/// A number as TOML reads it, with all its digits.
const tomlNumber = (v) => String(v === 0 ? 0 : v);
const tomlList = (v) => `[${v.map(tomlNumber).join(", ")}]`;

function cameraLines(camera) {
  return ["position", "look_at", "up", "fourth"].map((key) => `${key} = ${tomlList(camera[key])}\n`).join("") +
    `field_of_view = ${tomlNumber(camera.field_of_view)}\n`;
}

const cameraToml = (camera) => `[camera]\n${cameraLines(camera)}`;
const cameraKeyToml = (camera, time) => `[[camera.key]]\ntime = ${tomlNumber(time)}\n${cameraLines(camera)}`;

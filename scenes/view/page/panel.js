"use strict";
// The panel: sliders, checks, buttons, and what is said of the chosen body. All text goes into the
// page as text: a body's name may be anything.

const byId = (id) => document.getElementById(id);
const say = (id, text) => (byId(id).textContent = text);

const kTurns = ["xw", "yw", "zw"];

/// Says over the picture why there is none.
function fail(why) {
  byId("failure").hidden = false;
  say("failure", `This page cannot be shown: ${why}.`);
}

/// A slider with a number beside it; a double click sets it back.
class Slider {
  constructor(name, low, high, start, onInput) {
    const box = document.querySelector(`.slider[data-name="${name}"]`);
    const label = document.createElement("span"), unit = document.createElement("span");
    label.textContent = box.dataset.label, unit.textContent = box.dataset.unit;
    this.range = document.createElement("input");
    Object.assign(this.range, {type: "range", min: low, max: high, step: "any", ariaLabel: box.dataset.label});
    this.number = document.createElement("input");
    Object.assign(this.number, {type: "number", step: "any", ariaLabel: box.dataset.label});
    label.title = box.title;
    box.append(label, this.number, unit, this.range);
    this.set(start);
    this.range.addEventListener("input", () => onInput(this.take(Number(this.range.value))));
    this.number.addEventListener("change", () => {
      const value = Number(this.number.value);
      if (Number.isFinite(value)) onInput(this.take(value));
    });
    this.range.addEventListener("dblclick", () => onInput(this.take(start)));
  }
  take(value) {
    this.set(value);
    return value;
  }
  set(value) {
    if (this.value === value) return;
    this.value = value;
    this.range.value = value;
    this.number.value = Number(value.toFixed(3));
  }
}

class Panel {
  constructor(page) {
    this.page = page;
    const {view, options} = page, reach = page.reach, degrees = Math.PI / 180;
    const changed = (change) => (value) => {
      change(value);
      page.changed();
    };
    const moved = (change) => changed((value) => {
      page.leaveFilm();
      change(value);
    });
    const depth = page.scene.ghost_depth, ghosts = (deep) => this.setGhosts(byId("ghosts").checked, deep);
    this.sliders = {
      w: new Slider("w", -reach, reach, 0, moved((v) => (view.shift = v))),
      fov: new Slider("fov", 1, 150, view.fieldOfView, moved((v) => (view.fieldOfView = clamp(v, 0.01, 179)))),
      ghost: new Slider("ghost", 0, Math.max(reach, depth), depth || 0.25 * reach, changed(ghosts)),
    };
    kTurns.forEach((name, i) => {
      this.sliders[name] = new Slider(name, -180, 180, 0, moved((v) => (view.angles[i] = v * degrees)));
    });
    const check = (id, change) => byId(id).addEventListener("change", changed(() => change(byId(id).checked)));
    check("shadows", (on) => (options.shadows = on));
    check("frame", (on) => (page.showsFrame = on));
    check("path", (on) => (page.showsPath = on));
    check("ghosts", (on) => this.setGhosts(on, this.sliders.ghost.value));
    check("follow", (on) => (on ? page.followFilm() : page.leaveFilm()));
    byId("reset-slice").addEventListener("click", changed(() => page.resetSlice()));
    byId("copy-camera").addEventListener("click", () => this.copy(cameraToml(view.description()), "[camera] copied"));
    byId("copy-key").addEventListener("click", () =>
      this.copy(cameraKeyToml(view.description(), page.time), `[[camera.key]] of ${page.time.toFixed(3)} s copied`));
    this.setGhosts(true, this.sliders.ghost.value);
    say("scene-name", page.scene.name);
    document.title = `${page.scene.name} - tesserae`;
  }

  setGhosts(on, depth) {
    byId("ghosts").checked = on;
    this.page.options.ghostDepth = on ? depth : 0;
  }

  async copy(text, done) {
    const status = byId("copied");
    try {
      await navigator.clipboard.writeText(text);
      status.textContent = done;
    } catch {
      // A browser that lets no page of a file write there: the text, to copy by hand.
      const area = document.createElement("textarea");
      area.readOnly = true;
      area.value = text;
      status.replaceChildren(area);
      area.select();
    }
  }

  /// Shows what the page is at.
  update() {
    const {page, sliders} = this, {view, scene} = page, degrees = Math.PI / 180;
    sliders.w.set(view.shift);
    sliders.fov.set(view.fieldOfView);
    kTurns.forEach((name, i) => sliders[name].set(view.angles[i] / degrees));
    byId("follow").checked = page.follows;
    const {placed} = page.renderer, cut = placed.order.filter((body) => placed.state[body] === kSolid).length;
    const left = scene.near_slice === undefined ? ""
      : `; of ${scene.bodies}, those that come within ${scene.near_slice} m of the film's slice`;
    say("facts", `${cut} of ${page.poses.count} bodies in view${left}`);
    this.updateBody();
  }

  updateBody() {
    const {page} = this, body = page.options.chosen;
    byId("body").hidden = body < 0;
    if (body < 0) return;
    if (page.joints) say("body-joints", page.joints.textOf(body));
    const {poses, scene} = page, type = scene.types[poses.type[body]], isPlane = type.kind === "plane";
    // As many digits as are stored.
    const list = (v, accuracy) => {
      const digits = clamp(Math.ceil(-Math.log10(accuracy)), 0, 6);
      return v.map((n) => n.toFixed(digits)).join(", ");
    };
    const step = poses.steps[2 * body] || 1e-3, moments = scene.times;
    const between = moments.length > 1 ? moments[1] - moments[0] : 1;
    say("body-name", page.nameOf(body));
    say("body-shape", type.shape);
    if (isPlane) {
      say("body-position", `${list(type.normal, 1e-3)} · p = ${type.offset.toFixed(3)} m`);
      say("body-velocity", "at rest");
      say("body-offset", "everywhere");
      return;
    }
    const position = [...poses.position.subarray(4 * body, 4 * body + 4)];
    say("body-position", `${list(position, step)} m`);
    say("body-velocity", `${list(poses.velocity(body, page.time), step / between)} m/s`);
    say("body-offset", `${list([page.renderer.placed.offset[body]], step)} m`);
  }
}

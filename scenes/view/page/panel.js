"use strict";
// The panel: sliders, checks, buttons, and what is said of the chosen body. All text goes into the
// page as text: a body's name may be anything.

const byId = (id) => document.getElementById(id);
const say = (id, text) => (byId(id).textContent = text);

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
    box.append(label, this.number, unit, this.range);
    this.set(start);
    this.range.addEventListener("input", () => onInput(this.take(Number(this.range.value))));
    this.number.addEventListener("change", () => {
      const value = Number(this.number.value);
      if (Number.isFinite(value)) onInput(this.take(value));
    });
    box.addEventListener("dblclick", () => onInput(this.take(start)));
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
    this.sliders = {
      w: new Slider("w", -reach, reach, 0, changed((v) => (page.leaveFilm(), (view.shift = v)))),
      fov: new Slider("fov", 1, 150, view.fieldOfView, changed((v) => (page.leaveFilm(), (view.fieldOfView = clamp(v, 0.01, 179))))),
      ghost: new Slider("ghost", 0, reach, 0.25 * reach, changed((v) => this.setGhosts(byId("ghosts").checked, v))),
    };
    ["xw", "yw", "zw"].forEach((name, i) => {
      this.sliders[name] = new Slider(name, -180, 180, 0, changed((v) => (page.leaveFilm(), (view.angles[i] = v * degrees))));
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
      this.copy(cameraKeyToml(view.description(), page.time), `[[camera.key]] copied, for ${page.time.toFixed(3)} s`));
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
    ["xw", "yw", "zw"].forEach((name, i) => sliders[name].set(view.angles[i] / degrees));
    byId("follow").checked = page.follows;
    const {placed} = page.renderer, cut = placed.order.filter((body) => placed.state[body] === kSolid).length;
    const left = scene.near_slice === undefined ? "" : `, without those never within ${scene.near_slice} m of the film's slice`;
    say("facts", `${cut} of ${page.poses.count} bodies in view${left}`);
    this.updateBody();
  }

  updateBody() {
    const {page} = this, body = page.options.chosen, list = (v) => v.map((n) => n.toFixed(3)).join(", ");
    byId("body").hidden = body < 0;
    if (body < 0) return;
    const {poses, scene} = page, type = scene.types[poses.type[body]], isPlane = type.kind === "plane";
    const velocity = poses.velocity(body, page.time);
    const offset = page.renderer.placed.offset[body];
    say("body-name", page.nameOf(body));
    say("body-shape", type.shape);
    say("body-position", isPlane ? `${list(type.normal)} · p = ${type.offset.toFixed(3)}` : `${list([...poses.position.subarray(4 * body, 4 * body + 4)])} m`);
    say("body-velocity", isPlane ? "at rest" : `${list(velocity)} m/s (${norm(velocity).toFixed(3)})`);
    say("body-offset", isPlane ? "everywhere" : `${offset.toFixed(3)} m`);
  }
}

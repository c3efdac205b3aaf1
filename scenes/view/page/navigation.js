"use strict";
// Mouse and keys, as in Blender's viewport; and the left button orbits too, for those without a
// middle one.

const kOrbitSpeed = 0.006;   // [rad a pixel]
const kClickReach = 4;       // a press that moves less than this is a click [pixels]

class Navigation {
  constructor(page) {
    this.page = page;
    this.pressed = new Set();
    const area = byId("overlay");
    area.addEventListener("pointerdown", (event) => this.press(event));
    area.addEventListener("pointermove", (event) => this.drag(event));
    area.addEventListener("pointerup", (event) => this.release(event));
    area.addEventListener("wheel", (event) => this.wheel(event), {passive: false});
    // The middle button would begin to scroll.
    area.addEventListener("mousedown", (event) => event.preventDefault());
    area.addEventListener("contextmenu", (event) => event.preventDefault());
    addEventListener("keydown", (event) => this.keyDown(event));
    addEventListener("keyup", (event) => this.pressed.delete(event.code));
    addEventListener("blur", () => this.pressed.clear());
  }

  press(event) {
    event.preventDefault();
    event.target.focus();
    event.target.setPointerCapture(event.pointerId);
    this.from = {x: event.clientX, y: event.clientY, moved: 0};
    this.button = event.button;
  }

  drag(event) {
    if (!this.from) return;
    const dx = event.clientX - this.from.x, dy = event.clientY - this.from.y;
    this.from = {x: event.clientX, y: event.clientY, moved: this.from.moved + Math.hypot(dx, dy)};
    if (this.from.moved < kClickReach) return;
    const {page} = this, {view} = page;
    page.leaveFilm();
    if (this.button === 2) view.lookAround(dx * kOrbitSpeed * 0.5, -dy * kOrbitSpeed * 0.5);
    else if (event.shiftKey) view.move(-dx * page.metresAPixel(), dy * page.metresAPixel(), 0);
    else if (event.ctrlKey) view.zoom(Math.exp(0.008 * dy));
    else view.orbit(dx * kOrbitSpeed, -dy * kOrbitSpeed);
    page.changed(true);
  }

  release(event) {
    const isClick = this.from && this.from.moved < kClickReach && this.button === 0;
    this.from = null;
    if (isClick) this.page.choose(event.offsetX, event.offsetY);
  }

  wheel(event) {
    event.preventDefault();
    const {page} = this;
    page.leaveFilm();
    page.view.zoom(Math.exp(clamp(event.deltaY, -200, 200) * 0.0015));
    page.changed(true);
  }

  keyDown(event) {
    const {tagName, type} = event.target;
    if (tagName === "TEXTAREA" || (tagName === "INPUT" && type === "number")) return;
    if (event.ctrlKey && !event.code.startsWith("Digit") && !event.code.startsWith("Numpad")) return;
    this.pressed.add(event.code);
    const act = this.action(event);
    if (!act) return;
    event.preventDefault();
    act();
    this.page.changed();
  }

  action({code, ctrlKey, shiftKey}) {
    const {page} = this, {view} = page, back = ctrlKey ? -1 : 1;
    const look = (forward, up) => () => (page.leaveFilm(), view.lookAlong(times(back, forward), up));
    const shift = (sign) => () => (page.leaveFilm(), (view.shift += sign * page.reach * (shiftKey ? 0.002 : 0.02)));
    const actions = {
      Space: () => page.togglePlay(), ArrowLeft: () => page.step(-1), ArrowRight: () => page.step(1),
      Home: () => page.showAll(), Period: () => page.focusChosen(), NumpadDecimal: () => page.focusChosen(),
      Digit0: () => page.followFilm(), Numpad0: () => page.followFilm(),
      Digit1: look([0, 0, 1, 0], [0, 1, 0, 0]), Numpad1: look([0, 0, 1, 0], [0, 1, 0, 0]),
      Digit3: look([-1, 0, 0, 0], [0, 1, 0, 0]), Numpad3: look([-1, 0, 0, 0], [0, 1, 0, 0]),
      Digit7: look([0, -1, 0, 0], [0, 0, 1, 0]), Numpad7: look([0, -1, 0, 0], [0, 0, 1, 0]),
      BracketLeft: shift(-1), BracketRight: shift(1), KeyR: () => page.resetSlice(),
      KeyN: () => document.body.classList.toggle("wide"), KeyG: () => byId("ghosts").click(),
      KeyJ: () => page.joints && byId("joints").click(), Escape: () => (page.options.chosen = -1),
    };
    return actions[code];
  }

  /// Flies while keys are down. True if there are any.
  fly(seconds) {
    const {pressed, page} = this, is = (code) => (pressed.has(code) ? 1 : 0);
    const way = [is("KeyD") - is("KeyA"), is("KeyE") - is("KeyQ"), is("KeyW") - is("KeyS")];
    if (way.every((v) => v === 0)) return false;
    const fast = pressed.has("ShiftLeft") || pressed.has("ShiftRight") ? 4 : 1;
    const speed = 0.7 * fast * Math.max(page.view.distance, 0.02 * page.reach) * seconds;
    page.leaveFilm();
    page.view.move(...way.map((v) => v * speed));
    return true;
  }
}

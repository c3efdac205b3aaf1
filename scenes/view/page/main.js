"use strict";
// The page: what is shown, when it is drawn anew, and window.tesserae for scripts.

const kFrameMargin = 1.08;      // the stage over the film's frame
const kSlowDraw = 60;           // longer ones are made coarser while something moves [ms]
const kRest = 180;              // after this long a still picture is refined [ms]

class Page {
  constructor() {
    this.scene = JSON.parse(byId("scene-data").textContent);
    this.poses = new Poses(bytesOfBase64(byId("pose-data").textContent), this.scene.times);
    this.canvas = byId("picture");
    this.renderer = new Renderer(this.canvas, this.scene, this.poses);
    this.view = new View(filmCamera(this.scene, this.poses, this.scene.times[0]));
    this.options = {width: 640, height: 360, margin: 1, ghostDepth: 0, shadows: true, chosen: -1};
    this.showsFrame = this.showsPath = true;
    this.follows = true;   // the film's camera
    this.isFixed = false;  // in size, and drawn only when asked to: for scripts
    this.coarseness = 1;   // of the last picture while something moved
    this.setTime(this.scene.times[0]);
    this.reach = this.extent();
    if (this.scene.joints) this.joints = new JointLines(this);
    this.overlay = new Overlay(byId("overlay"), this.scene);
    this.timeline = new Timeline(byId("rows"), this.scene, this.poses);
    this.panel = new Panel(this);
    this.navigation = new Navigation(this);
    this.connectTime();
    addEventListener("resize", () => this.changed());
    this.changed();
    this.last = performance.now();
    requestAnimationFrame((now) => this.tick(now));
  }

  /// How far bodies reach from what the camera looks at [m]: the scale of sliders and of flying.
  extent() {
    let reach = 0;
    for (let body = 0; body < this.poses.count; ++body) {
      const type = this.scene.types[this.poses.type[body]];
      if (type.kind === "plane") continue;
      const p = [...this.poses.position.subarray(4 * body, 4 * body + 4)];
      reach = Math.max(reach, type.bound, Math.min(norm(minus(p, this.view.pivot)), 4 * this.view.distance));
    }
    return reach || this.view.distance;
  }

  connectTime() {
    const {times} = this.scene, range = byId("moment");
    Object.assign(range, {min: times[0], max: times[times.length - 1]});
    range.disabled = byId("play").disabled = times.length < 2;
    range.addEventListener("input", () => this.goTo(Number(range.value)));
    byId("play").addEventListener("click", () => this.togglePlay());
    const rows = byId("rows");
    byId("rows-box").addEventListener("scroll", () => this.drawTime());
    let isDown = false;
    const go = (event) => isDown && event.offsetX >= kLabelWidth && this.goTo(this.timeline.timeAt(event.offsetX));
    rows.addEventListener("pointerdown", (event) => {
      isDown = true;
      rows.setPointerCapture(event.pointerId);
      const row = event.offsetX < kLabelWidth && this.timeline.rowAt(event.offsetY);
      if (row) (this.options.chosen = row.bodies[0]), this.changed();
      go(event);
    });
    rows.addEventListener("pointermove", go);
    rows.addEventListener("pointerup", () => (isDown = false));
  }

  setTime(time) {
    this.time = clamp(time, this.scene.times[0], this.scene.times[this.scene.times.length - 1]);
    this.renderer.moveTo(this.time);
    if (this.follows) this.view.look(filmCamera(this.scene, this.poses, this.time));
  }

  goTo(time) {
    this.isPlaying = false;
    this.setTime(time);
    this.changed(true);
  }

  togglePlay() {
    const {times} = this.scene;
    this.isPlaying = !this.isPlaying && times.length > 1;
    this.playTime = this.time >= times[times.length - 1] ? times[0] : this.time;
  }

  step(by) {
    const {times} = this.scene, {first, part} = this.poses.instant(this.time);
    this.goTo(times[clamp(first + (by < 0 && part > 0 ? 0 : by), 0, times.length - 1)]);
  }

  followFilm() {
    this.follows = true;
    this.setTime(this.time);
  }
  leaveFilm() {
    this.follows = false;
  }
  resetSlice() {
    this.view.shift = 0;
    this.view.angles.fill(0);
  }

  /// Something is to be drawn.
  /// @param moves   more will follow at once: speed before sharpness
  changed(moves = false) {
    this.isOld = true;
    this.moves = moves;
    this.touched = performance.now();
  }

  /// Sizes in CSS pixels; the film's frame is what a copied camera renders.
  layout() {
    const {clientWidth: width, clientHeight: height} = byId("stage"), [w, h] = this.scene.size;
    const margin = this.showsFrame ? kFrameMargin : 1;
    const frameHeight = this.showsFrame ? Math.min(height, (width * h) / w) / margin : height;
    const frameWidth = (frameHeight * w) / h;
    return {width, height, ratio: Math.min(devicePixelRatio, 2),
            frame: [(width - frameWidth) / 2, (height - frameHeight) / 2, frameWidth, frameHeight]};
  }

  metresAPixel() {
    return (2 * this.view.distance * Math.tan((this.view.fieldOfView * Math.PI) / 360)) / this.layout().frame[3];
  }

  tick(now) {
    requestAnimationFrame((next) => this.tick(next));
    const seconds = Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    if (this.isFixed) return;
    if (this.isPlaying) this.play(seconds);
    if (this.navigation.fly(seconds)) this.changed(true);
    if (this.isOld) {
      this.isOld = false;
      this.drawMoving();
    } else if (this.isRough && now - this.touched > kRest) {
      this.drawStill();
    } else if (this.timeline.work()) {
      this.drawTime();
    }
  }

  /// Shows the film's frames at the film's rate.
  play(seconds) {
    const {times} = this.scene, end = times[times.length - 1] + 1 / this.scene.frames_per_second;
    this.playTime += seconds;
    if (this.playTime >= end) this.playTime = times[0] + ((this.playTime - times[0]) % (end - times[0]));
    const time = times[this.poses.instant(this.playTime).first];
    if (time === this.time) return;
    this.setTime(time);
    this.changed(true);
  }

  drawMoving() {
    const begin = performance.now();
    this.drawUi(this.moves ? this.coarseness : 1);
    this.renderer.finish();
    const took = performance.now() - begin;
    if (!this.moves) this.isSlow = took > 5 * kSlowDraw;
    if (this.moves && took > kSlowDraw) this.coarseness = Math.min(4, this.coarseness * 1.5);
    if (this.moves && took < kSlowDraw / 3) this.coarseness = Math.max(1, this.coarseness / 1.5);
    this.isRough = true;
  }

  /// At rest there is time for four rays a pixel.
  drawStill() {
    this.isRough = false;
    this.drawUi(this.isSlow ? 1 : 0.5);
  }

  /// @param coarseness   side of what is drawn as one, in device pixels
  drawUi(coarseness) {
    const layout = this.layout(), scale = layout.ratio / coarseness;
    this.options.width = Math.max(1, Math.round(layout.width * scale));
    this.options.height = Math.max(1, Math.round(layout.height * scale));
    this.options.margin = layout.height / layout.frame[3];
    this.canvas.style.width = `${layout.width}px`, this.canvas.style.height = `${layout.height}px`;
    this.draw();
    const shown = this.view.shown();
    const film = filmCamera(this.scene, this.poses, this.time);
    this.overlay.draw(shown, layout, {showsFrame: this.showsFrame, showsPath: this.showsPath, film, joints: this.joints});
    const slices = JSON.stringify(this.follows ? "film" : [shown.position, shown.fourth]);
    this.timeline.follow((moment) => this.sliceAt(moment), slices);
    this.panel.update();
    this.drawTime();
  }

  /// Where the slice is at a moment: the film's may turn.
  sliceAt(moment) {
    if (!this.follows) return this.view.shown();
    const camera = filmCamera(this.scene, this.poses, this.scene.times[moment]);
    return {...axesOf(camera), position: camera.position};
  }

  drawTime() {
    const {times, frames_per_second: rate} = this.scene, {first} = this.poses.instant(this.time);
    byId("moment").value = this.time;
    byId("play").textContent = this.isPlaying ? "\u275a\u275a" : "\u25b6";
    say("clock", `${this.time.toFixed(3)} s\nframe ${first + 1} of ${times.length}`);
    const {chosen} = this.options, box = byId("rows-box"), {timeline} = this;
    byId("rows-height").style.height = `${timeline.height}px`;
    // Beside the rows' scroll bar, so that the thumb stands over the playhead.
    byId("transport").style.paddingRight = `${6 + box.offsetWidth - box.clientWidth}px`;
    const view = {width: box.clientWidth, height: Math.min(box.clientHeight, timeline.height),
                  scrolled: box.scrollTop, ratio: Math.min(devicePixelRatio, 2)};
    timeline.draw(view, this.time, chosen < 0 ? -1 : this.poses.id[chosen]);
  }

  draw() {
    const {options} = this;
    if (this.canvas.width !== options.width || this.canvas.height !== options.height)
      (this.canvas.width = options.width), (this.canvas.height = options.height);
    this.renderer.draw(this.view.shown(), options);
  }

  /// Chooses the body at a point of the stage [CSS pixels], or none.
  choose(x, y) {
    const {renderer} = this, stage = byId("stage");
    const column = (x / stage.clientWidth) * renderer.width, row = (y / stage.clientHeight) * renderer.height;
    this.options.chosen = renderer.seenAt(column, row) - 1;
    this.changed();
  }

  focusChosen() {
    const body = this.options.chosen;
    if (body < 0 || this.scene.types[this.poses.type[body]].kind === "plane") return;
    this.leaveFilm();
    // Its place in the slice.
    const {view} = this, shown = view.shown(), at = [...this.poses.position.subarray(4 * body, 4 * body + 4)];
    const from = minus(at, shown.pivot);
    view.move(dot(shown.right, from), dot(shown.up, from), dot(shown.forward, from));
    view.distance = 4 * this.scene.types[this.poses.type[body]].bound;
  }

  showAll() {
    this.leaveFilm();
    const {view, poses, scene} = this, shown = view.shown();
    const low = [1e300, 1e300, 1e300], high = [-1e300, -1e300, -1e300];
    for (let body = 0; body < poses.count; ++body) {
      const type = scene.types[poses.type[body]];
      if (type.kind === "plane") continue;
      const from = minus([...poses.position.subarray(4 * body, 4 * body + 4)], shown.pivot);
      [shown.right, shown.up, shown.forward].forEach((axis, i) => {
        low[i] = Math.min(low[i], dot(axis, from) - type.bound);
        high[i] = Math.max(high[i], dot(axis, from) + type.bound);
      });
    }
    if (!(low[0] <= high[0])) return;
    view.move(...low.map((l, i) => (l + high[i]) / 2));
    const radius = Math.hypot(...low.map((l, i) => high[i] - l)) / 2;
    view.distance = radius / Math.sin((Math.min(view.fieldOfView, 120) * Math.PI) / 360);
  }

  /// As the scene calls it; a body of a lattice by its number in it too.
  nameOf(body) {
    const id = this.poses.id[body];
    const [name, first, , isLattice] = this.scene.names.find(([, from, count]) => id >= from && id < from + count);
    return isLattice ? `${name}.${id - first}` : name;
  }
}

/// What scenes/FORMATS.md promises to scripts, and `page` for tests.
function interfaceOf(page) {
  const idOf = (seen) => (seen === 0 ? 0 : page.poses.id[seen - 1] + 1);
  return {
    page,
    time: (t) => {
      page.setTime(t);
      page.changed();
    },
    camera: (camera) => {
      // What it does not say stays as it is.
      page.view.look({...page.view.description(), ...camera});
      page.leaveFilm();
      page.changed();
    },
    size: (width, height) => {
      // A script sees at first what tesserae render shows.
      if (!page.isFixed) page.panel.setGhosts(page.scene.ghosts_over, page.scene.ghost_depth);
      page.isFixed = true;
      page.canvas.style.width = `${width}px`, page.canvas.style.height = `${height}px`;
      Object.assign(page.options, {width, height, margin: 1});
    },
    draw: async () => {
      page.draw();
      page.renderer.finish();
    },
    pick: (x, y) => idOf(page.renderer.seenAt(x, y)),
    ids: () => page.renderer.seenBodies().map(idOf),
    camera_toml: () => cameraToml(page.view.description()),
  };
}

window.tesserae = {};
window.tesserae.ready = new Promise((resolve) => {
  try {
    const page = new Page();
    page.drawUi(1);
    Object.assign(window.tesserae, interfaceOf(page));
    resolve();
  } catch (error) {
    fail(error.message);
    throw error;
  }
});

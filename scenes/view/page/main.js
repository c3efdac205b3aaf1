"use strict";
// The page: what is shown, when it is drawn anew, and window.tesserae for scripts.

class Page {
  constructor() {
    this.scene = JSON.parse(document.getElementById("scene-data").textContent);
    this.poses = new Poses(bytesOfBase64(document.getElementById("pose-data").textContent), this.scene.times);
    this.canvas = document.getElementById("picture");
    this.renderer = new Renderer(this.canvas, this.scene, this.poses);
    this.view = new View(filmCamera(this.scene, this.poses, this.scene.times[0]));
    this.options = {width: 640, height: 360, margin: 1, ghostDepth: 0, shadows: true, chosen: -1};
    this.setTime(this.scene.times[0]);
  }

  setTime(time) {
    this.time = time;
    this.renderer.moveTo(time);
  }

  draw() {
    const {options} = this;
    if (this.canvas.width !== options.width || this.canvas.height !== options.height) {
      this.canvas.width = options.width, this.canvas.height = options.height;
    }
    this.renderer.draw(this.view.shown(), options);
  }
}

window.tesserae = {};
window.tesserae.ready = new Promise((resolve) => {
  const page = new Page();
  Object.assign(window.tesserae, {
    page,
    time: (t) => page.setTime(t),
    camera: (camera) => page.view.look(camera),
    size: (width, height) => Object.assign(page.options, {width, height}),
    draw: async () => {
      page.draw();
      page.renderer.finish();
    },
    pick: (x, y) => {
      const seen = page.renderer.seenBodies(x, y, 1, 1)[0];
      return seen === 0 ? 0 : page.poses.id[seen - 1] + 1;
    },
    ids: () => page.renderer.seenBodies().map((seen) => (seen === 0 ? 0 : page.poses.id[seen - 1] + 1)),
    camera_toml: () => cameraToml(page.view.description()),
  });
  page.draw();
  resolve();
});

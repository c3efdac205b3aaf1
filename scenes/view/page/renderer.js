"use strict";
// The two passes on the graphics card. What it needs is in textures; nothing is drawn but a
// triangle that covers the picture.

const kWidth = 2048;  // of textures that are lists
const kTile = 16;     // [pixels]
const kMostLamps = 8;

class Renderer {
  constructor(canvas, scene, poses) {
    const gl = canvas.getContext("webgl2", {antialias: false, alpha: false, preserveDrawingBuffer: true});
    if (!gl) throw new Error("this browser has no WebGL 2");
    canvas.addEventListener("webglcontextlost", () =>
      fail("the graphics card was taken away; load the page again"));
    this.gl = gl;
    this.scene = scene;
    this.poses = poses;
    this.placed = new PlacedBodies(scene, poses);
    this.tiles = new Tiles();
    this.grids = new SunGrids(scene, poses);
    this.programs = new Map();
    this.textures = {};
    for (const name of ["bodies", "forms", "materials", "tiles", "list", "seen_by", "shade_list"])
      this.textures[name] = this.texture();
    this.target = gl.createFramebuffer();
    this.put("forms", padded(formTexels(scene)), gl.RGBA32F, gl.RGBA, gl.FLOAT, 4);
    this.put("materials", padded(materialTexels(scene)), gl.RGBA32F, gl.RGBA, gl.FLOAT, 4);
    if (scene.tints) {
      this.textures.tints = this.texture();
      this.put("tints", padded(tintTexels(scene, poses)), gl.RGBA32F, gl.RGBA, gl.FLOAT, 4);
    }
    gl.bindVertexArray(gl.createVertexArray());
  }

  /// The program of a pass that shows just what is asked for; made when it is first asked for.
  programOf(pass, ...shown) {
    const text = (id) => document.getElementById(id).textContent.trimStart();
    const {scene} = this, kinds = new Set(scene.types.map((type) => type.kind));
    const all = [...[...kinds].map((kind) => `SHAPE_${kind.toUpperCase()}`), ...shown];
    const patterns = new Set(scene.materials.map((material) => material.pattern));
    patterns.delete("none");
    if (patterns.size > 0) all.push("PATTERNS");
    patterns.forEach((pattern) => all.push(`PATTERN_${pattern.toUpperCase()}`));
    if (scene.tints) all.push("TINTS");
    all.push(`SUNS ${this.grids.suns.length}`, `LAMPS ${Math.min(scene.lights.lamps.length, kMostLamps)}`);
    const key = [pass, ...shown].join(" ");
    if (!this.programs.has(key)) {
      const defined = all.map((name) => `#define ${name}\n`).join("");
      this.programs.set(key, this.program(text("screen-glsl"),
        `#version 300 es\n${defined}${text("shapes-glsl")}${text(pass)}`));
    }
    return this.programs.get(key);
  }

  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    return program;
  }

  texture() {
    const gl = this.gl, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    for (const [name, value] of [[gl.TEXTURE_MIN_FILTER, gl.NEAREST], [gl.TEXTURE_MAG_FILTER, gl.NEAREST],
                                 [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]])
      gl.texParameteri(gl.TEXTURE_2D, name, value);
    return texture;
  }

  /// Fills a texture; without a width it is a list, in rows of kWidth texels.
  put(name, data, format, layout, type, components, width, height) {
    const gl = this.gl;
    gl.bindTexture(gl.TEXTURE_2D, this.textures[name]);
    if (width === undefined) {
      width = kWidth;
      height = Math.max(1, Math.ceil(data.length / components / kWidth));
      if (data.length < components * width * height) {
        const longer = new data.constructor(components * width * height);
        longer.set(data);
        data = longer;
      }
    }
    gl.texImage2D(gl.TEXTURE_2D, 0, format, width, height, 0, layout, type, data);
  }

  /// Bodies as they stand at another time.
  moveTo(time) {
    this.poses.moveTo(time);
    this.gridsAreOld = true;
  }

  /// Draws what a camera sees.
  /// @param camera    as View.shown()
  /// @param options   width, height [pixels]; margin: height of the picture over that of the view
  ///                  that the camera's field spans; ghostDepth [m]; shadows; chosen: body or -1
  draw(camera, options) {
    const gl = this.gl, {width, height} = options;
    const pixel = 2 * Math.tan((camera.fieldOfView * Math.PI) / 360) * options.margin / height;
    this.seen = null;
    const limit = this.scene.max_distance > 0 ? this.scene.max_distance : 1e30;
    this.film = {width, height, pixel, tile: kTile};
    if (this.width !== width || this.height !== height) this.resize(width, height);
    this.placed.place(camera, options.ghostDepth, limit);
    this.tiles.build(this.placed, this.film);
    const {placed, tiles} = this;
    this.put("bodies", placed.texels, gl.RGBA32F, gl.RGBA, gl.FLOAT, 4, kTexels * kBodiesARow, placed.rows);
    this.put("tiles", tiles.tiles, gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT, 4, tiles.columns, tiles.rows);
    this.put("list", tiles.list, gl.RG32UI, gl.RG_INTEGER, gl.UNSIGNED_INT, 2);
    if (options.shadows && this.gridsAreOld) {
      this.grids.build();
      this.put("shade_list", this.grids.words, gl.R32UI, gl.RED_INTEGER, gl.UNSIGNED_INT, 1);
      this.gridsAreOld = false;
    }
    gl.viewport(0, 0, width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    this.run(this.programOf("seen-glsl"), false, limit);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    const shown = [];
    if (options.shadows) shown.push("SHADOWS");
    if (options.ghostDepth > 0) shown.push("GHOSTS");
    if (options.chosen >= 0) shown.push("OUTLINE");
    this.run(this.programOf("shade-glsl", ...shown), true, limit, () => this.setLights(camera, options));
  }

  resize(width, height) {
    const gl = this.gl;
    this.width = width, this.height = height;
    this.put("seen_by", null, gl.RG32UI, gl.RG_INTEGER, gl.UNSIGNED_INT, 2, width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.textures.seen_by, 0);
  }

  run(program, readsSeen, limit, setMore = () => {}) {
    const gl = this.gl;
    this.running = program;
    gl.useProgram(program);
    // The first pass must not read what it writes.
    const names = Object.keys(this.textures).filter((name) => readsSeen || name !== "seen_by");
    names.forEach((name, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, this.textures[name]);
      gl.uniform1i(this.place(name), unit);
    });
    gl.uniform1i(this.place("tile_size"), this.film.tile);
    gl.uniform2f(this.place("film_centre"), this.film.width / 2, this.film.height / 2);
    gl.uniform1f(this.place("pixel"), this.film.pixel);
    gl.uniform1f(this.place("limit"), limit);
    setMore();
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.activeTexture(gl.TEXTURE0);
  }

  place(name) {
    return this.gl.getUniformLocation(this.running, name);
  }

  setLights(camera, {shadows, chosen}) {
    const gl = this.gl, {lights, exposure} = this.scene;
    const axes = [camera.right, camera.up, camera.forward, camera.fourth];
    const inCamera = (v) => axes.map((a) => dot(a, v));
    const {grids} = this;
    grids.suns.forEach((sun, i) => {
      gl.uniform4fv(this.place(`sun_toward[${i}]`), inCamera(sun.toward));
      gl.uniform3fv(this.place(`sun_irradiance[${i}]`), sun.irradiance);
      if (!shadows) return;
      const grid = grids.grids[i], from = minus(camera.position, grids.reference);
      // Columns: where the camera's axes lead in the grid.
      const map = [0, 1, 2].flatMap((k) => grid.across.map((e) => dot(e, axes[k]) / grid.cell));
      gl.uniformMatrix3fv(this.place(`sun_map[${i}]`), false, map);
      const origin = grid.across.map((e, k) => (dot(e, from) - grid.low[k]) / grid.cell);
      gl.uniform3fv(this.place(`sun_origin[${i}]`), origin);
      gl.uniform3i(this.place(`sun_size[${i}]`), ...grid.size);
      gl.uniform3i(this.place(`sun_places[${i}]`), grid.firstCell, grid.firstLarge, grid.large);
    });
    const lamps = lights.lamps.slice(0, kMostLamps);
    lamps.forEach((lamp, i) => {
      gl.uniform4fv(this.place(`lamp_place[${i}]`), inCamera(minus(lamp.position, camera.position)));
      gl.uniform4fv(this.place(`lamp_power[${i}]`), [...lamp.power, lamp.radius]);
    });
    gl.uniform3fv(this.place("sky"), lights.sky);
    gl.uniform1f(this.place("gain"), Math.min(2 ** exposure, 1e30));
    gl.uniform4fv(this.place("axes_w"), axes.map((a) => a[3]));
    gl.uniform1f(this.place("camera_w"), camera.position[3]);
    gl.uniform3fv(this.place("side_colors[0]"), this.scene.side_colors.flat());
    gl.uniform3fv(this.place("ghost_colors[0]"), this.scene.ghost_colors.flat());
    gl.uniform1ui(this.place("chosen"), chosen + 1);
  }

  /// Of each pixel of the last picture, by rows from the top: number of the body in the page + 1,
  /// or 0.
  seenBodies() {
    if (this.seen) return this.seen;
    const gl = this.gl, {width, height} = this, texels = new Uint32Array(4 * width * height);
    this.seen = new Uint32Array(width * height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.readPixels(0, 0, width, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, texels);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    for (let row = 0; row < height; ++row)
      for (let column = 0; column < width; ++column)
        this.seen[row * width + column] = texels[4 * ((height - 1 - row) * width + column)];
    return this.seen;
  }

  /// At a pixel from the top left.
  seenAt(x, y) {
    const inside = x >= 0 && y >= 0 && x < this.width && y < this.height;
    return inside ? this.seenBodies()[Math.floor(y) * this.width + Math.floor(x)] : 0;
  }

  /// Waits until the card has drawn everything.
  finish() {
    this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, new Uint8Array(4));
  }
}

function padded(texels) {
  return new Float32Array(texels.flat());
}

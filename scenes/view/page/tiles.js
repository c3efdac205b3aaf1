"use strict";
// For each tile of the picture the bodies that may be seen in it, the nearest first.

const kMostEntries = 2e6;
const kLargestTile = 256;  // [pixels]

class Tiles {
  /// @param film   width, height and tile [pixels]; pixel: side of one at distance 1. Its tiles are
  ///               made larger where the lists would be too long.
  build(placed, film) {
    while (!this.tryToBuild(placed, film)) film.tile *= 2;
  }

  tryToBuild(placed, film) {
    const columns = Math.ceil(film.width / film.tile), rows = Math.ceil(film.height / film.tile);
    const {order, state} = placed, rectangles = new Int16Array(4 * order.length);
    let touched = 0;
    const counts = [new Uint32Array(columns * rows), new Uint32Array(columns * rows)];
    for (let i = 0; i < order.length; ++i) {
      const rectangle = this.rectangle(placed.slopes(order[i]), film, columns, rows);
      rectangles.set(rectangle, 4 * i);
      const count = counts[state[order[i]] - 1], [x0, x1, y0, y1] = rectangle;
      touched += Math.max(0, x1 - x0 + 1) * Math.max(0, y1 - y0 + 1);
      if (touched > kMostEntries && film.tile < kLargestTile) return false;
      for (let y = y0; y <= y1; ++y) for (let x = x0; x <= x1; ++x) ++count[y * columns + x];
    }

    this.columns = columns, this.rows = rows;
    this.tiles = new Uint32Array(4 * columns * rows);
    let entries = 0;
    for (let tile = 0; tile < columns * rows; ++tile)
      for (const kind of [0, 1]) {
        this.tiles[4 * tile + 2 * kind] = entries;
        entries += counts[kind][tile];
      }
    this.list = new Uint32Array(2 * Math.max(1, entries));
    const nearest = new Float32Array(1), bits = new Uint32Array(nearest.buffer);
    for (let i = 0; i < order.length; ++i) {
      const body = order[i], kind = state[body] - 1;
      nearest[0] = placed.nearest[body];
      const x0 = rectangles[4 * i], x1 = rectangles[4 * i + 1];
      for (let y = rectangles[4 * i + 2]; y <= rectangles[4 * i + 3]; ++y)
        for (let x = x0; x <= x1; ++x) {
          const tile = 4 * (y * columns + x) + 2 * kind;
          const entry = 2 * (this.tiles[tile] + this.tiles[tile + 1]++);
          this.list[entry] = body;
          this.list[entry + 1] = bits[0];
        }
    }
    return true;
  }

  /// The tiles [x0, x1, y0, y1] that a rectangle of slopes touches, from the bottom left.
  rectangle([x0, x1, y0, y1], film, columns, rows) {
    const column = (slope, add) =>
      clamp(Math.floor((film.width / 2 + slope / film.pixel + add) / film.tile), -1, columns);
    const row = (slope, add) =>
      clamp(Math.floor((film.height / 2 + slope / film.pixel + add) / film.tile), -1, rows);
    // A pixel more on each side for rounding.
    const touched = [column(x0, -1), column(x1, 1), row(y0, -1), row(y1, 1)];
    return [Math.max(0, touched[0]), Math.min(columns - 1, touched[1]), Math.max(0, touched[2]),
            Math.min(rows - 1, touched[3])];
  }
}

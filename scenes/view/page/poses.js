"use strict";
// How the bodies move: reads what pose_tracks.hpp describes.

function bytesOfBase64(text) {
  const binary = atob(text), bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

class Poses {
  /// @param times   of the moments, ascending [s]
  constructor(bytes, times) {
    const [count] = new Uint32Array(bytes.buffer, 0, 2);
    let at = 8;
    const take = (Type, length) => {
      const array = new Type(bytes.buffer, at, length);
      at += array.byteLength;
      return array;
    };
    this.count = count;
    this.times = times;
    this.positionLow = take(Float64Array, 4 * count);
    this.turnLow = take(Float32Array, 8 * count);
    this.steps = take(Float32Array, 2 * count);
    this.id = take(Uint32Array, count);
    this.type = take(Uint32Array, count);
    this.bits = take(Uint8Array, 12 * count);
    this.words = take(Uint32Array, (bytes.length - at) / 4);
    this.firstBit = new Float64Array(count);
    for (let body = 0, bit = 0; body < count; ++body) {
      this.firstBit[body] = bit;
      for (let i = 0; i < 12; ++i) bit += times.length * this.bits[12 * body + i];
    }
    this.cache = new Map();
    this.position = new Float64Array(4 * count);  // world [m]
    this.turn = new Float64Array(8 * count);      // two unit quaternions
  }

  bitsAt(bit, count) {
    const word = Math.floor(bit / 32), shift = bit % 32;
    let value = this.words[word] >>> shift;
    if (shift + count > 32) value |= this.words[word + 1] << (32 - shift);
    return count === 32 ? value >>> 0 : value & ((1 << count) - 1);
  }

  /// The first `numbers` of 12 of a body's pose at a moment, into out[at], ...
  read(body, moment, numbers, out, at) {
    const moments = this.times.length;
    let bit = this.firstBit[body];
    for (let i = 0; i < numbers; ++i) {
      const bits = this.bits[12 * body + i];
      let value = i < 4 ? this.positionLow[4 * body + i] : this.turnLow[8 * body + i - 4];
      if (bits > 0) {
        value += this.bitsAt(bit + moment * bits, bits) * this.steps[2 * body + (i < 4 ? 0 : 1)];
        bit += moments * bits;
      }
      out[at + i] = value;
    }
  }

  /// All bodies' numbers at a moment; the last ones asked for are kept.
  numbersAt(moment) {
    let numbers = this.cache.get(moment);
    if (!numbers) {
      numbers = new Float64Array(12 * this.count);
      for (let body = 0; body < this.count; ++body) this.read(body, moment, 12, numbers, 12 * body);
      if (this.cache.size >= 4) this.cache.delete(this.cache.keys().next().value);
      this.cache.set(moment, numbers);
    }
    return numbers;
  }

  /// Where a time lies: between moment `first` and the next, that part of the way.
  instant(time) {
    const times = this.times, last = times.length - 1;
    if (!(time > times[0])) return {first: 0, part: 0};
    if (time >= times[last]) return {first: last, part: 0};
    let low = 0, high = last;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle;
      else high = middle;
    }
    return {first: low, part: (time - times[low]) / (times[low + 1] - times[low])};
  }

  /// Sets `position` and `turn` to those of a time: positions on straight lines between moments,
  /// rotations the shortest way.
  moveTo(time) {
    const {first, part} = this.instant(time);
    const before = this.numbersAt(first), after = part > 0 ? this.numbersAt(first + 1) : before;
    for (let body = 0; body < this.count; ++body) {
      const at = 12 * body;
      for (let i = 0; i < 4; ++i)
        this.position[4 * body + i] = before[at + i] + part * (after[at + i] - before[at + i]);
      for (const half of [0, 4]) {
        let square = 0;
        for (let i = 0; i < 4; ++i) {
          const k = at + 4 + half + i, value = before[k] + part * (after[k] - before[k]);
          this.turn[8 * body + half + i] = value;
          square += value * value;
        }
        const scale = 1 / Math.sqrt(square);
        for (let i = 0; i < 4; ++i) this.turn[8 * body + half + i] *= scale;
      }
    }
  }

  /// A body's mean velocity between the moments about a time [m/s].
  velocity(body, time) {
    const {first} = this.instant(time), last = this.times.length - 1;
    if (last === 0) return [0, 0, 0, 0];
    const from = Math.min(first, last - 1), a = [], b = [];
    this.read(body, from, 4, a, 0);
    this.read(body, from + 1, 4, b, 0);
    return times(1 / (this.times[from + 1] - this.times[from]), minus(b, a));
  }
}

/// A direction of the world as a body sees it: R~ v R, by the two quaternions at turn[at], ...; into
/// out[place], ...
function turnBack(turn, at, v0, v1, v2, v3, out, place) {
  let s = turn[at], x = turn[at + 1], y = turn[at + 2], z = turn[at + 3];
  const a0 = s * v0 - x * v1 - y * v2 - z * v3, a1 = x * v0 + s * v1 + z * v2 - y * v3;
  const a2 = y * v0 - z * v1 + s * v2 + x * v3, a3 = z * v0 + y * v1 - x * v2 + s * v3;
  s = turn[at + 4], x = turn[at + 5], y = turn[at + 6], z = turn[at + 7];
  out[place] = s * a0 - x * a1 - y * a2 - z * a3;
  out[place + 1] = x * a0 + s * a1 - z * a2 + y * a3;
  out[place + 2] = y * a0 + z * a1 + s * a2 - x * a3;
  out[place + 3] = z * a0 - y * a1 + x * a2 + s * a3;
}

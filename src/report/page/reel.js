// The frames of the run: report.frames, which stands in the page as base64. src/report/stream.hpp says how numbers are
// packed.

const LEVELS = 65534; // between the smallest and the largest value of an array

function bytesOfBase64(text) {
  const letters = atob(text.trim());
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/// The values of an array, from its bytes before deflation.
function valuesOf(bytes, [along, ...others], min, max) {
  const size = along * others[0] * others[1];
  const level = new Uint16Array(size); // counts modulo 65536, as the rule of prediction does
  const values = new Float64Array(size);
  for (let i = 0, x = 0; i < size; ++i) {
    const code = bytes[i] | (bytes[size + i] << 8);
    const expected =
      x > 1 ? 2 * level[i - 1] - level[i - 2] : x === 1 ? level[i - 1] : i === 0 ? 0 : level[i - along];
    level[i] = expected + ((code >> 1) ^ -(code & 1));
    const s = (level[i] - 1) / LEVELS;
    values[i] = level[i] === 0 ? NaN : (1 - s) * min + s * max;
    if (++x === along) x = 0;
  }
  return values;
}

class Reel {
  constructor(bytes) {
    const ascii = new TextDecoder();
    const start = 8 + 9 + parseInt(ascii.decode(bytes.subarray(8, 16)), 16);
    const head = JSON.parse(ascii.decode(bytes.subarray(17, start)));
    Object.assign(this, head);
    this.body = bytes.subarray(start);
    this.size = bytes.length;
    this.shape = this.points.map((points) => Math.ceil(points / this.every_point));
    this.step = this.spacing * this.every_point;
    this.kept = new Map(); // arrays that were unpacked, the oldest first
  }

  stream(frame, name) {
    return this.frames[frame].streams.find((stream) => stream.name === name);
  }

  has(name) {
    return this.frames.some((frame) => frame.streams.some((stream) => stream.name === name));
  }

  /// Of all frames, without the particles and arrows.
  fieldNames() {
    const names = this.frames.flatMap((frame) => frame.streams.map((stream) => stream.name));
    return [...new Set(names)].filter((name) => !/^(particles|arrows)\./.test(name));
  }

  /// Of all frames.
  rangeOf(name) {
    const streams = this.frames.flatMap((frame) => frame.streams.filter((stream) => stream.name === name));
    return [Math.min(...streams.map((stream) => stream.min)), Math.max(...streams.map((stream) => stream.max))];
  }

  /// How wrong rounding makes a value at most.
  roundingOf(frame, name) {
    const stream = this.stream(frame, name);
    return stream ? (stream.max - stream.min) / (2 * LEVELS) : 0;
  }

  /// A promise of the values; null where the frame has none.
  async values(frame, name) {
    const stream = this.stream(frame, name);
    if (!stream) return null;
    const key = `${frame} ${name}`;
    let values = this.kept.get(key);
    if (!values) {
      const bytes = await inflated(this.body.subarray(stream.at, stream.at + stream.bytes));
      values = valuesOf(bytes, stream.shape, stream.min, stream.max);
    }
    this.kept.delete(key);
    this.kept.set(key, values);
    const most = Math.max(16, Math.floor(8e6 / values.length)); // arrays: 64 MB or so
    while (this.kept.size > most) this.kept.delete(this.kept.keys().next().value);
    return values;
  }

  coordinate(axis, index) {
    return this.origin[axis] + index * this.step;
  }
}

// The data of the page, and the state of all bodies at any time between the stored frames.
// experiments/view/view_page.cpp describes the parts of the data.

const part = (id) => document.getElementById("replay-" + id);

// The numbers of a part, as a typed array; its bytes are all first ones, then all second ones, ...
async function numbersOf(name, Type) {
  const holder = part(name), packed = holder ? await unpacked(holder) : new Blob();
  const bytes = new Uint8Array(await packed.arrayBuffer());
  const size = Type.BYTES_PER_ELEMENT, count = bytes.length / size;
  const whole = new Uint8Array(bytes.length);
  for (let b = 0; b < size; ++b)
    for (let k = 0; k < count; ++k) whole[size * k + b] = bytes[b * count + k];
  return new Type(whole.buffer);
}

// Decodes zigzag differences, stored column after column, to values[frame * columns + column].
// `order` is how often differences were taken.
function historyOf(codes, columns, order) {
  const values = new codes.constructor(codes.length);
  const frames = columns ? codes.length / columns : 0;
  for (let c = 0, at = 0; c < columns; ++c) {
    let value = 0, slope = 0;
    for (let f = 0; f < frames; ++f, ++at) {
      const difference = (codes[at] >> 1) ^ -(codes[at] & 1);
      slope = order === 2 ? slope + difference : difference;
      value += slope;
      values[f * columns + c] = value;  // modulo 2^16 or 2^8
    }
  }
  return values;
}

// The index of the last of growing times not after `time`, and the share of the way to the next.
function placeIn(times, time) {
  let low = 0, high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle; else high = middle;
  }
  const span = high > low ? times[high] - times[low] : 0;
  return [low, span ? clamp((time - times[low]) / span, 0, 1) : 0];
}

class Data {
  static async load() {
    const kinds = { shapes: Uint16Array, masses: Float32Array, positions: Uint16Array,
      rotations: Uint16Array, velocities: Uint8Array, laps: Int16Array, walls: Float32Array,
      series: Float32Array, contact_bodies: Int32Array, contact_places: Uint8Array,
      contact_forces: Uint16Array, contact_mobilised: Uint8Array, errors: Uint8Array };
    const parts = Object.fromEntries(await Promise.all(Object.entries(kinds).map(
      async ([name, kind]) => [name, await numbersOf(name, kind)])));
    return new Data(JSON.parse(part("head").textContent), parts);
  }

  constructor(head, parts) {
    this.head = head;
    this.grains = head.grains;
    this.times = head.times;
    this.begin = head.times[0];
    this.end = head.times.at(-1);
    const columns = 3 * head.grains;
    this.positions = historyOf(parts.positions, columns, 2);
    this.rotations = historyOf(parts.rotations, 4 * head.grains, 2);
    this.velocities = historyOf(parts.velocities, columns, 1);
    this.laps = historyOf(parts.laps, head.grains, 1);
    this.mass = parts.masses.filter((_, k) => k % 2 === 0);
    this.size = parts.masses.filter((_, k) => k % 2)
      .map((volume) => Math.cbrt(6 * volume / Math.PI));
    this.wallStates = parts.walls;
    this.readShapes(parts.shapes);
    this.readSeries(parts.series);
    this.readContacts(parts);
    this.errors = parts.errors;
    // position, colour value and quaternion of every grain, from which the picture is drawn
    this.state = new Float32Array(8 * 512 * Math.ceil(Math.max(head.grains, 1) / 512));
    this.measureBox();
  }

  readShapes(words) {
    let at = 0;
    this.shapes = Array.from({ length: this.head.shapes }, () => {
      const corners = words[at++], faces = new Array(words[at++]);
      for (let f = 0; f < faces.length; ++f, at += words[at] + 1)
        faces[f] = Array.from(words.subarray(at + 1, at + 1 + words[at]));
      const vertices = new Int16Array(words.subarray(at, at += 3 * corners));
      return { vertices, faces };
    });
  }

  readSeries(values) {
    const rows = this.head.rows;
    this.seriesTime = values.subarray(0, rows);
    this.series = Object.fromEntries(this.head.series.map((series, k) => [series.name,
      { ...series, values: values.subarray((k + 1) * rows, (k + 2) * rows) }]));
  }

  readContacts(parts) {
    const steps = parts.contact_bodies, count = steps.length / 2;
    const a = new Int32Array(count), b = new Int32Array(count);
    const reach = this.shapes.map(({ vertices }) => {
      let square = 0;
      for (let v = 0; v < vertices.length; v += 3)
        square = Math.max(square, vertices[v] ** 2 + vertices[v + 1] ** 2 + vertices[v + 2] ** 2);
      return Math.sqrt(square) / 32767 * this.head.scale;
    });
    this.reach = this.head.shape_of.map((shape) => reach[shape]);
    const force = parts.contact_forces, strength = new Float32Array(count);
    let at = 0;
    this.contactFrames = (this.head.contact_frames || []).map((frame, k) => {
      const begin = at, end = begin + this.head.contact_counts[k];
      for (let last = 0; at < end; ++at) {
        last = a[at] = last + steps[at];
        b[at] = a[at] + steps[count + at];
        strength[at] = (force[at] / 4095) ** 2 * this.head.largest_force;
      }
      return { frame, begin, end };
    });
    this.contact = { a, b, force: strength, places: parts.contact_places, count,
      mobilised: parts.contact_mobilised };
  }

  // The centre of a grain, and the place of a contact, in the state: it moves with its grain a.
  centreOf(grain) {
    return Array.from(this.state.subarray(8 * grain, 8 * grain + 3));
  }
  contactPlace(c) {
    const { a, places, count } = this.contact, g = a[c], reach = 1.02 * this.reach[g] / 127;
    return [0, 1, 2].map((k) => this.state[8 * g + k] + (places[k * count + c] - 128) * reach);
  }

  // The stored contacts nearest in time; an empty range where the run stored none.
  contactsAt(time) {
    const away = ({ frame }) => Math.abs(this.times[frame] - time);
    let best = null;
    for (const frame of this.contactFrames)
      if (!best || away(frame) < away(best)) best = frame;
    return best || { begin: 0, end: 0, frame: -1 };
  }

  // The frame at or before a time, and the share of the way to the next.
  frameAt(time) {
    const [frame, u] = placeIn(this.times, time), next = Math.min(frame + 1, this.times.length - 1);
    return { frame, next, span: this.times[next] - this.times[frame], u };
  }

  // Coordinate k of a grain, with all periods that it has crossed: it never jumps by a period.
  positionOf(frame, g, k) {
    const n = frame * this.grains + g, { low, span, period } = this.head;
    return low[k] + this.positions[3 * n + k] / 65535 * span[k] +
      (period ? this.laps[n] * period[k] : 0);
  }
  // x less whole periods: inside the first period, or with `ahead` 0.5 the shortest equivalent way.
  wrapped(x, ahead = 0) {
    const { period } = this.head;
    return period ?
      sub(x, times(period, Math.floor(dot(x, period) / dot(period, period) + ahead))) : x;
  }
  // Coordinate k of a grain's velocity; 8 bits hold the signed square root of its share of fastest.
  velocityOf(frame, g, k) {
    const root = (this.velocities[3 * (frame * this.grains + g) + k] - 128) / 127;
    return root * Math.abs(root) * this.head.fastest;
  }
  rotationOf(frame, g, out = [0, 0, 0, 0]) {
    for (let k = 0; k < 4; ++k)
      out[k] = this.rotations[4 * (frame * this.grains + g) + k] / 32767.5 - 1;
    return out;
  }

  // Fills in the state at a time: positions by Hermite's cubic through positions and velocities,
  // rotations by normalised linear interpolation, the shorter way round.
  moveTo(time, valueOf) {
    this.now = time;  // the time of the state
    const { frame, next, span, u } = this.frameAt(time), state = this.state;
    const u2 = u * u, u3 = u2 * u;
    const h00 = 2 * u3 - 3 * u2 + 1, h10 = (u3 - 2 * u2 + u) * span;
    const h01 = 3 * u2 - 2 * u3, h11 = (u3 - u2) * span;
    const p = [0, 0, 0, 0], q = [0, 0, 0, 0];
    for (let g = 0; g < this.grains; ++g) {
      const at = 8 * g;
      for (let k = 0; k < 3; ++k)
        p[k] = h00 * this.positionOf(frame, g, k) + h10 * this.velocityOf(frame, g, k) +
          h01 * this.positionOf(next, g, k) + h11 * this.velocityOf(next, g, k);
      const place = this.wrapped(p);
      for (let k = 0; k < 3; ++k) state[at + k] = place[k];
      this.rotationOf(frame, g, p);
      this.rotationOf(next, g, q);
      const same = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3] < 0 ? -u : u;
      let square = 0;
      for (let k = 0; k < 4; ++k) {
        state[at + 4 + k] = p[k] * (1 - u) + q[k] * same;
        square += state[at + 4 + k] ** 2;
      }
      for (let k = 4; k < 8; ++k) state[at + k] /= Math.sqrt(square);
      state[at + 3] = valueOf(g, frame, next, u);
    }
  }

  // A curve's value at a time; before its first row the value of that row.
  seriesAt(name, time) {
    const [row, u] = placeIn(this.seriesTime, time), { values } = this.series[name];
    return values[row] + (u && (values[row + 1] - values[row]) * u);
  }

  // A point of wall w at a time. The driven wall follows its curve of all steps, not the frames.
  wallAt(w, time) {
    const wall = this.head.walls[w], frames = this.times.length;
    const stored = (frame, k) => this.wallStates[6 * (w * frames + frame) + k];
    if (wall.driven && this.series.x) {
      // x at the first frame; 0 if that frame comes before the first row of the curve
      const first = this.begin < this.seriesTime[0] ? 0 : this.seriesAt("x", this.begin);
      const outward = (this.seriesAt("x", time) - first) * 1e-3;
      return [0, 1, 2].map((k) => stored(0, k) - wall.normal[k] * outward);
    }
    const { frame, next, span, u } = this.frameAt(time);
    return [0, 1, 2].map((k) => stored(frame, k) + (stored(next, k) - stored(frame, k)) * u +
      u * (1 - u) * span * ((1 - u) * (stored(frame, 3 + k)) - u * stored(next, 3 + k) +
        (2 * u - 1) * (span ? (stored(next, k) - stored(frame, k)) / span : 0)));
  }

  // The box that holds everything. Walls bound it where there are any, else the bodies do.
  measureBox() {
    const { low, span } = this.head, most = this.reach.reduce((a, b) => Math.max(a, b), 0.001);
    this.low = low.map((v) => v - 1.02 * most);
    this.high = low.map((v, k) => v + span[k] + 1.02 * most);
    const free = [...this.low, ...this.high];
    this.head.walls.forEach((wall, w) => {
      for (let k = 0; k < 3; ++k) {
        if (Math.abs(wall.normal[k]) < 0.999) continue;
        const edge = (of) => this.times.map((t) => this.wallAt(w, t)[k]).reduce((a, b) => of(a, b));
        // a wall far from the bodies, as a lid far above them, does not bound the picture
        if (wall.normal[k] > 0) this.low[k] = Math.max(edge(Math.min), free[k] - 2 * most);
        else this.high[k] = Math.min(edge(Math.max), free[3 + k] + 2 * most);
      }
    });
    // a wall moves if it goes more than a thousandth of the box's diagonal or the load drives it
    const least = 1e-3 * norm(sub(this.high, this.low));
    this.wallMoves = this.head.walls.map((wall, w) => wall.driven || this.times.some((t) =>
      norm(sub(this.wallAt(w, t), this.wallAt(w, this.begin))) > least));
    this.centre = times(add(this.low, this.high), 0.5);
    this.radius = 0.5 * norm(sub(this.high, this.low));
  }
}

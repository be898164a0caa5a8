// The quantities that colour the grains: for each choice the ramp, the words of the legend, and the
// share of the ramp that a grain gets.

// About `count` of many elements, evenly spaced.
const sampled = (all, count) =>
  all.filter((_, k) => k % Math.max(1, Math.floor(all.length / count)) === 0);

// A quantile of the finite values; of many values only a sample is taken.
const quantile = (values, share) => {
  const sorted = Float32Array.from(sampled(values, 20000)).filter(Number.isFinite).sort();
  return sorted.length ? sorted[Math.floor(share * (sorted.length - 1))] : 0;
};

class Shades {
  constructor(data) {
    this.data = data;
    const { head } = data, last = data.times.length - 1;
    // the top of a scale: nearly all grains at nearly all times lie below. Many are only sampled.
    const topOf = (of) => {
      const values = [], every = Math.max(1, Math.floor(head.grains / 5000));
      for (let f = 0; f <= last; f += Math.max(1, Math.floor(last / 20)))
        for (let g = 0; g < head.grains; g += every) values.push(of(g, f));
      return quantile(values, 0.999) || 1;
    };
    const changing = (of) =>
      ({ top: topOf(of), value: (g, f, n, u) => of(g, f) * (1 - u) + of(g, n) * u });
    const sums = sampled(data.contactFrames, 12).flatMap((frame) => [...this.forcesIn(frame)]);
    const smallest = data.size.reduce((a, b) => Math.min(a, b), Infinity);
    const largest = data.size.reduce((a, b) => Math.max(a, b), 0);
    const root = { share: (v, most) => Math.sqrt(v / most), ramp: "heat" };
    const even = { share: (v, most) => v / most, ramp: "heat" };
    this.choices = {
      speed: { words: "speed", unit: "m/s", factor: 1, ...root,
        ...changing((g, f) => this.speed(g, f)) },
      displacement: { words: "displacement since the start", unit: "mm", factor: 1e3,
        ...even, ...changing((g, f) => this.moved(g, f)) },
      rotation: { words: "rotation since the start", unit: "\u00b0", factor: 180 / Math.PI,
        ...even, ...changing((g, f) => this.turnedBy(g, f)) },
      force: { words: "force carried", unit: "N", factor: 1, ...root,
        top: quantile(sums, 0.995) || 1, value: (g) => this.carried ? this.carried[g] : 0 },
      size: { words: "size class: diameter of the sphere of equal volume", unit: "mm",
        factor: 1e3, top: largest, bottom: smallest, ramp: "water",
        share: (v) => largest > smallest ?
          (Math.min(4, Math.floor(5 * (v - smallest) / (largest - smallest))) + 0.5) / 5 : 0.5,
        value: (g) => data.size[g] },
      none: { words: "", ramp: "stone", top: 1, share: (v) => v, value: (g) => (g * 0.618034) % 1 },
    };
    if (!data.contactFrames.length) delete this.choices.force;
  }

  speed(g, f) {
    return norm([0, 1, 2].map((k) => this.data.velocityOf(f, g, k)));
  }
  moved(g, f) {
    return Math.hypot(...[0, 1, 2].map((k) =>
      this.data.positionOf(f, g, k) - this.data.positionOf(0, g, k)));
  }
  turnedBy(g, f) {
    const p = this.data.rotationOf(0, g), q = this.data.rotationOf(f, g);
    const same = Math.abs(p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]);
    return same > 0.999999 ? 0 : 2 * Math.acos(Math.min(1, same));
  }

  // Half the sum of the normal forces on each grain: the force that passes through it.
  forcesIn(frame) {
    const { a, b, force } = this.data.contact, sum = new Float32Array(this.data.grains);
    for (let c = frame.begin; c < frame.end; ++c) {
      sum[a[c]] += 0.5 * force[c];
      if (b[c] < sum.length) sum[b[c]] += 0.5 * force[c];
    }
    return sum;
  }

  // Moves the data to a time, coloured by the choice `name`, and returns its ramp.
  apply(name, time) {
    const choice = this.choices[name], { data } = this;
    if (name === "force") {
      const frame = data.contactsAt(time);
      if (this.carriedAt !== frame.frame) this.carried = this.forcesIn(frame);
      this.carriedAt = frame.frame;
    }
    data.moveTo(time, (g, f, n, u) => choice.share(choice.value(g, f, n, u), choice.top));
    return ramps[choice.ramp];
  }

  // The places and words of the legend's ticks: [share, text].
  ticks(name) {
    const { top, bottom = 0, factor = 1, share } = this.choices[name], ticks = [];
    if (name === "none") return ticks;
    if (name === "size") {
      if (top === bottom) return [[0, shown(factor * top, 3)]];
      return [0, 1, 2, 3, 4, 5].map((k) =>
        [k / 5, shown(factor * (bottom + (top - bottom) * k / 5), 3)]);
    }
    const step = niceStep(factor * top, name === "speed" || name === "force" ? 8 : 5);
    for (let v = 0; v <= factor * top * 1.0001; v += step)
      ticks.push([share(v / factor, top), shown(v, 3)]);
    return ticks;
  }
}

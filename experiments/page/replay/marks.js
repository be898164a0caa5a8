// The marks besides the grains: walls and their edges, the load, force chains, contact points.

// The part of a plane through `point` that lies in the box low .. high, as a loop of corners.
function planeInBox(point, normal, low, high) {
  const side = perpendicular(normal), other = cross(normal, side);
  const wide = 4 * norm(sub(high, low));
  let loop = [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([a, b]) =>
    add(point, add(times(side, a * wide), times(other, b * wide))));
  for (let k = 0; k < 3; ++k)
    for (const [sign, bound] of [[1, high[k]], [-1, -low[k]]]) {
      // Sutherland and Hodgman 1974; the box is slightly wider, so that its own walls stay in
      const room = (p) => bound + 1e-6 * wide - sign * p[k], kept = [];
      loop.forEach((p, at) => {
        const q = loop[(at + 1) % loop.length], rp = room(p), rq = room(q);
        if (rp >= 0) kept.push(p);
        if (rp * rq < 0) kept.push(add(p, times(sub(q, p), rp / (rp - rq))));
      });
      loop = kept;
    }
  return { loop, side, other };
}

// Appends a rod to a list of numbers.
const addRod = (rods, from, fromRadius, to, toRadius, colour, alpha = 1) =>
  rods.push(...from, fromRadius, ...to, toRadius, ...colour, alpha);

class Marks {
  constructor(data) {
    this.data = data;
    const f = data.series.f;
    this.topLoad = f ? f.values.reduce((a, v) => Math.max(a, Math.abs(v)), 0) || 1 : 1;
    const chains = sampled(data.contactFrames, 10).flatMap((frame) => this.chainsIn(frame));
    this.topChain = quantile(chains.map((chain) => chain[2]), 0.995) || 1;
    this.meanReach = data.reach.reduce((sum, r) => sum + r, 0) / Math.max(1, data.grains);
  }

  // Forces between pairs of bodies: [a, b, sum of normal forces, one of its contacts].
  chainsIn(frame) {
    const { a, b, force } = this.data.contact, chains = [];
    let last = null;
    for (let c = frame.begin; c < frame.end; ++c) {
      if (!last || last[0] !== a[c] || last[1] !== b[c])
        chains.push(last = [a[c], b[c], 0, c]);
      last[2] += force[c];
    }
    return chains;
  }

  // Fills in the look's planes and returns its rods. `options` are the reader's choices; `errors`
  // adds the balls of `picture`.
  build(time, look, options, colours, errors, picture) {
    const rods = [];
    look.planes = [];
    this.addWalls(time, look, rods, colours);
    if (options.chains) this.addChains(time, rods, options, look.cut);
    if (options.points) this.addPoints(time, rods, options, look.cut);
    if (errors.isOn) errors.addBalls(rods, picture, this, look.cut);
    return rods;
  }

  addWalls(time, look, rods, colours) {
    const { data } = this, { low, high, centre, radius } = data, ground = [];
    const thin = isDark(look.paper) ? 0.4 : 1;  // light colours cover more on dark ground
    look.cell = niceStep(2 * radius, 8);
    const reach = 2.7 * radius;
    for (let k = 0; k < 40; ++k) {
      const angle = 2 * Math.PI * k / 40;
      ground.push(centre[0] + reach * Math.cos(angle), centre[1] + reach * Math.sin(angle), low[2],
        0, 0);
    }
    look.planes.push({ corners: new Float32Array(ground), tint: [...look.paper, 1],
      ground: [centre[0], centre[1], reach] });
    data.head.walls.forEach((wall, w) => {
      const point = data.wallAt(w, time);
      const { loop, side, other } = planeInBox(point, wall.normal, low, high);
      if (loop.length < 3) return;
      const corners = loop.flatMap((p) =>
        [...p, dot(sub(p, point), side), dot(sub(p, point), other)]);
      // walls that move are blue
      const moves = data.wallMoves[w], colour = moves ? colours.blue : colours.grey;
      look.planes.push({ corners: new Float32Array(corners),
        tint: [...colour, thin * (moves ? 0.24 : 0.07)] });
      loop.forEach((p, k) => addRod(rods, p, moves ? -1.1 : -0.75,
        loop[(k + 1) % loop.length], moves ? -1.1 : -0.75, colour, moves ? 0.9 : 0.6));
      if (wall.driven && data.series.f) this.addLoad(time, wall, loop, rods, colours);
    });
  }

  // Adds the load as an arrow onto the driven wall.
  addLoad(time, wall, loop, rods, colours) {
    const { radius } = this.data, share = this.data.seriesAt("f", time) / this.topLoad;
    const middle = times(loop.reduce((sum, p) => add(sum, p), [0, 0, 0]), 1 / loop.length);
    const tail = sub(middle, times(wall.normal, (0.08 + 0.5 * Math.abs(share)) * radius));
    const neck = sub(middle, times(wall.normal, 0.09 * radius)), colour = colours.vermilion;
    this.load = { tail, middle };
    addRod(rods, tail, 0.009 * radius, neck, 0.009 * radius, colour);
    addRod(rods, neck, 0.028 * radius, middle, 0.001 * radius, colour);
  }

  addChains(time, rods, { threshold }, cut) {
    const chains = this.chainsIn(this.data.contactsAt(time));
    const mean = chains.reduce((sum, chain) => sum + chain[2], 0) / Math.max(1, chains.length);
    this.shownChains = 0;
    for (const [a, b, force, c] of chains) {
      if (force < threshold * mean) continue;
      const { data } = this, from = data.centreOf(a);
      const to = b < data.grains ?
        add(from, data.wrapped(sub(data.centreOf(b), from), 0.5)) : data.contactPlace(c);
      if (cut && dot(cut, from) > cut[3] && dot(cut, to) > cut[3]) continue;
      const width = 0.24 * this.meanReach * Math.min(force / this.topChain, 1.3);
      addRod(rods, from, width, to, width,
        colourAt(markRamps.heat, 0.25 + 0.65 * Math.sqrt(force / this.topChain)));
      ++this.shownChains;
    }
  }

  // Adds the contact points, coloured by the share of friction that is used.
  addPoints(time, rods, { picked }, cut) {
    const { begin, end } = this.data.contactsAt(time), { a, b, mobilised } = this.data.contact;
    const size = this.meanReach;
    for (let c = begin; c < end; ++c) {
      if (picked >= 0 && a[c] !== picked && b[c] !== picked) continue;
      const place = this.data.contactPlace(c);
      if (cut && dot(cut, place) > cut[3]) continue;
      const colour = colourAt(markRamps.water, 0.15 + 0.85 * mobilised[c] / 255);
      addRod(rods, place, 0.09 * size, place, 0.09 * size, colour);
    }
  }
}

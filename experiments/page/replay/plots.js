// The curves of a run, with a cursor at the time of the picture.

class Plots {
  constructor(place, data, goTo) {
    this.data = data;
    place.innerHTML = "<svg></svg>".repeat(data.head.plots.length);
    this.panels = data.head.plots.map((plot, k) => this.panel(plot, place.children[k]));
    for (const panel of this.panels) {
      const { picture } = panel;
      const jump = (event) => {
        const { left, top } = picture.getBoundingClientRect();
        goTo(this.timeAt(panel, event.clientX - left, event.clientY - top));
      };
      picture.addEventListener("pointerdown", (event) => {
        picture.setPointerCapture(event.pointerId);
        jump(event);
      });
      picture.addEventListener("pointermove", (event) => { if (event.buttons) jump(event); });
    }
    this.layOut();
  }

  // The curves of a plot and the ranges of its axes.
  panel(plot, picture) {
    const series = plot.series.map((name) => this.data.series[name]);
    const over = this.data.series[plot.over], across = over ? over.values : this.data.seriesTime;
    const range = (values) => {
      let low = Infinity, high = -Infinity;
      for (const v of values)
        if (Number.isFinite(v)) [low, high] = [Math.min(low, v), Math.max(high, v)];
      return high > low ? [low, high] : [low - 0.5, low + 0.5];
    };
    const [left, right] = over ? range(across) : [this.data.begin, range(across)[1]];
    // the top of the range leaves out the spikes of a few steps, which are cut off
    const all = series.flatMap((s) => range(s.values));
    const tops = series.map((s) => 1.25 * quantile(s.values, 0.995));
    const lows = Math.min(...all);
    const high = Math.min(Math.max(...all), Math.max(...tops, lows + 1e-9));
    return { picture, series, over, across, left, right, high,
      low: lows > 0 && lows < 0.5 * high ? 0 : lows };
  }

  // Draws the curves as wide as there is room.
  layOut() {
    for (const panel of this.panels) {
      const { picture, series, over, across, left, right, low, high } = panel;
      const wide = picture.getBoundingClientRect().width - 66;
      const x = panel.x = (v) => 52 + (v - left) / (right - left) * wide;
      const y = panel.y = (v) => 136 - (v - low) / (high - low || 1) * 110;
      const text = (place, height, anchor, words) =>
        `<text x="${place}" y="${height}" text-anchor="${anchor}">${words}</text>`;
      const ticks = (from, to, drawn) => {
        const step = niceStep(to - from, 4), first = Math.ceil(from / step - 1e-9);
        const count = Math.floor(to / step + 1e-9) - first + 1;
        return Array.from({ length: count }, (_, k) => drawn((first + k) * step)).join("");
      };
      const ink = (one) => `var(--${series.length > 1 ? one.ink : "ink"})`;
      const title = ({ symbol, unit }) => {
        const [sign, index = ""] = symbol.split("_"), down = index && 3;
        return `${sign}<tspan dy="${+down}">${index}</tspan>` +
          `<tspan dy="${-down}"> ${unit && "/ " + unit}</tspan>`;
      };
      const line = (one) => Array.from(across, (v, k) => [x(v), y(one.values[k])])
        .filter((place) => place.every(Number.isFinite))
        .map((place) => place.map((v) => v.toFixed(1))).join("L");
      picture.innerHTML = ticks(low, high, (v) =>
        `<path class="grid" d="M52 ${Math.round(y(v)) + 0.5}h${wide}"/>` +
          text(46, y(v) + 4, "end", shown(v, 4))) +
        ticks(left, right, (v) => text(x(v), 152, "middle", shown(v, 4))) +
        text(52 + wide, 164, "end", over ? title(over) : "t / s") +
        text(52, 17, "start", series.map((one, k) =>
          `<tspan dx="${k && 14}" fill="${ink(one)}">${title(one)}</tspan>`).join("")) +
        `<svg x="51" y="23" width="${wide + 2}" height="115" viewBox="51 23 ${wide + 2} 115">` +
        series.map((one, k) => `<path d="M${line(one)}" stroke="var(--${one.ink})" ` +
          `stroke-width="${k === series.length - 1 ? 1.6 : 1}"/>`).join("") + "</svg>" +
        (over ? "" : '<path class="at" stroke="var(--ink)" d="M0.5 23V136"/>') +
        series.map((one) => `<circle class="at" r="4.5" fill="var(--${one.ink})"/>`).join("");
    }
  }

  // Moves the cursor to a time.
  draw(time) {
    for (const { picture, series, over, x, y } of this.panels) {
      const at = Math.round(x(over ? this.data.seriesAt(over.name, time) : time));
      const heights = series.map(({ name }) => Math.max(y(this.data.seriesAt(name, time)), 23));
      if (!over) heights.unshift(0);
      picture.querySelectorAll(".at").forEach((mark, k) => {
        mark.style.transform = `translate(${at}px,${heights[k]}px)`;
      });
    }
  }

  // The time of a place in a plot. In a plot over another series: the time of the nearest point.
  timeAt({ over, across, series, x, y, left, right }, px, py) {
    const end = x(right), begin = x(left);
    if (!over) return left + clamp((px - begin) / (end - begin), 0, 1) * (right - left);
    let nearest = 0, least = Infinity;
    for (let k = 0; k < across.length; ++k) {
      const away = (x(across[k]) - px) ** 2 + (y(series[0].values[k]) - py) ** 2;
      if (away < least) [nearest, least] = [k, away];
    }
    return this.data.seriesTime[nearest];
  }
}

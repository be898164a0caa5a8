// The curves of a run with one cursor: where the cursor stands is where the box is.

class Plots {
  constructor(canvas, data, goTo) {
    this.canvas = canvas;
    this.data = data;
    this.base = document.createElement("canvas");
    this.panels = [];
    const jump = (event) => {
      const box = canvas.getBoundingClientRect();
      const time = this.timeAt(event.clientX - box.left, event.clientY - box.top);
      if (time !== null) goTo(time);
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      jump(event);
    });
    canvas.addEventListener("pointermove", (event) => { if (event.buttons) jump(event); });
  }

  // A canvas of this size in the page's pixels, ready to draw on.
  paper(canvas, width, height) {
    const ratio = window.devicePixelRatio || 1;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.font = "12px system-ui, \"Segoe UI\", \"DejaVu Sans\", sans-serif";
    return pen;
  }

  // Places all plots beside each other, or below where there is no room, and draws the curves.
  layOut(colours) {
    const { plots } = this.data.head, width = this.canvas.clientWidth;
    const columns = Math.max(1, Math.min(plots.length, Math.floor(width / 250)));
    const high = 168, rows = Math.ceil(plots.length / columns);
    this.canvas.style.height = rows * high + "px";
    this.height = rows * high;
    this.width = width;
    this.colours = colours;
    const pen = this.paper(this.base, width, this.height);
    this.panels = plots.map((plot, k) => {
      const left = (k % columns) * width / columns + 52, top = Math.floor(k / columns) * high + 26;
      return this.panel(plot, { left, top, right: left + width / columns - 66,
        bottom: top + high - 58 });
    });
    for (const panel of this.panels) this.drawBase(pen, panel);
  }

  panel(plot, box) {
    const series = plot.series.map((name) => this.data.series[name]);
    const over = plot.over ? this.data.series[plot.over] : null;
    const across = over ? over.values : this.data.seriesTime;
    const range = (values) => {
      let low = Infinity, high = -Infinity;
      for (const v of values)
        if (Number.isFinite(v)) [low, high] = [Math.min(low, v), Math.max(high, v)];
      return high > low ? [low, high] : [low - 0.5, low + 0.5];
    };
    const [left, right] = over ? range(across) : [this.data.begin, range(across)[1]];
    // the top leaves out what single steps reach: spikes of a few steps are cut off
    const all = series.flatMap((s) => range(s.values));
    const tops = series.map((s) => 1.25 * quantile(s.values, 0.995));
    const lows = Math.min(...all);
    const high = Math.min(Math.max(...all), Math.max(...tops, lows + 1e-9));
    const low = lows > 0 && lows < 0.5 * high ? 0 : lows;
    return { plot, series, over, across, box,
      x: (v) => box.left + (v - left) / (right - left) * (box.right - box.left),
      y: (v) => box.bottom - (v - low) / (high - low || 1) * (box.bottom - box.top),
      left, right, low, high };
  }

  drawBase(pen, panel) {
    const { box, series, over, across, x, y, low, high, left, right } = panel;
    const { grid, soft, ink } = this.colours;
    pen.lineWidth = 1;
    pen.textAlign = "right";
    const step = niceStep(high - low, 4);
    for (let v = Math.ceil(low / step) * step; v <= high + 1e-9 * step; v += step) {
      pen.strokeStyle = grid.text;
      pen.beginPath();
      pen.moveTo(box.left, Math.round(y(v)) + 0.5);
      pen.lineTo(box.right, Math.round(y(v)) + 0.5);
      pen.stroke();
      pen.fillStyle = soft.text;
      pen.fillText(shown(v, 4), box.left - 6, y(v) + 4);
    }
    pen.textAlign = "center";
    const stride = niceStep(right - left, 4);
    for (let v = Math.ceil(left / stride - 1e-9) * stride; v <= right + 1e-9; v += stride)
      pen.fillText(shown(+v.toPrecision(6), 4), x(v), box.bottom + 16);
    pen.textAlign = "right";
    const [below, unit_] = over ? [over.symbol, over.unit] : ["t", "s"];
    pen.fillText(below + " / " + unit_, box.right, box.bottom + 28);
    // what is drawn, in its colour
    pen.textAlign = "left";
    let at = box.left;
    for (const one of series) {
      pen.fillStyle = series.length > 1 ? this.colours[one.ink].text : ink.text;
      at = 14 + this.write(pen, one.symbol, one.unit ? " / " + one.unit : "", at, box.top - 9);
    }
    pen.save();
    pen.beginPath();
    pen.rect(box.left - 1, box.top - 3, box.right - box.left + 2, box.bottom - box.top + 5);
    pen.clip();
    for (const one of series) {
      pen.strokeStyle = this.colours[one.ink].text;
      pen.lineWidth = one === series[series.length - 1] ? 1.6 : 1;
      pen.lineJoin = "round";
      pen.beginPath();
      for (let k = 0; k < across.length; ++k) pen.lineTo(x(across[k]), y(one.values[k]));
      pen.stroke();
    }
    pen.restore();
  }

  // A symbol with what follows its "_" set lower, then other words. Returns where they end.
  write(pen, symbol, words, x, y) {
    const [sign, index = ""] = symbol.split("_");
    for (const [text, down] of [[sign, 0], [index, 3], [words, 0]]) {
      pen.fillText(text, x, y + down);
      x += pen.measureText(text).width;
    }
    return x;
  }

  // The curves and where the time is on them.
  draw(time) {
    const pen = this.paper(this.canvas, this.width, this.height);
    pen.drawImage(this.base, 0, 0, this.width, this.height);
    for (const { plot, series, over, box, x, y } of this.panels) {
      const at = x(over ? this.data.seriesAt(plot.over, time) : time);
      pen.strokeStyle = this.colours.ink.text;
      pen.lineWidth = 1;
      if (!over) {
        pen.beginPath();
        pen.moveTo(at, box.top - 3);
        pen.lineTo(at, box.bottom);
        pen.stroke();
      }
      for (const one of series) {
        const value = this.data.seriesAt(one.name, time);
        pen.fillStyle = this.colours[one.ink].text;
        pen.strokeStyle = this.colours.paper.text;
        pen.lineWidth = 2;
        pen.beginPath();
        pen.arc(at, Math.max(y(value), box.top - 3), 4.5, 0, 2 * Math.PI);
        pen.fill();
        pen.stroke();
      }
    }
  }

  // The time that a place in the plots means; null between them. On a loop: the nearest of it.
  timeAt(px, py) {
    const panel = this.panels.find(({ box }) => px >= box.left - 12 && px <= box.right + 12 &&
      py >= box.top - 20 && py <= box.bottom + 24);
    if (!panel) return null;
    const { box, over, across, series, x, y, left, right } = panel;
    if (!over) return left + clamp((px - box.left) / (box.right - box.left), 0, 1) * (right - left);
    let nearest = 0, least = Infinity;
    for (let k = 0; k < across.length; ++k) {
      const away = (x(across[k]) - px) ** 2 + (y(series[0].values[k]) - py) ** 2;
      if (away < least) [nearest, least] = [k, away];
    }
    return this.data.seriesTime[nearest];
  }
}

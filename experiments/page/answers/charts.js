// One chart. Chart.js draws it; this module tells it what to draw, reads values out, handles keys.
//
// A figure is {title, x, y, curves, lines}. An axis is {label, log, min, max, low, high}: it goes
// from min to max where these are given, else at least from low to high; its label is HTML that the
// page wrote. A curve is {title, ink, dash, width, mark: "line" | "points" | "area", stepped,
// points}. A point is {x, y, ...} and has what `told(curve, point)` and `opened(point)` need; a
// point of an area has its lower bound `low`. A line is {value, vertical, label}. The legend
// switches all curves of one title together.

const charts = new Set();

// Inks are variables of the page's style sheet, which follow the reader's light or dark ground.
const inks = ["blue", "vermilion", "green", "orange", "purple", "sky", "ink", "grey"];
const dashes = [[], [8, 5], [4, 3], [1.5, 3]];

const variable = (name) =>
  getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();

/// The k-th backend's style: eight colours, then the same, dashed (backend_curve of live_page.cpp).
const curve_style = (k) => ({ ink: inks[k % inks.length],
                              dash: Math.floor(k / inks.length) % dashes.length });

const axis_of = (axis) => ({
  type: axis.log ? "logarithmic" : "linear",
  min: axis.min,
  max: axis.max,
  suggestedMin: axis.low,
  suggestedMax: axis.high,
  bounds: "ticks",
  border: { color: variable("grey") },
  // a logarithmic axis has more ticks than numbers: only ticks with numbers have grid lines
  grid: { color: ({ tick }) => (tick?.label ? variable("grid") : "transparent"), drawTicks: false,
          borderColor: variable("grey") },
  ticks: {
    color: variable("ink"),
    includeBounds: false,  // only round values have numbers
    padding: 6,
    autoSkipPadding: 12,
    maxRotation: 0,
    callback(value) {
      if (!axis.log) return minus(String(Number(value.toPrecision(6))));
      const power = Math.log10(value), places = Math.log10(this.max / this.min);
      const is_power = Number.isInteger(Math.round(power * 1e9) / 1e9);
      if (places >= 2) return is_power ? "10" + raised(Math.round(power)) : "";
      const first = value / 10 ** Math.floor(power), digit = Math.round(first);
      // the ends of the axis are ticks, too, and may not be round
      const is_round = Math.abs(first - digit) < 1e-6 && (places < 0.7 || [2, 5].includes(digit));
      return is_power || is_round ? number(value, 1) : "";
    },
  },
});

function dataset_of(curve) {
  const colour = variable(curve.ink), { mark = "line" } = curve, is_points = mark === "points";
  return {
    label: curve.title,
    data: curve.points,
    showLine: mark === "line",
    is_area: mark === "area",
    stepped: curve.stepped ? "before" : false,
    borderColor: colour,
    backgroundColor: colour,
    borderWidth: curve.width ?? 2,
    borderDash: dashes[curve.dash ?? 0],
    borderJoinStyle: "round",
    clip: 5,
    pointRadius: is_points || curve.marked ? 4 : 0,
    pointStyle: curve.dash ? "rectRot" : "circle",
    pointHoverRadius: 6,
    pointHoverBackgroundColor: colour,
    pointHoverBorderColor: variable("paper"),
    pointHitRadius: 8,
  };
}

/// Draws, below everything else, the areas between points and their lower bounds, then the error
/// bars of points.
const extents = {
  id: "extents",
  beforeDatasetsDraw(chart) {
    const { ctx, scales: { x, y }, chartArea: { left, top, width, height } } = chart;
    const level = (value) => y.getPixelForValue(Math.max(value, y.min));
    const shown = chart.data.datasets.map((set, k) => [set, chart.getDatasetMeta(k).data])
      .filter((_, k) => chart.isDatasetVisible(k));
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, top, width, height);
    ctx.clip();
    for (const [set] of shown.filter(([{ is_area }]) => is_area)) {
      const points = set.data.filter((point) => point.y !== null);
      ctx.fillStyle = set.borderColor;
      ctx.beginPath();
      for (const p of points) ctx.lineTo(x.getPixelForValue(p.x), level(p.y));
      for (const p of points.reverse()) ctx.lineTo(x.getPixelForValue(p.x), level(p.low));
      ctx.fill();
    }
    ctx.restore();
    for (const [set, places] of shown)
      places.forEach((place, k) => {
        const { y: value, error } = set.data[k];
        if (!(error > 0)) return;
        Object.assign(ctx, { strokeStyle: set.borderColor, lineWidth: 1.2 });
        ctx.beginPath();
        ctx.moveTo(place.x, Math.max(top, level(value - error)));
        ctx.lineTo(place.x, Math.max(top, level(value + error)));
        ctx.stroke();
      });
  },
};

/// A dashed line across the chart; it has no entry in the legend.
function line_of(line, chart_points) {
  const along = line.vertical ? "y" : "x", across = line.vertical ? "x" : "y";
  const places = chart_points.map((point) => point[along]).filter((place) => place !== null);
  return {
    label: "", is_line: true, line, showLine: true,
    pointRadius: 0, pointHitRadius: 0, pointHoverRadius: 0,
    data: extent(places).map((place) => ({ [along]: place, [across]: line.value })),
    borderColor: variable("grey"), borderWidth: 1.2, borderDash: [3, 4],
  };
}

/// Writes the labels of the lines across the chart at their right or upper ends.
const line_words = {
  id: "line_words",
  afterDatasetsDraw({ ctx, chartArea, data, scales: { x, y } }) {
    Object.assign(ctx, { fillStyle: variable("soft"), strokeStyle: variable("paper"),
                         lineWidth: 4 });
    const write = (words, place, height) => {
      ctx.strokeText(words, place, height);
      ctx.fillText(words, place, height);
    };
    ctx.font = `12px ${Chart.defaults.font.family}`;
    for (const { line } of data.datasets) {
      if (!line?.label) continue;
      const at = (line.vertical ? x : y).getPixelForValue(line.value);
      const is_left = line.vertical && at < (chartArea.left + chartArea.right) / 2;
      ctx.textAlign = is_left ? "left" : "right";
      if (line.vertical) write(line.label, at + (is_left ? 5 : -5), chartArea.top + 12);
      else if (at > chartArea.top) write(line.label, chartArea.right - 4, at - 5);
    }
  },
};

/// The x axis. A linear one ends where the curves end, unless its own ends are given.
function along_of({ x, curves }) {
  const places = curves.flatMap((curve) => curve.points.map((point) => point.x));
  if (x.log || !places.length) return x;
  const [low, high] = extent(places);
  return high > low ? { ...x, min: x.min ?? low, max: x.max ?? high } : x;
}

/// Returns a chart: {element, draw, refresh, gone}. `told` gives the words of a point; `opened`, if
/// there is one, is called for a point that is clicked. `hidden` is the name of the list in the
/// address bar that holds the titles of the curves that are switched off.
function chart_of(figure, { told, opened = null, hidden = "hidden" }) {
  const canvas = element("canvas", { tabindex: 0, role: "img", "aria-label": figure.title +
    ". Arrow keys go along the curves" + (opened ? ", Enter opens a point." : ".") });
  const said = element("p", { class: "said", "aria-live": "polite" }, "\u00a0");
  const say = (words) => { said.textContent = words || "\u00a0"; };
  const is_shown = (curve) => !choice.has(hidden, curve.title);
  const all = figure.curves.flatMap((curve) => curve.points);
  let chart = null;
  const point_of = (at) => at && { curve: figure.curves[at.datasetIndex],
                                   point: figure.curves[at.datasetIndex]?.points[at.index] };
  const words_of = ({ datasetIndex, dataIndex }) => {
    const { curve, point } = point_of({ datasetIndex, index: dataIndex });
    return told(curve, point).split("; ").filter(Boolean);
  };
  const options = () => ({
    animation: false, responsive: true, maintainAspectRatio: false, parsing: false,
    interaction: { mode: "nearest", axis: "xy", intersect: false },
    layout: { padding: { right: 12, top: 8 } },
    scales: { x: axis_of(along_of(figure)), y: axis_of(figure.y) },
    onHover: (event, [at]) => {
      const found = point_of(at);
      say(found?.point && told(found.curve, found.point));
      canvas.style.cursor = opened && found?.point ? "pointer" : "default";
    },
    onClick: (event, [at]) => { if (opened && point_of(at)?.point) opened(point_of(at).point); },
    plugins: {
      legend: { display: false },
      tooltip: {
        backgroundColor: variable("text"), bodyColor: variable("paper"), displayColors: false,
        filter: (item) => !item.dataset.is_line,
        callbacks: { title: () => "", label: words_of },
      },
    },
  });
  const draw = () => {
    chart?.destroy();
    Chart.defaults.font.family = getComputedStyle(said).fontFamily;
    Chart.defaults.font.size = 13;
    Chart.defaults.color = variable("ink");
    // later curves are drawn above earlier ones, as in gnuplot's figure
    const sets = figure.curves.map((curve, k) => ({ ...dataset_of(curve), order: -k,
                                                    hidden: !is_shown(curve) }));
    if (all.length) sets.push(...(figure.lines ?? []).map((line) => line_of(line, all)));
    chart = new Chart(canvas, { type: "line", data: { datasets: sets }, options: options(),
                                plugins: [extents, line_words] });
  };
  canvas.addEventListener("keydown", key_walk(figure, is_shown, (at) => {
    const found = point_of(at);
    chart.setActiveElements([at]);
    const { x, y } = chart.getDatasetMeta(at.datasetIndex).data[at.index];
    chart.tooltip.setActiveElements([at], { x, y });
    chart.update("none");
    say(told(found.curve, found.point));
  }, (at) => opened?.(point_of(at).point)));
  const legend = legend_of(figure, is_shown, hidden);
  const holder = element("div", { class: "chart" }, legend,
    element("div", { class: "axis" }), element("div", { class: "ground" }, canvas),
    element("div", { class: "axis x" }), said);
  const [up, along] = holder.querySelectorAll(".axis");
  up.innerHTML = figure.y.label;
  along.innerHTML = figure.x.label;
  const refresh = () => {
    // a replay in the page changes the address, too: then no curve has changed
    if (figure.curves.every((curve, k) => chart?.isDatasetVisible(k) === is_shown(curve))) return;
    figure.curves.forEach((curve, k) => chart?.setDatasetVisibility(k, is_shown(curve)));
    chart?.update("none");
    for (const one of legend.children)
      one.setAttribute("aria-pressed", String(!choice.has(hidden, one.dataset.title)));
  };
  const gone = () => {
    chart?.destroy();
    charts.delete(place);
  };
  const place = { element: holder, draw, refresh, gone };
  charts.add(place);
  return place;
}

choice.changed(() => {
  for (const chart of charts) chart.refresh();
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  for (const chart of charts) chart.draw();
});

// Figures that were drawn by gnuplot become charts: the same curves, whose numbers stand in the
// page. In print the drawn ones stay.

/// A panel's curves from the page's data: x and y are lists there.
function panel_figure(picture, panel) {
  const curve_of = (curve) => ({
    ...curve,
    title: plain(curve.title.replaceAll("<sub>", "_")),
    points: curve.x.map((x, k) => ({ x, y: curve.y[k], error: curve.error[k],
                                     from: curve.from[k] ?? curve.from[0] }))
      .filter(({ x }) => x !== null && (!panel.x.log || x > 0))
      // where a curve has no value it is broken
      .map((point) => (point.y === null || (panel.y.log && point.y <= 0) ?
        { ...point, y: null } : point))
      .filter(({ y }) => y !== null || curve.mark !== "points"),
  });
  const lines = panel.lines.map((line) => ({ ...line, label: plain(line.label) }));
  return { title: picture.title, x: panel.x, y: panel.y, lines,
           curves: panel.curves.map(curve_of) };
}

const plain = (html) => new DOMParser().parseFromString(html, "text/html").body.textContent;

function picture_charts(picture) {
  return picture.panels.map((panel) => {
    const quantity = (label, value) => {
      const words = plain(label).trim(), unit = /\s*\(([^()]*)\)$/.exec(words);
      const name = unit ? words.slice(0, unit.index) : words;
      return `${name} ${short_number(value)}${unit ? narrow_space + unit[1] : ""}`;
    };
    const opens = panel.curves.some((curve) => curve.from.length);
    return chart_of(panel_figure(picture, panel), {
      told: (curve, { x, y, error }) =>
        `${curve.title}; ${quantity(panel.x.label, x)}; ${quantity(panel.y.label, y)}` +
        (error ? ` ± ${short_number(error)}` : ""),
      opened: opens ? ({ from }) => choice.set("origin", from) : null,
    });
  });
}

function draw_pictures(pictures) {
  for (const picture of pictures) {
    const drawn = document.getElementById(picture.name)?.querySelector("svg");
    if (!drawn) continue;
    drawn.classList.add("still");
    const made = picture_charts(picture);
    drawn.after(...made.map((chart) => chart.element));
    made.forEach((chart) => after_replay(chart.draw));
  }
}

/// A replay's first picture comes first.
function after_replay(draw) {
  const waits = document.getElementById("replay") && !window.ballastReplay &&
    !window.ballastReplayError;
  if (waits) setTimeout(after_replay, 50, draw);
  else draw();
}

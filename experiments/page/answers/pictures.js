// Turns figures drawn by gnuplot into charts of the same curves, whose numbers are in the page. In
// print gnuplot's figures stay.

/// Returns the axis with a range that holds `places`. A logarithmic axis ends just beside them, not
/// at the next powers of ten.
function range_of(axis, places) {
  const shown = places.filter((place) => place !== null && (!axis.log || place > 0));
  if (!shown.length) return axis;
  const [low, high] = extent(shown);
  if (!axis.log) return { ...axis, low, high };
  const beside = Math.max((high / low) ** 0.04, 1.1);
  return { ...axis, min: axis.min ?? low / beside, max: axis.max ?? high * beside };
}

/// The figure of a panel of the page's data, where x and y of a curve are lists.
function panel_figure(picture, panel) {
  const curve_of = (curve) => ({
    ...curve,
    points: curve.x.map((x, k) => ({ x, y: curve.y[k], error: curve.error[k], low: curve.low[k] }))
      // a curve breaks where it has no value
      .map((point, k, all) => (point.x === null ? { x: all[k - 1]?.x ?? null, y: null } : point))
      .filter(({ x }) => x !== null && (!panel.x.log || x > 0))
      .map((point) => (point.y === null || (panel.y.log && point.y <= 0) ?
        { ...point, y: null } : point))
      .filter(({ y }) => y !== null || curve.mark !== "points"),
  });
  const curves = panel.curves.map(curve_of), points = curves.flatMap((curve) => curve.points);
  const across = panel.lines.filter((line) => !line.vertical).map((line) => line.value);
  const heights = points.filter(({ y }) => y !== null).flatMap(({ y, error, low }) =>
    [y, low ?? y, y - (error ?? 0), y + (error ?? 0)]);
  return { title: picture.title, x: range_of(panel.x, points.map(({ x }) => x)),
           y: range_of(panel.y, [...heights, ...across]), lines: panel.lines, curves };
}

function picture_charts(picture) {
  return picture.panels.map((panel) => {
    const quantity = ({ words }, ...values) => {
      const unit = /\s*\(([^()]*)\)$/.exec(words), name = words.slice(0, unit?.index).trim();
      return `${name} ${values.map(short_number).join(" to ")}` +
        (unit ? narrow_space + unit[1] : "");
    };
    const heights = ({ y, low = null }) => low === null ? [y] : [low, y];
    return chart_of(panel_figure(picture, panel), {
      told: (curve, { x, error, ...point }) =>
        `${curve.title}; ${quantity(panel.x, x)}; ${quantity(panel.y, ...heights(point))}` +
        (error ? ` ± ${short_number(error)}` : ""),
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

/// Calls `draw` when the page's replay, if there is one, has drawn its first picture or has failed.
function after_replay(draw) {
  const waits = document.getElementById("replay") && !window.ballastReplay &&
    !window.ballastReplayError;
  if (waits) setTimeout(after_replay, 50, draw);
  else draw();
}

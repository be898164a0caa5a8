// What stands around a chart: the legend's switches, and the keys that walk along its curves.

/// One switch for each title; curves of one title are switched together.
function legend_of(figure, is_shown, hidden) {
  const seen = new Map();
  for (const curve of figure.curves)
    if (curve.title && !seen.has(curve.title)) seen.set(curve.title, curve);
  const switch_of = (curve) => {
    const swatch = element("span", { class: `swatch dash${curve.dash ?? 0} ${curve.mark ?? ""}`,
                                     style: `color:var(--${curve.ink})` });
    if (curve.mark === "line")
      swatch.style.borderTopWidth = `${Math.max(1.5, curve.width)}px`;
    const made = button("", () => choice.toggle(hidden, curve.title),
                        { class: "switch", "data-title": curve.title,
                          "aria-pressed": String(is_shown(curve)) });
    made.append(swatch, curve.title);
    return made;
  };
  return element("div", { class: "legend", role: "group", "aria-label": "Curves" },
                 ...[...seen.values()].map(switch_of));
}

/// The keys of a chart: left and right along a curve, up and down to the next curve, Home and End,
/// Enter. `show` and `open` get {datasetIndex, index}.
function key_walk(figure, is_shown, show, open) {
  let curve = 0, index = -1;
  const steps = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0],
                  Home: [0, -Infinity], End: [0, Infinity] };
  return (event) => {
    const shown = figure.curves.map((one, k) => k)
      .filter((k) => is_shown(figure.curves[k]) &&
        figure.curves[k].points.some((point) => point.y !== null));
    if (!shown.length) return;
    if (event.key === "Enter" && index >= 0) open({ datasetIndex: curve, index });
    const step = steps[event.key];
    if (!step) return;
    event.preventDefault();
    const place = Math.max(0, shown.indexOf(curve));
    const x = figure.curves[curve].points[index]?.x;
    curve = shown[(place + step[0] + shown.length) % shown.length];
    const points = figure.curves[curve].points, last = points.length - 1;
    // on another curve, the point that is nearest along x
    if (step[0] && x !== undefined)
      index = points.reduce((best, p, k) =>
        Math.abs(p.x - x) < Math.abs(points[best].x - x) ? k : best, 0);
    index = Math.min(last, Math.max(0, index + step[1]));
    // over where the curve is broken, to the next value on the way, else back
    const way = Math.sign(step[1]) || 1;
    for (const go of [way, -way])
      while (points[index]?.y === null && points[index + go]) index += go;
    if (points[index].y !== null) show({ datasetIndex: curve, index });
  };
}

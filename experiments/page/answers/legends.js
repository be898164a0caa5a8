// The parts around a chart: the legend with its switches, and the keys that walk along its curves.

/// The legend: one switch for each title, which switches all curves of that title.
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

/// Returns the key listener of a chart: left and right walk along a curve, up and down change the
/// curve, Home and End go to its ends, Enter opens. `show` and `open` get {datasetIndex, index}.
function key_walk(figure, is_shown, show, open) {
  let at = null;
  const steps = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0],
                  Home: [0, -Infinity], End: [0, Infinity] };
  return (event) => {
    const curves = figure.curves.map((curve, datasetIndex) => (is_shown(curve) ?
      curve.points.map(({ x, y }, index) => ({ datasetIndex, index, x, y })) : [])
      .filter(({ y }) => y !== null)).filter((spots) => spots.length);
    if (!curves.length) return;
    if (event.key === "Enter" && at) open(at);
    const [over, along] = steps[event.key] ?? [];
    if (along === undefined) return;
    event.preventDefault();
    const place = Math.max(0, curves.findIndex(([one]) => one.datasetIndex === at?.datasetIndex));
    const spots = curves[(place + over + curves.length) % curves.length];
    // on another curve the value with the nearest x is taken
    const away = (k) => (over ? Math.abs(spots[k].x - at.x) : Math.abs(spots[k].index - at.index));
    const from = at ? spots.reduce((best, _, k) => (away(k) < away(best) ? k : best), 0) : -1;
    at = spots[Math.min(spots.length - 1, Math.max(0, from + along))];
    show(at);
  };
}

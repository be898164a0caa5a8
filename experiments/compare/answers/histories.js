// Error against time: of one case under every backend, of a family, of one row.

const first_repeat = (row) => row.repeat === 0 && row.start === chosen.start && chosen.has(row);

/// The history to the tightest tolerance that has one.
const longest_history = (mine, solver) =>
  mine.filter((row) => row.solver === solver && history_of(row).length)
    .sort((a, b) => a.tolerance - b.tolerance)[0];

/// A history as a line that ends when the backend stopped.
function history_curve(row) {
  const points = history_of(row).filter((p) => p.x > 0 && p.y > 0);
  const last = points.at(-1);
  if (last && row.seconds > last.x) points.push({ ...last, x: row.seconds });
  return { ...style_of(row.solver), stepped: true, points };
}

/// The error of these rows against time, with lines at their tolerances.
function error_chart(title, mine, curves, options = {}) {
  const lines = page_data.measure !== "natural_map" ? []
    : unique(mine.map((row) => row.tolerance)).map((value) => ({ value }));
  const told = (curve, { x, y, row }) =>
    `${curve.title}; error ${number(y, 2)} after ${time_words(x)}` +
    (curve.mark ? `; tolerance ${row.tolerance_text}` : "");
  return chart_of({ title, x: seconds_axis, y: { label: "error, relative", log: true }, curves,
                    lines }, { told, ...options });
}

function case_chart(title, mine) {
  const solvers = all_solvers.filter((name) => mine.some((row) => row.solver === name));
  const lines = solvers.map((name) => longest_history(mine, name)).filter(Boolean)
    .map(history_curve);
  const arrivals = solvers.map((solver) => ({ ...style_of(solver), mark: "points",
    points: mine.filter((row) => row.solver === solver && row.is_solved && row.natural_map_rms > 0)
      .map((row) => ({ x: row.seconds, y: row.natural_map_rms / row.velocity_scale, row })) }));
  const curves = [...lines, ...arrivals].filter((curve) => curve.points.length);
  return error_chart(title, mine, curves, { opened: open_row });
}

function case_view() {
  const mine = rows.filter(first_repeat);
  const [name, line] = chooser("case", unique(mine.map((row) => row.case)));
  const words = "Lines: least error so far; dots: where a tolerance was reached. A dot opens its " +
    "solve.";
  return [line, caption(name + ".", words),
          case_chart("Error against time: " + name, mine.filter((row) => row.case === name))];
}

function family_view() {
  const families = Map.groupBy(rows.filter(first_repeat), (row) => row.family);
  const large = [...families.keys()].filter((family) =>
    families.get(family).some((row) => row.case !== families.get(family)[0].case));
  if (!large.length) return [];
  const [family, line] = chooser("family", large), mine = families.get(family);
  const cases = [...Map.groupBy(mine, (row) => row.case).values()];
  const curve_of = (solver) => {
    const histories = cases.map((of_case) => longest_history(of_case, solver)).filter(Boolean)
      .map(history_of);
    // a mean over fewer cases could not be compared
    const points = histories.length < cases.length ? [] : mean_history(histories, 160);
    return { ...style_of(solver), points };
  };
  const curves = all_solvers.map(curve_of).filter((curve) => curve.points.length);
  if (!curves.length)
    return [line, caption("Family " + family + ".", "No backend has a history of all its cases.")];
  const words = `Geometric mean over ${cases.length} cases of the least error reached by then.`;
  return [line, caption("Family " + family + ".", words),
          error_chart("Error against time: family " + family, mine, curves)];
}

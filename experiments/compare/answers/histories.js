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
  return { title: row.solver, ...style_of(row.solver), stepped: true, points };
}

const tolerance_lines = (mine) => (page_data.measure === "natural_map"
  ? unique(mine.map((row) => row.tolerance)).map((value) => ({ value })) : []);

const told_history = (curve, { x, y, row }) =>
  `${curve.title}; error ${number(y, 2)} after ${time_words(x)}` +
  (curve.mark ? `; tolerance ${row.tolerance_text}` : "");

function case_chart(mine, title) {
  const solvers = all_solvers.filter((name) => mine.some((row) => row.solver === name));
  const lines = solvers.map((name) => longest_history(mine, name)).filter(Boolean)
    .map(history_curve);
  const arrivals = solvers.map((solver) => ({ title: solver, ...style_of(solver), mark: "points",
    points: mine.filter((row) => row.solver === solver && row.is_solved && row.natural_map_rms > 0)
      .map((row) => ({ x: row.seconds, y: row.natural_map_rms / row.velocity_scale, row })) }));
  return chart_of({ title, x: seconds_axis, y: error_axis, lines: tolerance_lines(mine),
                    curves: [...lines, ...arrivals].filter((curve) => curve.points.length) },
                  { told: told_history, opened: open_row });
}

function case_view() {
  const mine = rows.filter(first_repeat);
  const [name, line] = chooser("case", "case", unique(mine.map((row) => row.case)));
  const words = "Lines: least error so far; dots: where a tolerance was reached. A dot opens its " +
    "solve.";
  return [line, caption(name + ".", words),
          case_chart(mine.filter((row) => row.case === name), "Error against time: " + name)];
}

function family_view() {
  const families = Map.groupBy(rows.filter(first_repeat), (row) => row.family);
  const large = [...families.keys()].filter((family) =>
    families.get(family).some((row) => row.case !== families.get(family)[0].case));
  if (!large.length) return [];
  const [family, line] = chooser("family", "family", large), mine = families.get(family);
  const cases = [...Map.groupBy(mine, (row) => row.case).values()];
  const curve_of = (solver) => {
    const histories = cases.map((of_case) => longest_history(of_case, solver)).filter(Boolean)
      .map(history_of);
    // a mean over fewer cases could not be compared
    const points = histories.length < cases.length ? [] : mean_history(histories, 160);
    return { title: solver, ...style_of(solver), points };
  };
  const curves = all_solvers.map(curve_of).filter((curve) => curve.points.length);
  if (!curves.length)
    return [line, caption("Family " + family + ".", "No backend has a history of all its cases.")];
  const figure = { title: "Error against time: family " + family, x: seconds_axis, y: error_axis,
    lines: tolerance_lines(mine), curves };
  const words = `Geometric mean over ${cases.length} cases of the least error reached by then.`;
  return [line, caption("Family " + family + ".", words), chart_of(figure, { told: told_history })];
}

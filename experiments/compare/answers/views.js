// The sections of the page, made again for each selection.

const right = (title) => ({ title, number: true });
const left = (title) => ({ title });
const if_any = (count, kind) => ({ text: count ? String(count) : "", value: count, kind });

function backends_view(selected) {
  const columns = [left("backend"), left("law"), right("solved"), right("mean time"),
    right("unsolved in it"), right("over fastest"), right("timeouts"), right("crashes"),
    right("not taken"), right("no solution"), right("claims denied"), right("spread")];
  const lines = summaries(selected).map((s) => [s.solver, s.law,
    { text: `${s.solved} of ${selected.cases.length}`, value: s.solved },
    { text: time_words(s.mean), value: s.mean }, if_any(s.unsolved, "missed"),
    { text: number(s.ratio), value: s.ratio }, if_any(s.timeouts), if_any(s.crashes),
    if_any(s.unsupported), if_any(s.no_solutions), if_any(s.denied, "missed"),
    { text: s.spread ? number(100 * s.spread, 2) + narrow_space + "%" : "", value: s.spread }]);
  return [table_of("backends", columns, lines)];
}

/// A cell with a time, or with the reason why there is none; it opens its row.
function outcome_cell(cell) {
  if (!cell.row) return "";
  const open = () => choice.set("row", cell.row.key);
  if (cell.solved) return { text: time_words(cell.median), value: cell.median, open };
  const error = Number.isFinite(cell.row.error) ? " " + number(cell.row.error, 1) : "";
  return { text: reason_of(cell.row) + error, value: 1e9, kind: "missed", open };
}

function matrix_view({ solvers, cases }) {
  return [table_of("every case by every backend",
    [left("case"), right("contacts"), ...solvers.map(right)],
    cases.map((c) => [c.name, String(c.row.contacts), ...c.cells.map(outcome_cell)]))];
}

const seconds_axis = { label: "time&nbsp; (s)", log: true };
const open_row = ({ row }) => { if (row) choice.set("row", row.key); };
const told_row = (row) => [row.case, row.is_solved ? time_words(row.seconds) : reason_of(row),
                           "error " + number(row.error, 2)].join("; ");

function profile_chart({ solvers }, title, label, { first, last, curves }) {
  const figure = { title, x: { label, log: true, min: first, max: last },
    y: { label: "fraction of cases solved", min: 0, max: 1 },
    curves: solvers.map((name, s) => ({ ...style_of(name), stepped: true, points: curves[s] })) };
  return chart_of(figure, { opened: open_row, told: (curve, { x, y, row }) =>
    `${curve.title}; ${number(100 * y)} % within ${number(x)}; ${row ? told_row(row) : ""}` });
}

function profiles_view(selected) {
  // a case that a backend did not try is no failure
  const cases = selected.cases.filter((c) => c.cells.every((cell) => cell.row));
  const tried = { ...selected, cases };
  if (!cases.length) return [];
  const share = "the share of the cases that a backend solves ";
  return [
    caption("Performance profile", `(Dolan–Moré): ${share}within so many times the fastest ` +
      "backend’s time, for the cases and backends that are chosen."),
    profile_chart(tried, "Performance profile", "time over the fastest backend’s time",
                  cost_profiles(tried, time_ratio, 1)),
    caption("Data profile", `(Moré–Wild): ${share}when so much time is given for each contact.`),
    profile_chart(tried, "Data profile", "time per contact&nbsp; (s)",
                  cost_profiles(tried, time_per_contact)),
  ];
}

const caption = (title, words) => element("p", {}, element("b", {}, title), " " + words);

/// A choice of one of `all` beside a chart.
function chooser(name, all) {
  const value = chosen.one(name, all);
  if (all.length < 2) return [value, null];
  return [value, element("p", { class: "line" }, select_of(name, all, value))];
}

const cost_axes = {
  contacts: { label: "contacts", log: true },
  "rank deficiency": { label: "rank deficiency of <i>W</i>,&nbsp; 1 − rank/rows", log: false },
  "mass ratio": { label: "mass ratio", log: true },
};

function cost_view({ solvers, cases }) {
  const [name, chooser_line] = chooser("against", Object.keys(cost_axes));
  const x = cost_axes[name], key = name.replace(" ", "_");
  const points_of = (s) => cases.filter((c) => c.cells[s].solved && (!x.log || c.row[key] > 0))
    .map((c) => ({ x: c.row[key], y: c.cells[s].median, row: c.cells[s].row }))
    .filter((point) => Number.isFinite(point.x) && point.y > 0).sort((a, b) => a.x - b.x);
  const figure = { title: "Cost against " + name, x, y: seconds_axis,
    curves: solvers.map((one, s) => ({ ...style_of(one), mark: "points", points: points_of(s) })) };
  const words = "Time of prepare and solve; only what was solved is drawn. A point opens its " +
    "solve.";
  const told = (curve, point) =>
    `${curve.title}; ${name} ${short_number(point.x)}; ${told_row(point.row)}`;
  return [chooser_line, caption("Cost.", words), chart_of(figure, { opened: open_row, told })];
}

// Medians, means (those of all cases are from compare_page.cpp) and profiles of a selection.

/// One case by one backend, over its repeats. Times are infinite where it isn't solved.
function cell_of(repeats) {
  const best = repeats.filter((row) => row.is_solved).sort((a, b) => a.seconds - b.seconds);
  const row = best[0] ?? repeats[0] ?? null, n = best.length;
  if (!n || n < repeats.length) return { row, solved: false, median: Infinity, spread: 0 };
  const times = best.map((one) => one.seconds);
  const median = n % 2 ? times[(n - 1) / 2] : 0.5 * (times[n / 2 - 1] + times[n / 2]);
  const spread = median > 0 ? (times[n - 1] - times[0]) / median : 0;
  return { row, solved: true, median, spread };
}

/// The rows of all choices as {solvers, cases: [{name, row, cells, fastest}]}.
function selection() {
  const mine = rows.filter((row) => chosen.has(row) && row.start === chosen.start &&
                                    row.tolerance_text === chosen.tolerance);
  const solvers = all_solvers.filter((name) => mine.some((row) => row.solver === name));
  const cases = [...Map.groupBy(mine, (row) => row.case)].map(([name, of_case]) => {
    const cells = solvers.map((s) => cell_of(of_case.filter((row) => row.solver === s)));
    return { name, cells, row: of_case[0], fastest: Math.min(...cells.map((c) => c.median)) };
  });
  return { solvers, cases };
}

/// Shifted geometric means: exp(mean(log(x + shift))) - shift, and that of (x + shift)/(y + shift).
const log_mean = (values) => Math.exp(values.reduce((a, b) => a + b, 0) / values.length);
const shifted_mean = (times) =>
  log_mean(times.map((t) => Math.log(t + page_data.shift))) - page_data.shift;
const shifted_ratio = (times, best) =>
  log_mean(times.map((t, k) => Math.log((t + page_data.shift) / (best[k] + page_data.shift))));

/// One line for each backend: most solved first, then fastest.
function summaries({ solvers, cases }) {
  const lines = solvers.map((solver, s) => {
    const tried = cases.filter((c) => c.cells[s].row), cells = tried.map((c) => c.cells[s]);
    const of = (...verdicts) => cells.filter(({ row }) => verdicts.includes(row.verdict)).length;
    const times = cells.map((cell) => Math.min(cell.median, page_data.limit));
    const beaten = tried.map((c, k) => k).filter((k) => Number.isFinite(tried[k].fastest));
    const solved = cells.filter((cell) => cell.solved).length;
    return {
      solver, law: cells[0]?.row.law ?? "", solved, unsolved: cells.length - solved,
      timeouts: of("timeout"), crashes: of("crashed", "out_of_memory"),
      unsupported: of("unsupported"), no_solutions: of("no_solution"), denied: of("denied"),
      mean: shifted_mean(times),
      ratio: beaten.length ? shifted_ratio(beaten.map((k) => times[k]),
                                           beaten.map((k) => tried[k].fastest)) : NaN,
      spread: Math.max(0, ...cells.map((cell) => cell.spread)),
    };
  });
  return lines.sort((a, b) => b.solved - a.solved || a.mean - b.mean);
}

/// The fraction of cases with a value up to x: steps from `first` to `last`, each with its row.
function counted_steps(values, cases, first, last) {
  const order = values.map((value, k) => k).sort((a, b) => values[a] - values[b]);
  const points = [{ x: first, y: 0 }];
  order.forEach((k, place) => {
    if (!(values[k] <= last)) return;
    const y = (place + 1) / values.length;
    points.push({ x: Math.max(first, values[k]), y, row: cases[k] });
  });
  return [...points, { x: last, y: points.at(-1).y }];
}

const decade_above = (value) => 10 ** Math.ceil(Math.log10(value) - 1e-9);
const decade_below = (value) => 10 ** Math.floor(Math.log10(value) + 1e-9);

/// The share of the cases that each backend solves at a cost, `cost_of(median, case)`, up to x. It
/// begins at `first`, or at the decade below the least cost.
function cost_profiles({ solvers, cases }, cost_of, first = null) {
  const costs = solvers.map((solver, s) => cases.map((one) => cost_of(one.cells[s].median, one)));
  const known = costs.flat().filter((cost) => Number.isFinite(cost) && cost > 0);
  const [least, most] = extent(known);
  const start = first ?? (known.length ? decade_below(least) : 1e-6);
  const last = Math.max(10 * start, known.length ? decade_above(most) : 1);
  return { first: start, last, curves: costs.map((values, s) =>
    counted_steps(values, cases.map((c) => c.cells[s].row), start, last)) };
}

/// Dolan and Moré: time over the fastest backend's time.
const time_ratio = (median, { fastest }) =>
  !Number.isFinite(median) ? Infinity : fastest > 0 ? median / fastest : 1;
/// Moré and Wild, with time per contact as the unit of cost.
const time_per_contact = (median, { row }) => median / Math.max(1, row.contacts);

/// The geometric mean over histories of the least error so far, at `count` + 1 times.
function mean_history(histories, count) {
  const times = histories.flat().map((p) => p.x).filter((x) => x > 0);
  const [first, last] = extent(times);
  if (!(last > first)) return [];
  return Array.from({ length: count + 1 }, (_, k) => {
    const x = first * (last / first) ** (k / count);
    const errors = histories.map((points) => (points.findLast((p) => p.x <= x) ?? points[0]).y);
    return { x, y: log_mean(errors.map((e) => Math.log(Math.max(e, 1e-16)))) };
  });
}

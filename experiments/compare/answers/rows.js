// The rows of the comparison, as results.csv has them, with numbers for what is one.

const counted = ["tolerance", "repeat", "max_seconds", "error", "seconds", "iterations",
                 "natural_map_rms", "contacts", "rank_deficiency", "mass_ratio", "velocity_scale",
                 "prepare_seconds", "peak_memory_MB"];
const column_names = page_data.columns;

const rows = page_data.rows.map((cells) => {
  const row = Object.fromEntries(column_names.map((name, k) => [name, cells[k]]));
  for (const name of counted) row[name] = Number(row[name]);
  row.tolerance_text = cells[column_names.indexOf("tolerance")];
  row.cells = cells;
  row.is_solved = row.verdict === "solved";
  row.is_denied = row.verdict === "denied";
  return row;
});

const unique = (values) => [...new Set(values)];
const all_solvers = unique(rows.map((row) => row.solver));
const all_families = unique(rows.map((row) => row.family));
const all_starts = unique(rows.map((row) => row.start));
const all_tolerances = unique(rows.map((row) => row.tolerance_text))
  .sort((a, b) => Number(b) - Number(a));
const all_contacts = rows.map((row) => row.contacts);

const style_of = (solver) => curve_style(all_solvers.indexOf(solver));

/// What is chosen: of an address by hand, only what there is.
const chosen = {
  one: (name, all) => (all.includes(choice.get(name)) ? choice.get(name) : all[0]),
  get tolerance() { return this.one("tolerance", all_tolerances); },
  get start() { return this.one("start", all_starts); },
  least: () => Number(choice.get("from", "0")) || 0,
  most: () => Number(choice.get("to")) || Infinity,
  has_case(row) {
    return !choice.has("without_family", row.family) && row.contacts >= this.least() &&
      row.contacts <= this.most() &&
      row.case.toLowerCase().includes(choice.get("find").toLowerCase());
  },
  has: (row) => chosen.has_case(row) && !choice.has("without", row.solver),
};

/// Why a row is not solved, in a few words.
function reason_of(row) {
  if (row.is_denied) return "denied";
  const words = { crashed: "crashed", out_of_memory: "memory", unsupported: "not taken",
                  no_solution: "no solution", timeout: row.reason ? "time limit" : "killed" };
  return words[row.verdict] ?? (row.reason || "failed").replaceAll("_", " ");
}

/// The command that makes a row again.
const command_of = (row) => page_data.again
  .replace("{case}", () => page_data.words[row.case] ?? row.case).replace("{solver}", row.solver)
  .replace("{tolerance}", row.tolerance_text).replace("{start}", row.start);

/// Errors of a row's history as what was reached by then: {x: seconds, y: error}.
function history_of(row) {
  const flat = page_data.histories[row.key] ?? [];
  row.history ??= flat.flatMap((x, k) => (k % 2 ? [] : [{ x, y: flat[k + 1], row }]));
  return row.history;
}

/// Rows by the value of a column, in the order of their first ones.
function grouped(list, column) {
  const groups = new Map();
  for (const row of list) {
    if (!groups.has(row[column])) groups.set(row[column], []);
    groups.get(row[column]).push(row);
  }
  return groups;
}

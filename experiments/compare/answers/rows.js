// The rows of the comparison as in results.csv, with the `counted` columns as numbers. A column
// comes as one text, which is split when it is first read.

const counted = ["tolerance", "repeat", "max_seconds", "error", "seconds", "iterations",
                 "natural_map_rms", "contacts", "rank_deficiency", "mass_ratio", "velocity_scale",
                 "prepare_seconds", "peak_memory_MB"];
const column_names = Object.keys(page_data.columns);

class Row {
  constructor(place) { this.place = place; }
  get is_solved() { return this.verdict === "solved"; }
  /// The row's cells as in results.csv.
  get cells() { return column_names.map((name) => this[name + "_text"]); }
}

const cells_of_text = (text) => text.split("\n").slice(0, -1);

/// Rows have the cells of a column as row[name + "_text"], and their values as row[name].
for (const [name, text] of Object.entries({ ...page_data.columns, ...page_data.more })) {
  let texts = null, values = null;
  const get_texts = () => (texts ??= cells_of_text(text));
  const get_values = () =>
    (values ??= counted.includes(name) ? get_texts().map(Number) : get_texts());
  Object.defineProperties(Row.prototype, {
    [name + "_text"]: { get() { return get_texts()[this.place]; } },
    [name]: { get() { return get_values()[this.place]; } },
  });
}

const rows = cells_of_text(page_data.columns.case).map((_, place) => new Row(place));

const unique = (values) => [...new Set(values)];
const all_solvers = unique(rows.map((row) => row.solver));
const all_families = unique(rows.map((row) => row.family));
const all_starts = unique(rows.map((row) => row.start));
const all_tolerances = unique(rows.map((row) => row.tolerance_text))
  .sort((a, b) => Number(b) - Number(a));

/// The title and the style of a backend's curves.
const style_of = (solver) => ({ title: solver, ...curve_style(all_solvers.indexOf(solver)) });

/// The reader's choices. Values that no row has, in an address typed by hand, are ignored.
const chosen = {
  one: (name, all) => (all.includes(choice.get(name)) ? choice.get(name) : all[0]),
  get tolerance() { return this.one("tolerance", all_tolerances); },
  get start() { return this.one("start", all_starts); },
  has(row) {
    const least = Number(choice.get("from", "0")) || 0, most = Number(choice.get("to")) || Infinity;
    return !choice.has("without", row.solver) && !choice.has("without_family", row.family) &&
      row.contacts >= least && row.contacts <= most &&
      row.case.toLowerCase().includes(choice.get("find").toLowerCase());
  },
};

/// Why a row is not solved, in a few words.
function reason_of(row) {
  const words = { denied: "denied", crashed: "crashed", out_of_memory: "memory",
                  unsupported: "not taken", no_solution: "no solution",
                  timeout: row.reason ? "time limit" : "killed" };
  return words[row.verdict] ?? (row.reason || "failed").replaceAll("_", " ");
}

/// The command that makes a row again.
const command_of = (row) => page_data.again
  .replace("{case}", () => row.word).replace("{solver}", row.solver)
  .replace("{tolerance}", row.tolerance_text).replace("{start}", row.start);

/// The least errors so far of a row's history: [{x: seconds, y: error, row}].
function history_of(row) {
  if (row.reached) return row.reached;
  const flat = row.history ? row.history.split(" ").map(Number) : [];
  return row.reached = flat.flatMap((x, k) => (k % 2 ? [] : [{ x, y: flat[k + 1], row }]));
}

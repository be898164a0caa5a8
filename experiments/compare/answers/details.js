// One row, opened from a point or a cell.

const facts_of = (row) => facts_table([
  ["what came of it", row.is_solved ? "solved" : reason_of(row)],
  ["time", `${time_words(row.seconds)}, of it prepare ${time_words(row.prepare_seconds)}`],
  ["error", `${number(row.error)} (tolerance ${row.tolerance_text}, ${row.measure})`],
  ["iterations", row.iterations ? String(row.iterations) : dash],
  ["contacts", `${row.contacts}; rank deficiency ${number(row.rank_deficiency, 2)}, ` +
               `mass ratio ${number(row.mass_ratio)}`],
  row.worst ? ["worst contact", row.worst] : null,
  row.note ? ["note", row.note] : null]);

/// The command that shows where in the packing the answer is wrong; a note where the bodies are not
/// known.
function view_of(row) {
  if (!row.can_view)
    return [element("p", { class: "note" },
                    "Not to be shown in 3D: the problem does not say where its contacts are.")];
  const beside = row.solver === "auto" ? "" : " --solver auto";
  return [element("p", {}, "Where in the packing it is wrong, contact by contact:"),
    command_line(`ballast view ${row.word} --solver ${row.solver}${beside}` +
                 (row.start === "warm" ? " --warm" : ""))];
}

/// The window of one solve: its numbers, its history, and how it is made again.
const refresh_details = window_for("row", "One solve", (key) => {
  const row = rows.find((one) => one.key === key);
  if (!row) return null;
  const history = history_curve(row), parts = [facts_of(row),
    element("p", {}, "Made again by (from the folder where the comparison was started):"),
    command_line(command_of(row)), ...view_of(row)];
  if (history.points.length < 2) return { title: `${row.solver} on ${row.case}`, parts };
  const chart = chart_of({ title: "History", x: seconds_axis, y: error_axis, curves: [history],
                           lines: tolerance_lines([row]) }, { told: told_history, hidden: "none" });
  return { title: `${row.solver} on ${row.case}`, parts: [...parts, chart.element], chart };
});

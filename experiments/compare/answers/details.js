// The window in the page's corner with one solve, opened from a point or a cell: its numbers, its
// history, and how it is made again. The address names the one that is open.

const facts_of = (row) => element("table", { class: "facts" }, element("tbody", {}, ...[
  ["what came of it", row.is_solved ? "solved" : reason_of(row)],
  ["time", `${time_words(row.seconds)}, of it prepare ${time_words(row.prepare_seconds)}`],
  ["error", `${number(row.error)} (tolerance ${row.tolerance_text}, ${row.measure})`],
  ["iterations", row.iterations ? String(row.iterations) : dash],
  ["contacts", `${row.contacts}; rank deficiency ${number(row.rank_deficiency, 2)}, ` +
               `mass ratio ${number(row.mass_ratio)}`],
  ["worst contact", row.worst], ["note", row.note]].filter(([, value]) => value)
  .map(([what, value]) => element("tr", {}, element("td", {}, what), element("td", {}, value)))));

/// A command with a button that copies it.
const command_line = (command) =>
  element("div", { class: "line command" }, element("pre", { tabindex: 0 }, command),
          button("copy", (event) => copy(command, event.currentTarget)));

/// The command that shows where in the packing the answer is wrong; a note without bodies.
function view_of(row) {
  if (!row.can_view)
    return [element("p", { class: "note" },
                    "Not to be shown in 3D: the problem does not say where its contacts are.")];
  const beside = row.solver === "auto" ? "" : " --solver auto";
  return [element("p", {}, "Where in the packing it is wrong, contact by contact:"),
    command_line(`ballast view ${row.word} --solver ${row.solver}${beside}` +
                 (row.start === "warm" ? " --warm" : ""))];
}

/// The row's history as a chart; null where it has none.
function history_chart(row) {
  const history = history_curve(row);
  if (history.points.length < 2) return null;
  return error_chart("History", [row], [history], { hidden: "none" });
}

const details = { element: element("dialog", { "aria-label": "One solve", class: "details" }),
                  row: undefined, chart: null };
document.body.append(details.element);
const close_details = () => choice.set("row", null);
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape" && details.element.open) close_details();
});

/// Shows the row that the address names. The chart is drawn when it is seen.
function refresh_details() {
  const key = choice.get("row"), row = key ? rows.find((one) => one.key === key) : undefined;
  if (row === details.row) return;
  details.chart?.gone();
  Object.assign(details, { row, chart: row ? history_chart(row) : null });
  if (!row) return details.element.close();
  details.element.replaceChildren(
    element("div", { class: "line head" }, element("h3", {}, `${row.solver} on ${row.case}`),
            button("close", close_details)),
    facts_of(row),
    element("p", {}, "Made again by (from the folder where the comparison was started):"),
    command_line(command_of(row)), ...view_of(row), details.chart?.element ?? "");
  if (!details.element.open) details.element.show();
  details.chart?.draw();
}

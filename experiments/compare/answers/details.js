// One row, opened from a point or a cell: its numbers, its history, and the command that makes it
// again.

function facts_of(row) {
  const line = (what, value) =>
    element("tr", {}, element("td", {}, what), element("td", {}, value));
  return element("table", { class: "facts" }, element("tbody", {},
    line("what came of it", row.is_solved ? "solved" : reason_of(row)),
    line("time", `${time_words(row.seconds)}, of it prepare ${time_words(row.prepare_seconds)}`),
    line("error", `${number(row.error)} (tolerance ${row.tolerance_text}, ${row.measure})`),
    line("iterations", row.iterations ? String(row.iterations) : dash),
    line("contacts", `${row.contacts}; rank deficiency ${number(row.rank_deficiency, 2)}, ` +
                     `mass ratio ${number(row.mass_ratio)}`),
    row.worst ? line("worst contact", row.worst) : null,
    row.note ? line("note", row.note) : null));
}

function details() {
  const dialog = element("dialog", { "aria-label": "One solve", class: "details" });
  let chart = null;
  const close = () => choice.set("row", null);
  dialog.addEventListener("keydown", (event) => { if (event.key === "Escape") close(); });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && dialog.open) close();
  });
  const refresh = () => {
    const row = rows.find((one) => one.key === choice.get("row"));
    if (dialog.dataset.row === (row?.key ?? "")) return;
    dialog.dataset.row = row?.key ?? "";
    chart?.gone();
    chart = null;
    if (!row) {
      dialog.close();
      return;
    }
    const command = command_of(row);
    const history = history_curve(row);
    dialog.replaceChildren(
      element("div", { class: "line head" },
        element("h3", {}, `${row.solver} on ${row.case}`),
        button("close", close)),
      facts_of(row),
      element("p", {}, "Made again by (from the folder where the comparison was started):"),
      element("div", { class: "line command" }, element("pre", { tabindex: 0 }, command),
        button("copy", (event) => copy(command, event.currentTarget))));
    if (history.points.length > 1) {
      chart = chart_of({ title: "History", x: seconds_axis, y: error_axis, curves: [history],
                         lines: tolerance_lines([row]) }, { told: told_history, hidden: "none" });
      dialog.append(chart.element);
    }
    if (!dialog.open) dialog.show();
    chart?.draw();
  };
  return { element: dialog, refresh };
}

// A window in the page's corner with what a point or a time is the outcome of: facts, commands.
// What is open stands in the address.

/// Lines of [what, value]; null is left out.
const facts_table = (lines) => element("table", { class: "facts" }, element("tbody", {},
  ...lines.filter(Boolean).map(([what, value]) =>
    element("tr", {}, element("td", {}, what), element("td", {}, value)))));

/// A command with a button that copies it.
const command_line = (command) =>
  element("div", { class: "line command" }, element("pre", { tabindex: 0 }, command),
          button("copy", (event) => copy(command, event.currentTarget)));

/// The window that shows what `name` in the address says. `fill(value)` gives {title, parts,
/// chart}, or null where there is nothing of that name; the chart is drawn when it is seen.
function window_for(name, label, fill) {
  const dialog = element("dialog", { "aria-label": label, class: "details" });
  const close = () => choice.set(name, null);
  let chart = null, shown = "";
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && dialog.open) close();
  });
  const refresh = () => {
    const value = choice.get(name), made = value ? fill(value) : null;
    if (shown === (made ? value : "")) return;
    shown = made ? value : "";
    chart?.gone();
    chart = made?.chart;
    if (!made) {
      dialog.close();
      return;
    }
    dialog.replaceChildren(
      element("div", { class: "line head" }, element("h3", {}, made.title), button("close", close)),
      ...made.parts);
    if (!dialog.open) dialog.show();
    chart?.draw();
  };
  document.body.append(dialog);
  return refresh;
}

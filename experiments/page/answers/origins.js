// Where a point comes from: a click on it opens a window in the page's corner with what it is the
// outcome of: facts, pages, commands. What is open stands in the address.

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

/// The cells of the table row that begins with these words, as facts.
function facts_of_row(words) {
  const row = [...document.querySelectorAll("main tbody tr")].find((one) =>
    one.cells[0].textContent.split(" (reference)")[0] === words);
  const heads = row ? [...row.closest("table").tHead.rows[0].cells] : [];
  return heads.slice(1).map((head, k) => [head.textContent, row.cells[k + 1].textContent]);
}

/// The window of page_data.origins: name -> {title, row, links, commands}. Links and commands are
/// pairs with their words.
function show_origins(origins) {
  if (!Object.keys(origins).length) return;
  const refresh = window_for("origin", "Where a point comes from", (name) => {
    const from = origins[name];
    if (!from) return null;
    const links = (from.links ?? []).map(([address, words]) =>
      element("li", {}, element("a", { href: address }, words)));
    const commands = (from.commands ?? []).flatMap(([command, words]) =>
      [element("p", {}, words), command_line(command)]);
    return { title: from.title ?? name, parts: [from.row && facts_table(facts_of_row(from.row)),
      links.length ? element("ul", {}, ...links) : null, ...commands].filter(Boolean) };
  });
  choice.changed(refresh);
  refresh();
}

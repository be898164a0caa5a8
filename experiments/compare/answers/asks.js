// The bar of the reader's choices, before the tables. The address bar keeps the choices.

function select_of(name, all, value) {
  const options = all.map((one) => element("option", { value: one, selected: one === value }, one));
  return element("label", {}, name + " ", element("select", { name, onchange: (event) =>
    choice.set(name, event.target.value) }, ...options));
}

function field_of(name, words, kind, hint) {
  return element("label", {}, words + " ", element("input", { name, type: kind, min: 0,
    value: choice.get(name), placeholder: hint, size: 8, onchange: (event) =>
      choice.set(name, event.target.value || null) }));
}

/// Makes a switch for each of `all`; those switched off stand in the address.
function switches_of(name, words, all) {
  const switch_of = (one) => element("label", {}, element("input", {
    type: "checkbox", name, value: one, checked: !choice.has(name, one),
    onchange: () => choice.toggle(name, one) }), " " + one);
  const shortcut = (text, list) => button(text, () => choice.set(name, list), { class: "short" });
  return element("fieldset", {}, element("legend", {}, words), ...all.map(switch_of),
    all.length > 2 ? shortcut("all", null) : null, all.length > 2 ? shortcut("none", all) : null);
}

function asks() {
  const counts = element("p", { class: "note", "aria-live": "polite" });
  const [least, most] = extent(rows.map((row) => row.contacts));
  const save = (name, list) => download(name, [column_names, ...list.map((row) => row.cells)]
    .map(csv_line).join("\n") + "\n");
  const bar = element("section", { class: "asks", id: "asks", "aria-label": "What is shown" },
    element("div", { class: "line" },
      select_of("tolerance", all_tolerances, chosen.tolerance),
      all_starts.length > 1 ? select_of("start", all_starts, chosen.start) : null,
      field_of("from", "contacts from", "number", String(least)),
      field_of("to", "to", "number", String(most)),
      field_of("find", "case", "search", "part of a name")),
    all_families.length > 1 ? switches_of("without_family", "families", all_families) : null,
    switches_of("without", "backends", all_solvers), counts,
    element("p", { class: "note" }, "The head of a column sorts its table, a name in a legend " +
      "switches its curves, a time or a point opens its solve. The address keeps the choice."),
    element("div", { class: "line" },
      button("rows shown as CSV", () => save("chosen.csv", rows.filter((row) => chosen.has(row) &&
        row.tolerance_text === chosen.tolerance && row.start === chosen.start))),
      button("all rows as CSV", () => save("results.csv", rows)),
      button("reset", () => { location.replace("#all="); })));
  const refresh = ({ cases, solvers }) => {
    const all_cases = unique(rows.map((row) => row.case));
    counts.textContent = `${cases.length} of ${all_cases.length} cases, ` +
      `${solvers.length} of ${all_solvers.length} backends`;
    for (const field of bar.querySelectorAll("input[type=checkbox]"))
      field.checked = !choice.has(field.name, field.value);
    for (const field of bar.querySelectorAll("input:not([type=checkbox])"))
      if (field !== document.activeElement) field.value = choice.get(field.name);
    bar.querySelectorAll("select").forEach((field) => { field.value = chosen[field.name]; });
  };
  return { element: bar, refresh };
}

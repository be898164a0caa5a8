// Sortable tables: a click on a head, or Enter on it, sorts by that column; a second one reverses
// the order. Cells sort by data-value where they have one, else by the number or the words in them.

function sort_key(cell) {
  if (!cell) return NaN;
  if (cell.dataset.value !== undefined) return Number(cell.dataset.value);
  const text = cell.textContent.trim(), value = value_of(text);
  return Number.isNaN(value) ? text : value;
}

/// Numbers come before words; missing values come last in both orders.
function compare_keys(a, b, way) {
  const is_missing = (key) => key === "" || key === dash || Number.isNaN(key);
  if (is_missing(a) || is_missing(b)) return is_missing(a) - is_missing(b);
  if (typeof a !== typeof b) return typeof a === "number" ? -1 : 1;
  return way * (typeof a === "number" ? a - b : a.localeCompare(b, "en", { numeric: true }));
}

function sort_table(table, column, way) {
  const body = table.tBodies[0];
  const keyed = [...body.rows].map((row) => [sort_key(row.cells[column]), row]);
  keyed.sort(([a], [b]) => compare_keys(a, b, way));
  body.append(...keyed.map(([, row]) => row));
  [...table.tHead.rows[0].cells].forEach((head, k) => {
    if (k === column) head.setAttribute("aria-sort", way > 0 ? "ascending" : "descending");
    else head.removeAttribute("aria-sort");
  });
}

/// Makes the heads of a table buttons that sort it and then call `sorted(column, way)`.
function make_sortable(table, sorted = () => {}) {
  if (!table.tHead || table.tBodies[0].rows.length < 2) return;
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    const sort = () => {
      const way = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
      sort_table(table, column, way);
      sorted(column, way);
    };
    const words = [...head.childNodes];
    const press = button("", sort, { class: "sort" });
    press.append(...words);
    head.append(press);
  });
}

/// The order last given to a table, [column, way], or null. The address keeps it
/// (sort=name:column:way): a table that is made anew has it, and so does a link.
function order_of(name) {
  const kept = choice.list("sort").find((one) => one.startsWith(name + ":"));
  return kept ? kept.slice(name.length + 1).split(":").map(Number) : null;
}
function keep_order(name, column, way) {
  const others = choice.list("sort").filter((one) => !one.startsWith(name + ":"));
  choice.set("sort", [...others, `${name}:${column}:${way}`]);
}

/// Returns a table in a scrollable box. A column is {title, number}. A row is a list of cells, each
/// a string or {text, value, kind, open}: `kind` is a class, `open` makes a button of the cell.
function table_of(name, columns, rows) {
  const cell_of = (cell, k) => {
    const { text, value, kind, open } = typeof cell === "string" ? { text: cell } : cell;
    const long = text.length > 24 ? " long" : "";
    const words = kind ? element("span", { class: kind }, text) : text;
    return element("td", { class: ((columns[k].number ? "n" : "") + long).trim() || null,
                           "data-value": value ?? null },
                   open ? button(words, open, { class: "cell" }) : words);
  };
  const table = element("table", { "data-name": name },
    element("thead", {}, element("tr", {}, ...columns.map((column) =>
      element("th", { class: column.number ? "n" : null }, column.title)))),
    element("tbody", {}, ...rows.map((cells) => element("tr", {}, ...cells.map(cell_of)))));
  make_sortable(table, (column, way) => keep_order(name, column, way));
  const order = order_of(name);
  if (order && columns[order[0]] && rows.length > 1) sort_table(table, ...order);
  // a column of empty cells is hidden
  columns.forEach((_, k) => {
    if (rows.length && [...table.tBodies[0].rows].every((row) => !row.cells[k].textContent))
      for (const row of table.rows) row.cells[k].hidden = true;
  });
  const wide = columns.length > 8 ? " wide" : "";
  return element("div", { class: "scroll" + wide, tabindex: 0, role: "region",
                          "aria-label": name }, table);
}

// The page of a comparison: the bar of choices stands first, and each section shows the selection
// in the place of its tables and figures for every tolerance and start.

const sections = [["backends", backends_view], ["matrix", matrix_view], ["profiles", profiles_view],
                  ["families", family_view], ["cost", cost_view], ["case-figures", case_view]];

/// Adds the holder of a section's live parts; tables that the program wrote stay for print.
function holder_of(id) {
  const section = document.getElementById(id);
  if (!section) return null;
  for (const block of section.querySelectorAll(":scope > :is(h3, .scroll)"))
    block.classList.add("still");
  const holder = element("div", { class: "live" });
  section.append(holder);
  return holder;
}

/// A row of each case and backend.
const row_of = new Map(rows.map((row) => [row.case + "\n" + row.solver, row]));

/// Hides the rows of "What must not happen" whose case or backend is not chosen.
function filter_failures() {
  for (const line of document.querySelectorAll("#failures tbody tr")) {
    const row = row_of.get(line.cells[0].textContent + "\n" + line.cells[1].textContent);
    line.hidden = row !== undefined && !chosen.has(row);
  }
}

const bar = asks(), holders = new Map(sections.map(([id]) => [id, holder_of(id)]));
document.querySelector("#backends").before(bar.element);

/// With many rows, waits until a section is painted before the next one is made.
const painted = () => rows.length > 10000 &&
  new Promise((done) => requestAnimationFrame(() => setTimeout(done)));

let drawn = null;
const shown = new Map();
async function refresh_all() {
  refresh_details();
  const asked = ["tolerance", "start", "from", "to", "find", "against", "family", "case", "without",
                 "without_family"].map((name) => choice.list(name).join("|")).join("&");
  if (asked === drawn) return;
  drawn = asked;
  const selected = selection();
  bar.refresh(selected);
  filter_failures();
  const focus = document.activeElement?.name;
  for (const [id, view] of sections) {
    const holder = holders.get(id);
    if (!holder) continue;
    for (const chart of shown.get(id) ?? []) chart.gone();
    const parts = view(selected).filter(Boolean);
    holder.replaceChildren(...parts.map((part) => part.element ?? part));
    shown.set(id, parts.filter((part) => part.draw));
    shown.get(id).forEach((chart) => chart.draw());
    if (focus) holder.querySelector(`[name="${focus}"]`)?.focus();
    const wait = painted();
    if (wait) await wait;
    if (asked !== drawn) return;  // something else has been chosen meanwhile
  }
}
refresh_all();
choice.changed(refresh_all);

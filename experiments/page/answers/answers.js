// Starts the page: makes every table of the page sortable, and turns every picture whose curves
// are in the page into a chart.

const page_data = JSON.parse(await (await unpacked(document.getElementById("page-data"))).text());
document.documentElement.classList.add("answers");
// tables whose first column has no head have their rows in groups: they do not sort
for (const table of document.querySelectorAll("main table:not(.facts)"))
  if (table.tHead?.rows[0].cells[0].textContent) make_sortable(table);
draw_pictures(page_data.pictures ?? []);

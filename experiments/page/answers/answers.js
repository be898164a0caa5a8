// Begins: every table that stands in the page sorts, every picture whose curves are in the page
// becomes a chart.

const page_data = JSON.parse(await (await unpacked(document.getElementById("page-data"))).text());
document.documentElement.classList.add("answers");
// tables whose first column has no head are in groups
for (const table of document.querySelectorAll("main table:not(.facts)"))
  if (table.tHead?.rows[0].cells[0].textContent) make_sortable(table);
draw_pictures(page_data.pictures ?? []);

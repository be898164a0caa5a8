// Begins: every table that stands in the page sorts, every picture whose curves are in the page
// becomes a chart.

const page_data = JSON.parse(document.getElementById("page-data").textContent);
document.documentElement.classList.add("answers");
for (const table of document.querySelectorAll("main table:not(.facts)")) make_sortable(table);
draw_pictures(page_data.pictures ?? []);
show_origins(page_data.origins ?? {});

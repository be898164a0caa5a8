// The page of a reproduction, from its sections.

#include "experiments/page/page.hpp"
#include "experiments/paper/paper_report.hpp"

namespace ballast {
namespace {

constexpr const char* title = "The paper, figure by figure";

page::Table agreement_table(const std::vector<PaperSection>& sections) {
  page::Table table;
  table.head = {"figure", "paper", "Ballast", "agreement"};
  for (const PaperSection& section : sections)
    for (const AgreementRow& row : section.rows)
      table.rows.push_back({row.place, row.paper, row.ballast, word_of(row.agreement)});
  return table;
}

page::Picture picture_of(const PaperFigure& figure) {
  const std::string& name = figure.plot.name;
  page::Picture picture{
      figure.plot,
      {page::marked("**Paper:** ") + figure.paper, page::marked("**Ballast:** ") + figure.found}};
  picture.files = page::Text("PDF", 0, "figures/" + name + ".pdf") + ", " +
                  page::Text("data", 0, "data/" + name + ".csv");
  return picture;
}

page::Section page_section(const PaperSection& section) {
  page::Section part{section.id, section.heading};
  part.add(page::Notices{{}, section.notes});
  for (const page::Text& paragraph : section.text) part.add(paragraph);
  for (const PaperFigure& figure : section.figures) part.add(picture_of(figure));
  for (page::Table table : section.tables) {
    table.caption += ":";
    part.add(table);
  }
  return part;
}

}  // namespace

page::Page paper_page(const std::vector<PaperSection>& sections,
                      const std::vector<page::Text>& origin) {
  page::Page page;
  page.title = title;
  page.lede = {page::words("paper.lede")};
  page.add({"origin", "What was run", {page::List{origin}}});
  page.add({"agreement", "Paper, Ballast, agreement", {agreement_table(sections)}});
  for (const PaperSection& section : sections) page.add(page_section(section));
  return page;
}

}  // namespace ballast

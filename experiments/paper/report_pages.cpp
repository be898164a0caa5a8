// The two pages of a reproduction's report, from the same words.

#include "experiments/page/html_page.hpp"
#include "experiments/paper/paper_report.hpp"

namespace ballast {
namespace {

constexpr const char* title = "The paper, figure by figure";
constexpr const char* lede =
    "Azéma, Radjaï, Peyroux, Dubois, Saussine: Vibrational dynamics of 3D granular media composed "
    "with polyhedral "
    "grains. Each figure is beside what "
    "the paper says about it. Scaling points are means over seeded samples with their standard "
    "error; intervals of "
    "fits are at 95 %.";

/// One row for the table of agreement.
std::vector<std::string> cells_of(const AgreementRow& row) {
  return {row.place, row.paper, row.ballast, word_of(row.agreement)};
}
const std::vector<std::string> agreement_head = {"figure", "paper", "Ballast", "agreement"};

std::string markdown_table(const std::vector<std::string>& head,
                           const std::vector<std::vector<std::string>>& rows) {
  const auto line = [](const std::vector<std::string>& cells) {
    std::string text = "|";
    for (std::string cell : cells) {
      for (size_t at = 0; (at = cell.find('|', at)) != std::string::npos; at += 2)
        cell.insert(at, 1, '\\');
      text += ' ' + cell + " |";
    }
    return text + '\n';
  };
  std::string text = line(head) + "|";
  for (size_t k = 0; k < head.size(); ++k) text += "---|";
  text += '\n';
  for (const auto& row : rows) text += line(row);
  return text + '\n';
}

Html html_table(const std::vector<std::string>& head,
                const std::vector<std::vector<std::string>>& rows) {
  HtmlTable table;
  for (const std::string& cell : head) table.head.push_back(escaped(cell));
  for (const auto& row : rows) {
    table.rows.emplace_back();
    for (const std::string& cell : row) table.rows.back().push_back(escaped(cell));
  }
  return to_html(table);
}

std::vector<std::vector<std::string>> agreement_rows(const std::vector<PaperSection>& sections) {
  std::vector<std::vector<std::string>> rows;
  for (const PaperSection& section : sections)
    for (const AgreementRow& row : section.rows) rows.push_back(cells_of(row));
  return rows;
}

std::string markdown_section(const PaperSection& section) {
  std::string text = "## " + section.heading + "\n\n";
  for (const std::string& note : section.notes) text += "**" + note + "**\n\n";
  for (const std::string& paragraph : section.text) text += paragraph + "\n\n";
  for (const PaperFigure& figure : section.figures) {
    const std::string& name = figure.plot.name;
    text += "![" + figure.plot.title + "](figures/" + name + ".svg)\n\n";
    text += "[PDF](figures/" + name + ".pdf), [data](data/" + name + ".csv)\n\n";
    text += "*Paper:* " + figure.paper + "\n\n*Ballast:* " + figure.found + "\n\n";
  }
  for (const TextTable& table : section.tables)
    text += table.caption + ":\n\n" + markdown_table(table.head, table.rows);
  return text;
}

Html html_part(const PaperSection& section, const std::vector<std::string>& pictures,
               size_t& picture) {
  Html body;
  if (!section.notes.empty()) {
    body += Html{"<div class=\"notices\" role=\"note\"><ul>\n"};
    for (const std::string& note : section.notes)
      body += Html{"<li><b>"} + escaped(note) + Html{"</b></li>\n"};
    body += Html{"</ul></div>\n"};
  }
  for (const std::string& paragraph : section.text)
    body += Html{"<p>"} + escaped(paragraph) + Html{"</p>\n"};
  for (const PaperFigure& figure : section.figures) {
    const std::string svg = picture < pictures.size() ? pictures[picture] : std::string();
    ++picture;
    const Html caption = Html{"<b>Paper:</b> "} + escaped(figure.paper) +
                         Html{"<br><b>Ballast:</b> "} + escaped(figure.found);
    body += html_figure(figure.plot.name, inline_svg(svg, figure.plot.name, figure.plot.title),
                        caption);
  }
  for (const TextTable& table : section.tables)
    body +=
        Html{"<p>"} + escaped(table.caption) + Html{":</p>\n"} + html_table(table.head, table.rows);
  return html_section(section.id, escaped(section.heading), body);
}

}  // namespace

std::string markdown_of(const std::vector<PaperSection>& sections,
                        const std::vector<std::string>& origin) {
  std::string text = std::string("# ") + title + "\n\n" + lede + "\n\n";
  for (const std::string& line : origin) text += "- " + line + '\n';
  text +=
      "\n`ballast paper report` writes this page; it also is [one HTML page](paper.html) that "
      "opens offline.\n\n";
  text +=
      "## Paper, Ballast, agreement\n\n" + markdown_table(agreement_head, agreement_rows(sections));
  for (const PaperSection& section : sections) text += markdown_section(section);
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

std::string html_of(const std::vector<PaperSection>& sections,
                    const std::vector<std::string>& origin,
                    const std::vector<std::string>& pictures) {
  Html body = Html{"<header>\n<h1>"} + escaped(title) + Html{"</h1>\n<p class=\"lede\">"} +
              escaped(lede) + Html{"</p>\n</header>\n"};
  Html list{"<ul>\n"};
  for (const std::string& line : origin) list += Html{"<li>"} + escaped(line) + Html{"</li>\n"};
  body += html_section("origin", {"What was run"}, list + Html{"</ul>\n"});
  body += html_section("agreement", {"Paper, Ballast, agreement"},
                       html_table(agreement_head, agreement_rows(sections)));
  size_t picture = 0;
  for (const PaperSection& section : sections) body += html_part(section, pictures, picture);
  return html_page(title, body);
}

}  // namespace ballast

#include "experiments/page/html_page.hpp"

#include "experiments/page/html.hpp"
#include "experiments/page/page_style.hpp"

namespace ballast {

Html escaped(std::string_view text) { return {page::escaped_html(text)}; }

Html number(double value, int digits) { return {page::html_of(page::number(value, digits))}; }

Html exact(double value, int digits) { return {page::html_of(page::exact(value, digits))}; }

Html quantity(double value, const char* unit, int digits) {
  return {page::html_of(page::quantity(value, unit, digits))};
}

Html verdict(double value, double bound) { return {page::html_of(page::verdict(value, bound))}; }

Html to_html(const HtmlTable& table) {
  const auto row = [&](const std::vector<Html>& cells, const char* tag) {
    std::string markup = "<tr>";
    for (size_t c = 0; c < cells.size(); ++c) {
      const bool is_number = c < table.is_number.size() && table.is_number[c];
      markup += std::string("<") + tag + (is_number ? " class=\"n\">" : ">") + cells[c].markup +
                "</" + tag + '>';
    }
    return markup + "</tr>\n";
  };
  std::string markup = "<div class=\"scroll\"><table" +
                       (table.css_class.empty() ? "" : " class=\"" + table.css_class + '"') + ">\n";
  if (!table.head.empty()) markup += "<thead>" + row(table.head, "th") + "</thead>\n";
  markup += "<tbody>\n";
  for (const auto& cells : table.rows) markup += row(cells, "td");
  return {markup + "</tbody></table></div>\n"};
}

Html inline_svg(std::string_view svg, const std::string& name, const std::string& title) {
  return {page::inline_svg(svg, name, title)};
}

Html html_figure(const std::string& name, const Html& picture, const Html& caption) {
  return {"<figure id=\"" + escaped(name).markup + "\">\n" + picture.markup + "<figcaption>" +
          caption.markup + "</figcaption>\n</figure>\n"};
}

Html html_section(const std::string& id, const Html& heading, const Html& body) {
  return {"<section id=\"" + id + "\">\n<h2>" + heading.markup + "</h2>\n" + body.markup +
          "</section>\n"};
}

std::string html_page(const std::string& title, const Html& body) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta name=\"color-scheme\" content=\"light dark\">\n<title>" +
         escaped(title).markup + "</title>\n<style>\n" + page::style_sheet() +
         "</style>\n</head>\n<body>\n<main>\n" + body.markup + "</main>\n</body>\n</html>\n";
}

}  // namespace ballast

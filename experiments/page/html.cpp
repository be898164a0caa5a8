#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <tuple>

#include <nlohmann/json.hpp>

#include "experiments/page/page.hpp"
#include "platform/deflate.hpp"
#include "platform/text.hpp"

namespace ballast {

std::string answers_file(const std::string& name);  // of experiments/page/answers
std::string replay_file(const std::string& name);   // of experiments/page/replay
std::string style_sheet();                          // experiments/page/style.css
std::string chart_library();                        // Chart.js; empty: not found when configured

namespace page {

namespace {

using Json = nlohmann::ordered_json;

/// The inks' variables in the style sheet, in the order of Ink.
constexpr const char* variables[] = {"ink", "blue",   "vermilion", "green", "orange",
                                     "sky", "purple", "grey",      "light"};

/// CSS rules that replace the colours of the figures by variables of the page.
std::string palette_rules() {
  std::string rules;
  const auto add = [&](const std::string& rgb, const char* variable) {
    for (const char* property : {"stroke", "fill", "color"})
      rules += std::string("svg [") + property + "=\"" + rgb + "\"]{" + property + ":var(--" +
               variable + ")}\n";
  };
  add("black", "ink");
  add("rgb(224, 224, 224)", "grid");
  for (size_t k = 0; k < std::size(variables); ++k) {
    const long value = std::strtol(rgb_of(Ink(k)) + 1, nullptr, 16);
    // gnuplot writes the colours of words in the first form and all others in the second
    for (const char* form : {"rgb(%ld,%ld,%ld)", "rgb(%3ld, %3ld, %3ld)"})
      add(printed(form, value >> 16, (value >> 8) & 255, value & 255), variables[k]);
  }
  return rules;
}

/// Cuts every stretch from `begin` to `end`, both included.
void cut_all(std::string& text, std::string_view begin, std::string_view end) {
  for (size_t at = 0; (at = text.find(begin, at)) != std::string::npos;) {
    const size_t close = text.find(end, at + begin.size());
    text.erase(at, close == std::string::npos ? std::string::npos : close + end.size() - at);
  }
}

// The modules in the order in which they build upon each other.
constexpr std::array common_modules = {"elements.js", "choice.js", "numbers.js",  "tables.js",
                                       "legends.js",  "charts.js", "pictures.js", "answers.js"};
constexpr std::array replay_modules = {
    "vector.js", "colour.js", "data.js",  "camera.js", "shader.js", "mesh.js",  "stage.js",
    "shades.js", "marks.js",  "plots.js", "panel.js",  "errors.js", "input.js", "replay.js"};

/// A script element with modules; other scripts do not see their names.
std::string script_of(const std::string& modules) {
  return "<script>\n(async () => {\n\"use strict\";\n" + modules + "})();\n</script>\n";
}

/// The values with five digits, more than a chart shows; NaN becomes null, since JSON has no NaN.
Json short_numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values)
    list.push_back(std::isfinite(value) ? Json(parsed_number(printed("%.5g", value)).value_or(0.0))
                                        : Json());
  return list;
}

Json axis_json(const Text& label, bool is_log, const std::optional<double>& low,
               const std::optional<double>& high) {
  Json axis = {{"label", html_of(label)}, {"words", plain_words(label)}, {"log", is_log}};
  if (low) axis["min"] = *low;
  if (high) axis["max"] = *high;
  return axis;
}

Json curve_json(const Curve& curve) {
  constexpr const char* kinds[] = {"line", "line", "points", "area"};  // in the order of Mark
  return {{"title", plain_words(curve.title)},
          {"ink", name_in(variables, curve.ink)},
          {"dash", curve.dash},
          {"width", curve.width},
          {"mark", name_in(kinds, curve.mark)},
          {"marked", curve.mark == Mark::marked_line},
          {"x", short_numbers(curve.x)},
          {"y", short_numbers(curve.y)},
          {"error", short_numbers(curve.y_error)},
          {"low", short_numbers(curve.y_low)}};
}

Json figure_json(const Figure& figure) {
  Json panels = Json::array();
  for (const Panel& panel : figure.panels) {
    Json curves = Json::array(), lines = Json::array();
    for (const Curve& curve : panel.curves) curves.push_back(curve_json(curve));
    for (const ReferenceLine& line : panel.lines)
      lines.push_back(
          {{"value", line.value}, {"vertical", line.vertical}, {"label", plain_words(line.label)}});
    panels.push_back({{"x", axis_json(panel.x_label, panel.log_x, panel.x_min, panel.x_max)},
                      {"y", axis_json(panel.y_label, panel.log_y, panel.y_min, panel.y_max)},
                      {"curves", curves},
                      {"lines", lines}});
  }
  return {{"name", figure.name}, {"title", figure.title}, {"panels", panels}};
}

/// An element with bytes that the page's scripts unpack by unpacked() of answers/elements.js.
std::string packed(const std::string& id, const std::string& bytes) {
  return "<script type=\"text/plain\" id=\"" + id + "\">" + base64(deflated(bytes, 9)) +
         "</script>\n";
}

/// The page's own data, and the curves of its figures as "pictures".
std::string page_data_json(const Page& page) {
  const std::string own = page.answers.data.empty() ? "{}" : page.answers.data;
  if (!page.answers.has_charts) return own;
  Json data = Json::parse(own);
  Json& pictures = data["pictures"] = Json::array();
  for (const Section& section : page.sections)
    for (const Block& block : section.blocks)
      if (const auto* picture = std::get_if<Picture>(&block))
        pictures.push_back(figure_json(picture->plot));
  return data.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Tables of more columns than this may be wider than the text.
constexpr size_t widest_in_text = 8;

/// True for cells that have a least width, so that their many letters do not stand in a tower.
bool is_long(const Text& cell) {
  const std::string words = plain_words(cell);
  const auto begins_letter = [](char byte) { return (byte & 0xc0) != 0x80; };  // in UTF-8
  return std::ranges::count_if(words, begins_letter) > 40;
}

std::string row_of(const Table& table, const std::vector<Text>& cells, const std::string& tag) {
  std::string html = "<tr>";
  for (size_t c = 0; c < cells.size(); ++c) {
    const bool is_number = c < table.is_number.size() && table.is_number[c];
    const char* kind = is_number ? " class=\"n\"" : is_long(cells[c]) ? " class=\"long\"" : "";
    html += '<' + tag + kind + '>' + html_of(cells[c]) + "</" + tag + '>';
  }
  return html + "</tr>\n";
}

std::string items_of(const std::vector<Text>& items) {
  std::string html = "<ul>\n";
  for (const Text& item : items) html += "<li>" + html_of(item) + "</li>\n";
  return html + "</ul>";
}

struct HtmlBlocks {
  std::string operator()(const Text& text) const { return "<p>" + html_of(text) + "</p>\n"; }
  std::string operator()(const Subheading& heading) const {
    return "<h3>" + html_of(heading.words) + "</h3>\n";
  }
  std::string operator()(const List& list) const { return items_of(list.items) + '\n'; }
  std::string operator()(const Table& table) const {
    std::string html = table.caption.empty() ? "" : (*this)(table.caption);
    const bool is_wide = table.head.size() > widest_in_text;
    html += std::string("<div class=\"scroll") + (is_wide ? " wide" : "") + "\"><table" +
            (table.is_facts ? " class=\"facts\">\n" : ">\n");
    if (!table.head.empty()) html += "<thead>" + row_of(table, table.head, "th") + "</thead>\n";
    html += "<tbody>\n";
    for (const auto& cells : table.rows) html += row_of(table, cells, "td");
    return html + "</tbody></table></div>\n";
  }
  std::string operator()(const Picture& picture) const {
    std::string html = "<figure id=\"" + escaped_html(picture.plot.name) + "\">\n" +
                       inline_svg(picture.svg, picture.plot.name, picture.plot.title) +
                       "<figcaption>";
    for (size_t k = 0; k < picture.caption.size(); ++k)
      html += (k == 0 ? "" : "<br>") + html_of(picture.caption[k]);
    return html + "</figcaption>\n</figure>\n";
  }
  std::string operator()(const Notices& notices) const {
    return "<div class=\"notices\" role=\"note\">" +
           (notices.heading.empty() ? "" : "<b>" + html_of(notices.heading) + "</b>") +
           items_of(notices.items) + "</div>\n";
  }
  std::string operator()(const Listing& listing) const {
    const std::string box = "<pre>" + escaped_html(listing.text) + "</pre>";
    if (listing.heading.empty()) return box + '\n';
    return "<details><summary>" + html_of(listing.heading) + "</summary>\n" + box + "</details>\n";
  }
  std::string operator()(const Replay& replay) const {
    std::string html = "<figure class=\"replay\" id=\"replay\">\n<style>\n" +
                       replay_file("replay.css") + "</style>\n<div id=\"replay-stage\">";
    if (!replay.still.empty())
      html += "<img alt=\"The bodies in 3D: a still picture\" src=\"data:image/png;base64," +
              base64(replay.still) + "\">";
    html +=
        "</div>\n<p id=\"replay-sentence\">This picture moves in a browser with WebGL 2 and "
        "scripts.</p>\n";
    if (!replay.caption.empty())
      html += "<figcaption>" + html_of(replay.caption) + "</figcaption>\n";
    std::string head = replay.head;  // without "<" it cannot end its element or begin a comment
    replace_all(head, "<", "\\u003c");
    html += "<script type=\"application/json\" id=\"replay-head\">" + head + "</script>\n";
    for (const auto& [name, bytes] : replay.parts) html += packed("replay-" + name, bytes);
    std::string modules = answers_file("elements.js") + answers_file("choice.js");
    for (const char* name : replay_modules) modules += replay_file(name);
    return html + script_of(modules) + "</figure>\n";
  }
};

/// The last elements of a page with answers: data, library and modules. Empty for other pages, and
/// when the program was built without the library.
std::string answers_html(const Page& page) {
  if (!page.answers.is_enabled || !has_chart_library()) return {};
  std::string modules;
  for (const char* name : common_modules) modules += answers_file(name);
  for (const std::string& module : page.answers.modules) modules += module;
  return "<style>\n" + answers_file("answers.css") + "</style>\n" +
         packed("page-data", page_data_json(page)) + "<script>\n" + chart_library() +
         "</script>\n" + script_of(modules);
}

}  // namespace

std::string escaped_html(std::string_view text) {
  std::string html = clean_utf8(text);
  for (const auto& [character, entity] :
       {std::pair("&", "&amp;"), {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}, {"'", "&#39;"}})
    replace_all(html, character, entity);
  return html;
}

std::string html_of(const Text& text) {
  // the tags around a run, the innermost first
  static constexpr std::tuple<Styles, const char*, const char*> tags[] = {
      {superscript, "<sup>", "</sup>"},
      {subscript, "<sub>", "</sub>"},
      {symbol, "<i>", "</i>"},
      {code, "<code>", "</code>"},
      {bad, "<span class=\"missed\">", "</span>"},
      {good, "<span class=\"met\">", "</span>"},
      {note, "<span class=\"note\">", "</span>"},
      {strong, "<b>", "</b>"}};
  std::string html;
  for (const Span& span : text.spans) {
    std::string words = escaped_html(span.text);
    replace_all(words, "\n", "<br>");
    for (const auto& [style, open, close] : tags)
      if (span.styles & style) words = open + words + close;
    if (!span.link.empty()) words = "<a href=\"" + escaped_html(span.link) + "\">" + words + "</a>";
    html += words;
  }
  return html;
}

std::string html_of(const Block& block) {
  return is_empty(block) ? std::string() : std::visit(HtmlBlocks{}, block);
}

std::string html_of(const Page& page) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>" +
      escaped_html(page.title) + "</title>\n<style>\n" + style_sheet() + palette_rules() +
      "</style>\n</head>\n<body>\n<main>\n<header>\n<h1>" + escaped_html(page.title) + "</h1>\n";
  for (const Text& line : page.lede)
    if (!line.empty()) html += "<p class=\"lede\">" + html_of(line) + "</p>\n";
  html += "</header>\n" + html_of(Block(page.notices));
  for (const Section& section : page.sections) {
    if (section.is_empty()) continue;
    html += "<section id=\"" + escaped_html(section.id) + "\">\n<h2>" + html_of(section.heading) +
            "</h2>\n";
    for (const Block& block : section.blocks) html += html_of(block);
    html += "</section>\n";
  }
  if (page.answers.is_enabled && !has_chart_library())
    html += "<p class=\"note\">" + html_of(words("answers.missing")) + "</p>\n";
  return html + "</main>\n" + answers_html(page) + "</body>\n</html>\n";
}

std::string inline_svg(std::string_view svg, const std::string& name, const std::string& title) {
  std::string text(svg.substr(std::min(svg.find("<svg"), svg.size())));
  if (text.empty()) return text;
  cut_all(text, "<!--", "-->");
  cut_all(text, "<desc>", "</desc>");
  // gnuplot gives its marks the same ids in every file
  for (const char quote : {'\'', '"'}) {
    replace_all(text, std::string("id=") + quote, std::string("id=") + quote + name + '-');
    replace_all(text, std::string("href=") + quote + '#',
                std::string("href=") + quote + '#' + name + '-');
  }
  replace_all(text, "url(#", "url(#" + name + '-');
  const size_t begin = text.find("<title>"), end = text.find("</title>");
  if (begin != std::string::npos && end != std::string::npos && begin < end)
    text.replace(begin + 7, end - begin - 7, escaped_html(title));
  return text.replace(0, 4, "<svg role=\"img\"");
}

bool has_chart_library() { return !chart_library().empty(); }

}  // namespace page
}  // namespace ballast

#include "experiments/page/html_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "experiments/page/page_style.hpp"
#include "experiments/page/plot.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

/// Length of the UTF-8 sequence at the start of `text`; 0 when it is none (overlong, surrogate,
/// cut).
size_t utf8_length(std::string_view text) {
  const auto byte = [&](size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const size_t length = first >= 0xf0 && first < 0xf5 ? 4
                        : first >= 0xe0               ? 3
                        : first >= 0xc2               ? 2
                                                      : 0;
  if (length == 0 || first >= 0xf5 || text.size() < length) return 0;
  for (size_t k = 1; k < length; ++k)
    if ((byte(k) & 0xc0) != 0x80) return 0;
  if ((first == 0xe0 && byte(1) < 0xa0) || (first == 0xed && byte(1) >= 0xa0)) return 0;
  if ((first == 0xf0 && byte(1) < 0x90) || (first == 0xf4 && byte(1) >= 0x90)) return 0;
  return length;
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// Cuts every stretch from `begin` to `end`, both included.
void cut_all(std::string& text, std::string_view begin, std::string_view end) {
  for (size_t at = 0; (at = text.find(begin, at)) != std::string::npos;) {
    const size_t close = text.find(end, at + begin.size());
    text.erase(at, close == std::string::npos ? std::string::npos : close + end.size() - at);
  }
}

/// "rgb(  0, 114, 178)" to "rgb(0,114,178)": the style sheet matches the attribute's text.
void tighten_colours(std::string& text) {
  for (size_t at = 0; (at = text.find("rgb(", at)) != std::string::npos; ++at) {
    const size_t close = text.find(')', at);
    if (close == std::string::npos) return;
    const auto begin = text.begin() + static_cast<long>(at),
               end = text.begin() + static_cast<long>(close);
    text.erase(std::remove(begin, end, ' '), end);
  }
}

std::string without_trailing_zeros(std::string digits) {
  if (digits.find('.') == std::string::npos) return digits;
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return digits;
}

std::string number_text(double value, int digits, bool is_exact) {
  if (!std::isfinite(value)) return "<span class=\"unknown\">–</span>";
  if (value == 0.0) return "0";
  // the rounded value decides, so that 999999.9 isn't printed as 1.00e+06
  const std::string text = printed("%.*e", digits - 1, value);
  const size_t mark = text.find('e');
  const int exponent = std::atoi(text.c_str() + mark + 1);
  const bool has_power = exponent < -3 || exponent >= 6;
  std::string result = text.substr(0, mark), power;
  if (has_power) {
    power = "×10<sup>" + std::string(exponent < 0 ? "−" : "") + std::to_string(std::abs(exponent)) +
            "</sup>";
  } else {
    result = printed("%.*f", std::max(0, digits - 1 - exponent), value);
  }
  if (is_exact) result = without_trailing_zeros(result);
  if (result[0] == '-') result.replace(0, 1, "−");
  return result + power;
}

/// Rules that turn one colour of the figures into a variable of the page.
std::string colour_rules(const std::string& rgb, const std::string& variable) {
  std::string rules;
  for (const char* property : {"stroke", "fill", "color"})
    rules += std::string("svg [") + property + "=\"" + rgb + "\"]{" + property + ":var(" +
             variable + ")}\n";
  return rules;
}

std::string attribute_form(const char* hex) {
  const long value = std::strtol(hex + 1, nullptr, 16);
  return printed("rgb(%ld,%ld,%ld)", value >> 16, (value >> 8) & 255, value & 255);
}

std::string palette_rules() {
  std::string rules = colour_rules("black", "--ink") + colour_rules("rgb(224,224,224)", "--grid");
  constexpr std::pair<Ink, const char*> inks[] = {
      {Ink::black, "--ink"},     {Ink::blue, "--blue"},     {Ink::vermilion, "--vermilion"},
      {Ink::green, "--green"},   {Ink::orange, "--orange"}, {Ink::sky, "--sky"},
      {Ink::purple, "--purple"}, {Ink::yellow, "--yellow"}, {Ink::grey, "--grey"},
      {Ink::light, "--light"}};
  for (const auto& [ink, variable] : inks)
    rules += colour_rules(attribute_form(rgb_of(ink)), variable);
  return rules;
}

}  // namespace

Html escaped(std::string_view text) {
  Html html;
  for (size_t at = 0; at < text.size();) {
    const unsigned char c = static_cast<unsigned char>(text[at]);
    const size_t length = utf8_length(text.substr(at));
    const bool is_control = (c < 0x20 && c != '\n' && c != '\t' && c != '\r') || c == 0x7f;
    if (length == 0 || is_control)
      html.markup += "\xef\xbf\xbd";
    else if (c == '&')
      html.markup += "&amp;";
    else if (c == '<')
      html.markup += "&lt;";
    else if (c == '>')
      html.markup += "&gt;";
    else if (c == '"')
      html.markup += "&quot;";
    else if (c == '\'')
      html.markup += "&#39;";
    else
      html.markup += text.substr(at, length);
    at += std::max<size_t>(length, 1);
  }
  return html;
}

Html number(double value, int digits) { return {number_text(value, digits, false)}; }

Html exact(double value, int digits) { return {number_text(value, digits, true)}; }

Html quantity(double value, const char* unit, int digits) {
  if (!std::isfinite(value)) return number(value);
  return {number(value, digits).markup + "&#8239;" + unit};
}

Html verdict(double value, double bound) {
  if (std::isnan(value) || std::isnan(bound)) return {};
  return value <= bound ? Html{"<span class=\"met\">✓ met</span>"}
                        : Html{"<span class=\"missed\">✗ missed</span>"};
}

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
  std::string text(svg);
  cut_all(text, "<?xml", "?>");
  cut_all(text, "<!DOCTYPE", ">");
  cut_all(text, "<!--", "-->");
  cut_all(text, "<desc>", "</desc>");
  // gnuplot numbers its marks alike in every file
  for (const char quote : {'\'', '"'}) {
    replace_all(text, std::string("id=") + quote, std::string("id=") + quote + name + '-');
    replace_all(text, std::string("href=") + quote + '#',
                std::string("href=") + quote + '#' + name + '-');
  }
  replace_all(text, "url(#", "url(#" + name + '-');
  tighten_colours(text);
  const size_t begin = text.find("<title>"), end = text.find("</title>");
  if (begin != std::string::npos && end != std::string::npos && begin < end)
    text.replace(begin + 7, end - begin - 7, escaped(title).markup);
  const size_t root = text.find("<svg");
  if (root != std::string::npos) text.replace(root, 4, "<svg role=\"img\"");
  return {text};
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
         escaped(title).markup + "</title>\n<style>\n" + page_style + palette_rules() +
         "</style>\n</head>\n<body>\n<main>\n" + body.markup + "</main>\n</body>\n</html>\n";
}

}  // namespace ballast

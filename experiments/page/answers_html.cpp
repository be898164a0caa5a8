// answers_html of html.hpp: the script of a page whose tables sort and whose figures answer, with
// its data and the library that draws.

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "experiments/page/html.hpp"
#include "platform/text.hpp"

namespace ballast {

std::string answers_file(const std::string& name);  // of experiments/page/answers
std::string chart_library();                        // Chart.js; empty: not found when configured

namespace page {
namespace {

using Json = nlohmann::ordered_json;

/// The modules in the order in which they build upon each other.
constexpr std::array common_modules = {"elements.js", "choice.js",  "numbers.js", "tables.js",
                                       "palette.js",  "legends.js", "charts.js",  "origins.js",
                                       "pictures.js", "answers.js"};

/// Five digits are more than a chart shows; JSON has no NaN.
Json short_number(double value) {
  return std::isfinite(value) ? Json(parsed_number(printed("%.5g", value)).value_or(0.0)) : Json();
}

Json short_numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(short_number(value));
  return list;
}

Json axis_json(const std::string& label, bool is_log, const std::optional<double>& low,
               const std::optional<double>& high) {
  const Text words = label_words(label);
  Json axis = {{"label", html_of(words)}, {"words", plain_words(words)}, {"log", is_log}};
  if (low) axis["min"] = *low;
  if (high) axis["max"] = *high;
  return axis;
}

/// The ink's variable in the style sheet.
const char* variable_of(Ink ink) {
  // in the order of Ink
  constexpr const char* names[] = {"ink", "blue",   "vermilion", "green", "orange",
                                   "sky", "purple", "yellow",    "grey",  "light"};
  return names[static_cast<size_t>(ink)];
}

Json curve_json(const Curve& curve) {
  const bool is_area = curve.mark == Mark::area;
  return {{"title", plain_words(label_words(curve.title))},
          {"ink", variable_of(curve.ink)},
          {"dash", curve.dashed ? 1 + curve.fineness : 0},
          {"width", curve.width},
          {"mark", is_area                      ? "area"
                   : curve.mark == Mark::points ? "points"
                                                : "line"},
          {"x", short_numbers(curve.x)},
          {"y", short_numbers(curve.y)},
          {"error", short_numbers(curve.y_error)},
          {"low", short_numbers(curve.y_low)},
          {"from", curve.origins}};
}

Json picture_json(const Figure& figure) {
  Json panels = Json::array();
  for (const Panel& panel : figure.panels) {
    Json curves = Json::array(), lines = Json::array();
    for (const Curve& curve : panel.curves) curves.push_back(curve_json(curve));
    for (const ReferenceLine& line : panel.lines)
      lines.push_back({{"value", line.value},
                       {"vertical", line.vertical},
                       {"label", plain_words(label_words(line.label))}});
    panels.push_back({{"x", axis_json(panel.x_label, panel.log_x, panel.x_min, panel.x_max)},
                      {"y", axis_json(panel.y_label, panel.log_y, panel.y_min, panel.y_max)},
                      {"curves", curves},
                      {"lines", lines}});
  }
  return {{"name", figure.name}, {"title", figure.title}, {"panels", panels}};
}

/// The page's own data, and the curves of its figures as "pictures".
std::string data_of(const Page& page) {
  Json data = page.answers.data.empty() ? Json::object() : Json::parse(page.answers.data);
  if (page.answers.with_curves) {
    Json& pictures = data["pictures"] = Json::array();
    for (const Section& section : page.sections)
      for (const Block& block : section.blocks)
        if (const auto* picture = std::get_if<Picture>(&block))
          pictures.push_back(picture_json(picture->plot));
  }
  // no "<" can end the element or begin a comment in it
  std::string json;
  for (const char c : data.dump(-1, ' ', false, Json::error_handler_t::replace))
    json += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return json;
}

}  // namespace

bool can_answer() { return !chart_library().empty(); }

std::string answers_html(const Page& page) {
  if (!page.answers.are_given || !can_answer()) return {};
  std::string whole = "(() => {\n\"use strict\";\n";
  for (const char* name : common_modules) whole += answers_file(name);
  for (const std::string& module : page.answers.modules) whole += module;
  return "<style>\n" + answers_file("answers.css") +
         "</style>\n<script type=\"application/json\" id=\"page-data\">" + data_of(page) +
         "</script>\n<script>\n" + chart_library() + "</script>\n<script>\n" + whole +
         "})();\n</script>\n";
}

}  // namespace page
}  // namespace ballast

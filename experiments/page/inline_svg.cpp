// inline_svg of html.hpp: a file that gnuplot wrote becomes a part of a page.

#include <algorithm>

#include "experiments/page/html.hpp"

namespace ballast::page {
namespace {

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

}  // namespace

std::string inline_svg(std::string_view svg, const std::string& name, const std::string& title) {
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
    text.replace(begin + 7, end - begin - 7, escaped_html(title));
  const size_t root = text.find("<svg");
  if (root != std::string::npos) text.replace(root, 4, "<svg role=\"img\"");
  return text;
}

}  // namespace ballast::page

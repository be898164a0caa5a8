// There is no markup outside experiments/page, the only room that knows HTML and Markdown.

#include <algorithm>
#include <cctype>
#include <cstring>
#include <regex>

#include "tests/catch.hpp"
#include "tests/house/source_tree.hpp"

using namespace ballast::house;

namespace {

constexpr const char* home = "experiments/page/";

/// A text between quotation marks in C++ and the line it begins in. Escapes stay as written.
struct Literal {
  std::string text;
  size_t line = 1;
};

std::vector<Literal> literals_of(const std::string& source) {
  std::vector<Literal> found;
  size_t line = 1;
  const auto starts = [&](size_t at, const char* what) {
    return source.compare(at, std::strlen(what), what) == 0;
  };
  for (size_t at = 0; at < source.size();) {
    // The comment, literal or character that begins at `at` ends at `end`.
    const size_t begin = at;
    size_t end = at + 1;
    if (starts(at, "//")) {
      end = source.find('\n', at);
    } else if (starts(at, "/*")) {
      end = source.find("*/", at + 2) + 2;
    } else if (starts(at, "R\"")) {
      const size_t open = source.find('(', at);
      const std::string close = ')' + source.substr(at + 2, open - at - 2) + '"';
      end = source.find(close, open);
      found.push_back({source.substr(open + 1, end - open - 1), line});
      end += close.size();
    } else if (source[at] == '"' || source[at] == '\'') {
      // An apostrophe after a digit only separates digits.
      const bool is_separator =
          source[at] == '\'' && at > 0 && std::isalnum(static_cast<unsigned char>(source[at - 1]));
      while (!is_separator && end < source.size() && source[end] != source[at])
        end += source[end] == '\\' ? 2 : 1;
      if (source[at] == '"') found.push_back({source.substr(at + 1, end - at - 1), line});
      if (!is_separator) ++end;
    }
    at = std::min(end, source.size());
    line += static_cast<size_t>(std::count(source.begin() + static_cast<long>(begin),
                                           source.begin() + static_cast<long>(at), '\n'));
  }
  return found;
}

/// The markup in a literal; empty when there is none. XML of other programs (ParaView's) does not
/// count: its elements have capital letters.
std::string markup_in(const std::string& text) {
  static const std::regex html(
      "</?(a|b|i|p|u|br|hr|em|li|td|th|tr|ul|ol|h[1-6]|dl|dt|dd|div|img|nav|pre|sub|sup|svg|css|"
      "body|code|head|html|main|span|link|meta|rect|path|small|table|tbody|thead|style|title|"
      "figure|footer|header|script|section|details|summary|strong|figcaption)([ />\\\\]|$)|"
      "<!DOCTYPE|&(amp|lt|gt|quot|nbsp|#\\d+);");
  static const std::regex markdown(R"re(\|:?---|---:?\||(^|\\n)\| |(^|\\n)##+ |```|!\[)re");
  for (const std::regex* pattern : {&html, &markdown})
    if (std::smatch found; std::regex_search(text, found, *pattern)) return found.str();
  return {};
}

std::vector<std::string> markup_breaches(const std::string& path, const std::string& source) {
  std::vector<std::string> found;
  if (path.starts_with(home)) return found;
  for (const Literal& literal : literals_of(source))
    if (const std::string markup = markup_in(literal.text); !markup.empty())
      found.push_back(path + ":" + std::to_string(literal.line) + ": \"" + markup +
                      "\" is for experiments/page to write");
  return found;
}

}  // namespace

TEST_CASE("HTML and Markdown are written by experiments/page alone") {
  for (const SourceFile& file : all_sources(false))
    for (const std::string& breach : markup_breaches(file.path, file.text)) FAIL_CHECK(breach);
}

TEST_CASE("markup in a literal is seen, with its line, and what only looks like it is not") {
  const std::string markup =
      R"--(f("<td>", "x</b> y", "<figure id=\"x\">", "|---|---|", "a |---:|");
f(1'000, "| a | b |", "\n## A\n", "a &lt; b", "<br>", R"x(<html>)x", "![a](b.svg)");
f("```");)--";
  const std::vector<std::string> found = markup_breaches("experiments/run/a.cpp", markup);
  REQUIRE(found.size() == 12);
  CHECK_THAT(found[0], Catch::StartsWith("experiments/run/a.cpp:1: \"<td>\""));
  CHECK_THAT(found[11], Catch::StartsWith("experiments/run/a.cpp:3: \"```\""));
  CHECK(markup_breaches("experiments/page/a.cpp", markup).empty());
  const char* none = R"--(#include <map>  // "<td>"
/* "|---|"
*/ f("<output>/capture", "<kind>.json", "<Points>\n", "<?xml version=\"1.0\"?>", a < b || c > d);
f("|f_g - f| / f", "a || b", '"', '<', "# a comment of a script");)--";
  CHECK(markup_breaches("experiments/run/a.cpp", none).empty());
}

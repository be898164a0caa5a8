#include "experiments/page/html.hpp"

#include <algorithm>
#include <map>

#include "experiments/page/drawing.hpp"
#include "experiments/page/page_style.hpp"
#include "platform/atomic_file.hpp"

namespace ballast::page {
namespace {

/// Tables of more columns may be wider than the text.
constexpr size_t widest_in_text = 8;
/// Cells of more letters must not become towers of single words.
constexpr size_t longest_in_narrow_cell = 40;

struct Tag {
  std::string open, close;
  bool operator==(const Tag&) const = default;
};

/// Tags around a run, the outermost first.
std::vector<Tag> tags_of(const Span& span) {
  static const std::pair<Styles, Tag> tags[] = {{strong, {"<b>", "</b>"}},
                                                {note, {"<span class=\"note\">", "</span>"}},
                                                {good, {"<span class=\"met\">", "</span>"}},
                                                {bad, {"<span class=\"missed\">", "</span>"}},
                                                {code, {"<code>", "</code>"}},
                                                {symbol, {"<i>", "</i>"}},
                                                {subscript, {"<sub>", "</sub>"}},
                                                {superscript, {"<sup>", "</sup>"}}};
  std::vector<Tag> result;
  if (!span.link.empty())
    result.push_back({"<a href=\"" + escaped_html(span.link) + "\">", "</a>"});
  for (const auto& [style, tag] : tags)
    if (span.styles & style) result.push_back(tag);
  return result;
}

std::string with_line_breaks(const std::string& text) {
  std::string result;
  for (const char c : escaped_html(text))
    result += c == '\n' ? std::string("<br>") : std::string(1, c);
  return result;
}

std::string row_of(const Table& table, const std::vector<Text>& cells, const std::string& tag) {
  std::string html = "<tr>";
  for (size_t c = 0; c < cells.size(); ++c) {
    const bool is_number = c < table.is_number.size() && table.is_number[c];
    const bool is_long = !is_number && plain_words(cells[c]).size() > longest_in_narrow_cell;
    html += '<' + tag +
            (is_number ? " class=\"n\">"
             : is_long ? " class=\"long\">"
                       : ">") +
            html_of(cells[c]) + "</" + tag + '>';
  }
  return html + "</tr>\n";
}

std::string items_of(const std::vector<Text>& items) {
  std::string html = "<ul>\n";
  for (const Text& item : items) html += "<li>" + html_of(item) + "</li>\n";
  return html + "</ul>";
}

template <class Writes>
std::string gathered(const Writes& writes) {
  std::string text;
  writes([&text](std::string_view piece) { text += piece; });
  return text;
}

/// One kind of block after the other.
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
    if (picture.is_linked)
      return "<p class=\"linked\"><a href=\"" + std::string(picture_folder) + '/' +
             escaped_html(picture.plot.name) + ".svg\">" + escaped_html(picture.plot.title) +
             "</a></p>\n";
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
    return "<pre>" + escaped_html(listing.text) + "</pre>\n";
  }
  std::string operator()(const Folded& folded) const {
    return "<details><summary>" + html_of(folded.heading) + "</summary>\n<pre>" +
           escaped_html(folded.text) + "</pre></details>\n";
  }
  std::string operator()(const Replay& replay) const {
    return gathered([&](const Write& write) { write_replay(replay, write); });
  }
};

std::string header_of(const Page& page) {
  std::string html = "<header>\n<h1>" + escaped_html(page.title) + "</h1>\n";
  for (const Text& line : page.lede)
    if (!line.empty()) html += "<p class=\"lede\">" + html_of(line) + "</p>\n";
  return html + "</header>\n";
}

void write_section(const Section& section, const Write& write) {
  if (section.is_empty()) return;
  write("<section id=\"" + escaped_html(section.id) + "\">\n<h2>" + html_of(section.heading) +
        "</h2>\n");
  for (const Block& block : section.blocks) {
    // a replay has megabytes
    if (const auto* replay = std::get_if<Replay>(&block); replay && !is_empty(block))
      write_replay(*replay, write);
    else
      write(html_of(block));
  }
  write("</section>\n");
}

}  // namespace

std::string escaped_html(std::string_view text) {
  static const std::map<char, const char*> entities = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  std::string html;
  for (const char c : clean_utf8(text)) {
    const auto entity = entities.find(c);
    if (entity == entities.end())
      html += c;
    else
      html += entity->second;
  }
  return html;
}

std::string html_of(const Text& text) {
  std::string html;
  std::vector<Tag> open;
  // closes tags down to the first `kept`
  const auto close = [&](size_t kept) {
    for (; open.size() > kept; open.pop_back()) html += open.back().close;
  };
  for (const Span& span : text.spans) {
    const std::vector<Tag> tags = tags_of(span);
    const auto common = std::mismatch(open.begin(), open.end(), tags.begin(), tags.end());
    close(static_cast<size_t>(common.first - open.begin()));
    for (size_t k = open.size(); k < tags.size(); ++k) {
      html += tags[k].open;
      open.push_back(tags[k]);
    }
    html += with_line_breaks(span.text);
  }
  close(0);
  return html;
}

std::string html_of(const Block& block) {
  const bool is_subheading = std::holds_alternative<Subheading>(block);
  return is_empty(block) && !is_subheading ? std::string() : std::visit(HtmlBlocks{}, block);
}

void write_html(const Page& page, const Write& write) {
  write(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>" +
      escaped_html(page.title) + "</title>\n<style>\n" + style_sheet() +
      "</style>\n</head>\n<body>\n<main>\n" + header_of(page) + html_of(Block(page.notices)));
  for (const Section& section : page.sections) write_section(section, write);
  if (page.answers.are_given && !can_answer())
    write("<p class=\"note\">" + html_of(words("answers.missing")) + "</p>\n");
  if (!page.end.empty()) write("<footer>" + html_of(page.end) + "</footer>\n");
  write("</main>\n" + answers_html(page) + "</body>\n</html>\n");
}

void write_html_file(const std::filesystem::path& file, const Page& page) {
  AtomicFile out(file);
  write_html(page, [&out](std::string_view piece) { out.write(piece); });
  out.commit();
}

std::string html_of(const Page& page) {
  return gathered([&](const Write& write) { write_html(page, write); });
}

}  // namespace ballast::page

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "experiments/page/page.hpp"
#include "platform/text.hpp"

namespace ballast::page {
namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || (c & 0x80); }

/// Escapes the characters that would be marks, and no others: "f_max" and "[1, 2]" stay readable.
std::string escaped_markdown(const std::string& text) {
  const std::string clean = clean_utf8(text);
  std::string result;
  for (size_t k = 0; k < clean.size(); ++k) {
    const char c = clean[k], before = k ? clean[k - 1] : ' ',
               after = k + 1 < clean.size() ? clean[k + 1] : '\0';
    const bool is_mark =
        c == '\\' || c == '`' || c == '*' || c == '|' || c == '$' ||
        (c == '_' && !(is_word(before) && is_word(after))) ||
        (c == '~' && after != ' ' && before != ' ') ||
        (c == '~' && (after == '~' || before == '~')) ||
        (c == ']' && (after == '(' || after == '[' || after == ':' || after == '\0')) ||
        (k == 0 && (c == '#' || c == '-' || c == '+') && after == ' ');
    if (is_mark)
      result += std::string("\\") + c;
    else if (c == '&')
      result += "&amp;";
    else if (c == '<' && (is_word(after) || after == '/' || after == '!' || after == '?'))
      result += "&lt;";  // any other "<" opens no tag
    else if (c == '>' && k == 0)
      result += "&gt;";
    else if (c == '\n')
      result += "<br>";
    else
      result += c;
  }
  return result;
}

/// Puts marks around words. Spaces at the ends stay outside, where Markdown needs them.
std::string wrapped(const std::string& words, const char* open, const char* close) {
  const size_t first = words.find_first_not_of(' '), last = words.find_last_not_of(' ');
  if (first == std::string::npos) return words;
  return words.substr(0, first) + open + words.substr(first, last - first + 1) + close +
         words.substr(last + 1);
}

std::string span_text(const Span& span) {
  std::string words;
  if (span.styles & code) {
    std::string clean = clean_utf8(span.text);
    std::replace(clean.begin(), clean.end(), '\n', ' ');
    // in a table a bar ends the cell, even in code
    replace_all(clean, "|", "\\|");
    std::ranges::replace(clean, '`', '\'');
    words = '`' + clean + '`';
  } else {
    words = escaped_markdown(span.text);
  }
  if (span.styles & symbol) words = wrapped(words, "*", "*");
  if (span.styles & subscript) words = wrapped(words, "<sub>", "</sub>");
  if (span.styles & superscript) words = wrapped(words, "<sup>", "</sup>");
  if (!span.link.empty()) words = '[' + words + "](<" + span.link + ">)";
  return words;
}

std::string line_of(const std::vector<Text>& cells) {
  std::string line = "|";
  for (const Text& cell : cells) line += ' ' + markdown_of(cell) + " |";
  return line + '\n';
}

struct MarkdownBlocks {
  std::string operator()(const Text& text) const { return markdown_of(text) + "\n\n"; }
  std::string operator()(const List& list) const {
    std::string text;
    for (const Text& item : list.items) text += "- " + markdown_of(item) + '\n';
    return text + '\n';
  }
  std::string operator()(const Table& table) const {
    std::string text = table.caption.empty() ? "" : (*this)(table.caption);
    // Markdown has no table without a head
    const size_t columns = table.head.empty() ? table.rows.front().size() : table.head.size();
    text += line_of(table.head.empty() ? std::vector<Text>(columns) : table.head) + '|';
    for (size_t c = 0; c < columns; ++c)
      text += c < table.is_number.size() && table.is_number[c] ? "---:|" : "---|";
    text += '\n';
    for (const auto& cells : table.rows) text += line_of(cells);
    return text + '\n';
  }
  std::string operator()(const Picture& picture) const {
    const std::string path = std::string(picture_folder) + '/' + picture.plot.name + ".svg";
    std::string text = "![" + escaped_markdown(picture.plot.title) + "](" + path + ")\n\n";
    if (!picture.files.empty()) text += (*this)(picture.files);
    for (const Text& line : picture.caption) text += (*this)(line);
    return text;
  }
  std::string operator()(const Notices& notices) const {
    std::string text = notices.heading.empty() ? "" : (*this)(styled(notices.heading, strong));
    for (const Text& item : notices.items) text += (*this)(styled(item, strong));
    return text;
  }
  template <class Other>
  std::string operator()(const Other&) const {
    throw std::logic_error("no page in Markdown has a block of this kind");
  }
};

}  // namespace

std::string markdown_of(const Text& text) {
  std::string result;
  for (size_t k = 0; k < text.spans.size();) {
    // neighbouring strong runs share one pair of marks
    const bool is_strong = text.spans[k].styles & strong;
    std::string words;
    for (; k < text.spans.size() && bool(text.spans[k].styles & strong) == is_strong; ++k)
      words += span_text(text.spans[k]);
    result += is_strong ? wrapped(words, "**", "**") : words;
  }
  return result;
}

std::string markdown_of(const Block& block) {
  return is_empty(block) ? std::string() : std::visit(MarkdownBlocks{}, block);
}

std::string markdown_of(const Page& page) {
  std::string text = "# " + escaped_markdown(page.title) + "\n\n";
  for (const Text& line : page.lede)
    if (!line.empty()) text += markdown_of(line) + "\n\n";
  text += markdown_of(Block(page.notices));
  for (const Section& section : page.sections) {
    if (section.is_empty()) continue;
    text += "## " + markdown_of(section.heading) + "\n\n";
    for (const Block& block : section.blocks) text += markdown_of(block);
  }
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

}  // namespace ballast::page

#include "experiments/page/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

#include "platform/text.hpp"

namespace ballast {

std::string page_texts();  // experiments/<room>/texts

}  // namespace ballast

namespace ballast::page {
namespace {

/// Marks that open and close alike. "**" stands before "*": the longer one is tried first.
constexpr std::pair<std::string_view, Styles> marks[] = {
    {"**", strong}, {"*", symbol}, {"~", subscript}, {"^", superscript}, {"`", code}};

/// The parser of one notation.
struct Notation {
  std::string_view whole;
  const Values& values;
  Text text = {};  ///< that was read so far

  [[noreturn]] void fail(const std::string& what) const {
    throw std::logic_error("page text \"" + std::string(whole) + "\": " + what);
  }

  void read_part(std::string_view part, Styles styles, const std::string& link) {
    const Styles around = styles;
    for (size_t at = 0; at < part.size();) {
      const std::string_view rest = part.substr(at);
      size_t taken = read_mark(rest, styles);
      if (taken == 0) taken = read_bracket(rest, styles, link);
      if (taken == 0) {
        taken = rest[0] == '\\' && rest.size() > 1 && !(styles & code) ? 2 : 1;
        text += Text(std::string(1, rest[taken - 1]), styles, link);
      }
      at += taken;
    }
    if (styles != around) fail("a mark isn't closed");
  }

  /// Applies a mark at the start of `rest`, which switches a style. Returns its length; 0: no mark.
  size_t read_mark(std::string_view rest, Styles& styles) const {
    // in code every character but the closing mark is literal
    if (styles & code && rest[0] != '`') return 0;
    if (rest.starts_with("((") || rest.starts_with("))")) {
      const bool opens = rest[0] == '(';
      if (opens == ((styles & note) != 0)) fail("a note in a note, or none to end");
      styles ^= note;
      return 2;
    }
    for (const auto& [mark, style] : marks)
      if (rest.starts_with(mark)) {
        styles ^= style;
        return mark.size();
      }
    return 0;
  }

  /// Adds a link or a value at the start of `rest`. Returns its length; 0 when there is none.
  size_t read_bracket(std::string_view rest, Styles styles, const std::string& link) {
    if (styles & code) return 0;
    if (rest[0] == '{') {
      const size_t end = rest.find('}');
      if (end == rest.npos) fail("a value's name isn't closed");
      const std::string name(rest.substr(1, end - 1));
      const auto value = values.find(name);
      if (value == values.end()) fail("the value {" + name + "} is missing");
      text += styled(value->second, styles);
      return end + 1;
    }
    const size_t middle = rest.find("](");
    if (rest[0] != '[' || !link.empty() || middle == rest.npos) return 0;
    const size_t end = rest.find(')', middle);
    if (end == rest.npos) fail("a link's address isn't closed");
    read_part(rest.substr(1, middle - 1), styles,
              std::string(rest.substr(middle + 2, end - middle - 2)));
    return end + 1;
  }
};

/// "−4" as "⁻⁴"; empty when a character has no raised form.
std::string raised(std::string text) {
  constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  replace_all(text, "−", "-");
  if (text.find_first_not_of("-0123456789") != std::string::npos) return {};
  std::string result;
  for (const char c : text) result += c == '-' ? "⁻" : digits[c - '0'];
  return result;
}

constexpr const char* narrow_space = "\u202f";

std::string without_trailing_zeros(std::string digits) {
  if (digits.find('.') == std::string::npos) return digits;
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return digits;
}

std::string with_minus_sign(std::string digits) {
  if (digits[0] == '-') digits.replace(0, 1, "−");
  return digits;
}

Text number_text(double value, int digits, bool is_exact) {
  if (!std::isfinite(value)) return {"–", note};
  if (value == 0.0) return "0";
  // the rounded value decides, so that 999999.9 isn't printed as 1.00e+06
  std::string text = printed("%.*e", digits - 1, value);
  const size_t mark = text.find('e');
  const int exponent = std::atoi(text.c_str() + mark + 1);
  const bool has_power = exponent < -3 || exponent >= 6;
  text =
      has_power ? text.substr(0, mark) : printed("%.*f", std::max(0, digits - 1 - exponent), value);
  if (is_exact) text = without_trailing_zeros(text);
  Text result = with_minus_sign(text);
  if (has_power) {
    result += "×10";
    result += {with_minus_sign(std::to_string(exponent)), superscript};
  }
  return result;
}

Text with_unit(double value, Text digits, const char* unit) {
  if (!std::isfinite(value) || !*unit) return digits;
  return std::move(digits) + narrow_space + marked(unit);
}

}  // namespace

Text::Text(std::string words, Styles styles, std::string link) {
  if (!words.empty()) spans.push_back({std::move(words), styles, std::move(link)});
}

Text& Text::operator+=(const Text& other) {
  for (const Span& span : other.spans) {
    // neighbouring runs of equal style and link become one run
    if (!spans.empty() && spans.back().styles == span.styles && spans.back().link == span.link)
      spans.back().text += span.text;
    else
      spans.push_back(span);
  }
  return *this;
}

Text styled(Text text, Styles styles) {
  for (Span& span : text.spans) span.styles |= styles;
  return text;
}

std::vector<Text> parts_of(const Text& text, std::string_view mark) {
  std::vector<Text> parts(1);
  for (const Span& span : text.spans) {
    std::string_view rest = span.text;
    for (size_t at; (at = rest.find(mark)) != rest.npos; parts.emplace_back()) {
      const size_t end = at == 0 ? at : rest.find_last_not_of(' ', at - 1) + 1;
      parts.back() += {std::string(rest.substr(0, end)), span.styles, span.link};
      rest.remove_prefix(at + mark.size());
      rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
    }
    parts.back() += {std::string(rest), span.styles, span.link};
  }
  return parts;
}

Text marked(std::string_view notation, const Values& values) {
  Notation reader{notation, values};
  reader.read_part(notation, 0, "");
  return std::move(reader.text);
}

std::string filled(std::string_view document,
                   const std::function<std::string(const std::string& words)>& value) {
  std::string result;
  while (true) {
    const size_t open = document.find("{{"), close = document.find("}}", open);
    result.append(document.substr(0, open));
    if (open == std::string_view::npos) return result;
    if (close == std::string_view::npos) throw std::logic_error("{{ without }}");
    result += value(std::string(document.substr(open + 2, close - open - 2)));
    document.remove_prefix(close + 2);
  }
}

std::string plain_words(const Text& text) {
  std::string words;
  for (const Span& span : text.spans) {
    const std::string high = span.styles & superscript ? raised(span.text) : std::string();
    const char* mark = span.styles & subscript ? "_" : span.styles & superscript ? "^" : "";
    words += high.empty() ? mark + span.text : high;
  }
  std::replace(words.begin(), words.end(), '\n', ' ');
  return words;
}

std::string clean_utf8(std::string_view text) {
  using Json = nlohmann::json;
  // JSON's writer replaces invalid UTF-8
  const std::string json = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string result;
  for (const char c : Json::parse(json).get<std::string>()) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_control = (byte < 0x20 && c != '\n' && c != '\t' && c != '\r') || byte == 0x7f;
    result += is_control ? std::string("\xef\xbf\xbd") : std::string(1, c);
  }
  return result;
}

Text number(double value, int digits) { return number_text(value, digits, false); }

Text exact(double value, int digits) { return number_text(value, digits, true); }

Text quantity(double value, const char* unit, int digits) {
  return with_unit(value, number(value, digits), unit);
}

Text exact_quantity(double value, const char* unit) { return with_unit(value, exact(value), unit); }

Text with_error(double value, double error) {
  if (!std::isfinite(value) || !std::isfinite(error) || error == 0.0) return number(value);
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(error))));
  if (exponent < -6 || exponent > 5) return number(value) + " ± " + number(error, 2);
  // as many places as give the error two digits
  const int places = std::max(0, 1 - exponent);
  return with_minus_sign(printed("%.*f", places, value)) + " ± " + printed("%.*f", places, error);
}

Text percent(double relative) {
  if (!std::isfinite(relative)) return number(relative);
  return (relative >= 0.0 ? "+" : "−") + number(100.0 * std::abs(relative), 2) + " %";
}

Text interval(double low, double high) { return "[" + number(low) + ", " + number(high) + "]"; }

Text verdict(double value, double bound) {
  if (std::isnan(value) || std::isnan(bound)) return {};
  return value <= bound ? Text("✓ met", good) : Text("✗ missed", bad);
}

std::map<std::string, std::string> entries_of(const std::string& texts) {
  std::map<std::string, std::string> entries;
  std::istringstream lines(texts);
  std::string* entry = nullptr;
  bool is_after_gap = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("# ")) {
      const auto [place, is_new] = entries.try_emplace(line.substr(2));
      if (!is_new) throw std::logic_error("page texts: \"" + place->first + "\" stands twice");
      entry = &place->second;
    } else if (line.empty()) {
      is_after_gap = true;
    } else if (!entry) {
      throw std::logic_error("page texts: no headline before \"" + line + "\"");
    } else {
      if (!entry->empty()) *entry += is_after_gap ? '\n' : ' ';
      *entry += line;
      is_after_gap = false;
    }
  }
  return entries;
}

Text words(const std::string& name, const Values& values) {
  static const std::map<std::string, std::string> entries = entries_of(page_texts());
  const auto entry = entries.find(name);
  if (entry == entries.end()) throw std::logic_error("page texts: there is no \"" + name + "\"");
  return marked(entry->second, values);
}

}  // namespace ballast::page

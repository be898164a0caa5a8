#pragma once
// The words of a page: runs of text, each with the styles that every writer knows (HTML, Markdown,
// plain text, labels of plots).
//
//   Text words = marked("Force *f*~g~ above 10^−3^ N. ((Grey: each step.))") + name_from_a_file;
//
// A string becomes Text as it is: none of its characters is special, so that text from files and
// users cannot become markup. Only marked() reads the notation; it gets literals of this program
// and its text files (words), never text from outside.

#include <concepts>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace ballast::page {

/// Styles of a run, one bit each.
using Styles = unsigned;
inline constexpr Styles strong = 1, symbol = 2, subscript = 4, superscript = 8, code = 16;
inline constexpr Styles note = 32;             ///< soft: asides and hints where to look
inline constexpr Styles good = 64, bad = 128;  ///< a bound that is met or missed

struct Span {
  std::string text;  ///< UTF-8; "\n" is a line break
  Styles styles = 0;
  std::string link;  ///< address; empty: none
  bool operator==(const Span&) const = default;
};

struct Text {
  std::vector<Span> spans;

  Text() = default;
  Text(std::string words, Styles styles = 0, std::string link = {});
  Text(const char* words) : Text(std::string(words)) {}

  bool empty() const { return spans.empty(); }
  Text& operator+=(const Text& other);
  friend Text operator+(Text a, const Text& b) { return a += b; }
  bool operator==(const Text&) const = default;
};

/// The same words with `styles` added to every run.
Text styled(Text text, Styles styles);

/// Splits a text at every `mark`; each mark must lie within one run. Blanks around a mark belong to
/// no part.
std::vector<Text> parts_of(const Text& text, std::string_view mark);

/// The texts that replace each {name} in a notation.
using Values = std::map<std::string, Text>;

/// Reads the notation: **strong**, *symbol*, ~subscript~, ^superscript^, `code`, ((note)),
/// [words](address), {name of a value}; a backslash takes the next character as it is.
/// Throws std::logic_error on a mark that isn't closed or a value that is missing: these are faults
/// of the program.
Text marked(std::string_view notation, const Values& values = {});

/// A document in which each {{words}} is replaced by what `value` makes of the words. Throws
/// std::logic_error: "{{ without }}".
std::string filled(std::string_view document,
                   const std::function<std::string(const std::string& words)>& value);

/// Words alone for titles, file names, tests. Powers stay raised (10⁻⁴) where Unicode has them so.
std::string plain_words(const Text& text);

/// The text with U+FFFD in place of invalid UTF-8 and of every control character except line breaks
/// and tabs.
std::string clean_utf8(std::string_view text);

/// Every page writes numbers in this way.
///
/// `digits` significant digits; powers of ten below 1e-3 and from 1e6 on; a dash for NaN and
/// infinities.
Text number(double value, int digits = 3);

/// number() without trailing zeros, for settings and counts, which are exact.
Text exact(double value, int digits = 7);
Text exact(std::integral auto count) { return exact(static_cast<double>(count)); }

/// number or exact, narrow space, unit; the dash alone when the value isn't known. `unit` is in
/// the notation of marked(); empty: none.
Text quantity(double value, const char* unit, int digits = 3);
Text exact_quantity(double value, const char* unit);

/// "1.230 ± 0.040": the error to two digits of its own; no error when it is 0 or not known.
Text with_error(double value, double error);

/// A relative deviation with its sign: "+3.1 %", "−12 %".
Text percent(double relative);

/// "[1.1, 1.4]"
Text interval(double low, double high);

/// Value against its bound: "met" or "missed" with a sign that doesn't need colour; nothing when
/// either is NaN.
Text verdict(double value, double bound);

/// An entry of the text files experiments/<room>/texts/*.md, which are built into the program
/// (ballast_file of CMake). They have one entry under each headline, in the notation of marked():
///
///   # fig3.found
///   Displacement *x* of the wall. Here it first goes in by {size}.
///
///   page::words("fig3.found", {{"size", page::quantity(1e3 * size, "mm")}})
///
/// A name occurs once in all rooms. The texts of one figure may share `values`: unused ones are
/// ignored. Throws std::logic_error when there is no entry of that name, and as marked() does.
Text words(const std::string& name, const Values& values = {});

/// The entries of such texts by name. The lines of an entry are joined by spaces; an empty line in
/// it is a line break. Throws std::logic_error when a name occurs twice, or words stand before the
/// first headline.
std::map<std::string, std::string> entries_of(const std::string& texts);

}  // namespace ballast::page

#pragma once
// The words of a page: runs of text, each with the styles that every writer knows (HTML, Markdown,
// plain text, labels of plots).
//
//   Text words = marked("Force *f*~g~ above 10^−3^ N. ((Grey: each step.))") + name_from_a_file;
//
// A string becomes Text as it is: no character of it means anything, so that what comes from files
// and users cannot become markup. Only marked() reads the notation; it is given literals of this
// program and its text files (words), never anything from outside.

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
inline constexpr Styles note = 32;             ///< soft: an aside, where to look
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

/// The parts between the marks, which no run of the text may share with the next; blanks around a
/// mark are no part's.
std::vector<Text> parts_of(const Text& text, std::string_view mark);

/// What stands for {name} in a notation.
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

/// Words alone: titles, file names, tests. Powers keep their height (10⁻⁴) where Unicode has it.
std::string plain_words(const Text& text);

/// The text with what is no UTF-8 and every control character except line breaks and tabs replaced
/// by U+FFFD.
std::string clean_utf8(std::string_view text);

/// How a page writes numbers: one way for every page.
///
/// `digits` significant digits; powers of ten below 1e-3 and from 1e6 on; a dash for NaN and
/// infinities.
Text number(double value, int digits = 3);

/// The same without trailing zeros: settings and counts, which are exact.
Text exact(double value, int digits = 7);
Text exact(std::integral auto count) { return exact(static_cast<double>(count)); }

/// number or exact, narrow space, unit; the dash alone when the value isn't known. `unit` is in
/// the notation of marked(); empty: none.
Text quantity(double value, const char* unit, int digits = 3);
Text exact_quantity(double value, const char* unit);

/// "1.23 ± 0.04": the error to two digits of its own; no error when it isn't known.
Text with_error(double value, double error);

/// A relative deviation with its sign: "+3.1 %", "−12 %".
Text percent(double relative);

/// "[1.1, 1.4]"
Text interval(double low, double high);

/// Value against its bound: "met" or "missed" with a sign that doesn't need colour; nothing when
/// either is NaN.
Text verdict(double value, double bound);

/// Prose in text files: experiments/<room>/texts/*.md are built into the program (ballast_file of
/// CMake), one entry under each headline, in the notation of text.hpp:
///
///   # fig3.found
///   Displacement *x* of the wall. Here it first goes in by {size}.
///
///   page::words("fig3.found", {{"size", page::quantity(1e3 * size, "mm")}})
///
/// An entry's name stands once in all rooms. Texts of one figure may share their values. Throws
/// std::logic_error when there is no entry of that name, and as marked() does.
Text words(const std::string& name, const Values& values = {});

/// The entries of such texts by their names. An entry's lines are joined by spaces, an empty line
/// in it is a line break. Throws std::logic_error when a name occurs twice, or words stand before a
/// headline.
std::map<std::string, std::string> entries_of(const std::string& texts);

}  // namespace ballast::page

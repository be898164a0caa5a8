#pragma once
// The older way to a page, as HTML by hand: kept until its last user is written in page.hpp's
// model.

#include <string>
#include <string_view>
#include <vector>

#include "experiments/page/plot.hpp"

namespace ballast {

/// Text that is HTML already. It is made from literals of this program or by escaped(): what comes
/// from files and users cannot get into a page unescaped without saying Html{...}.
struct Html {
  std::string markup;
  Html& operator+=(const Html& other) {
    markup += other.markup;
    return *this;
  }
};
inline Html operator+(Html a, const Html& b) { return a += b; }

/// & < > " ' become entities; control characters that HTML forbids and bytes that are no UTF-8
/// become U+FFFD.
Html escaped(std::string_view text);

/// `digits` significant digits; powers of ten below 1e-3 and from 1e6 on; a dash for NaN and
/// infinities.
Html number(double value, int digits = 3);
/// The same without trailing zeros: settings and counts, which are exact.
Html exact(double value, int digits = 7);
/// number, narrow space, unit (HTML).
Html quantity(double value, const char* unit, int digits = 3);
/// Value against its bound: "met" or "missed" with a sign that doesn't need colour; nothing when
/// either is NaN.
Html verdict(double value, double bound);

struct HtmlTable {
  std::vector<Html> head;  ///< empty: no head
  std::vector<std::vector<Html>> rows;
  std::vector<bool> is_number;  ///< columns that are set right-aligned; empty: none
  std::string css_class;
};
Html to_html(const HtmlTable& table);

/// A figure's SVG for inlining: without XML declaration, doctype and comments, with ids of its own,
/// colours in the form that the page's style maps to its light and dark palette, and `title` for
/// screen readers.
Html inline_svg(std::string_view svg, const std::string& name, const std::string& title);

Html html_figure(const std::string& name, const Html& picture, const Html& caption);
Html html_section(const std::string& id, const Html& heading, const Html& body);

/// A figure and what is said about it.
struct ReportFigure {
  Figure plot;
  Html caption;
};

/// The whole page.
std::string html_page(const std::string& title, const Html& body);

}  // namespace ballast

#pragma once
// What a part of the report is made of. Its words stand in texts/*.md under its name.

#include <string>
#include <vector>

#include "experiments/page/page.hpp"
#include "experiments/paper/agreement.hpp"

namespace ballast {

/// One row of the table paper | Ballast | agreement.
struct AgreementRow {
  page::Text place;    ///< "Fig. 9"
  page::Text paper;    ///< what the paper says
  page::Text ballast;  ///< what was measured, with its interval
  PaperRange range;    ///< what the paper's words are taken as
  Found found;         ///< what the verdict was made from
  Agreement agreement = Agreement::reported;
};

/// A result beyond the paper: nothing to agree with.
struct BeyondRow {
  page::Text what, found;
};

struct PaperSection {
  std::string id = {};  ///< "fig9"
  page::Text heading = {};
  std::vector<page::Text> notes = {};  ///< what is missing, loudly
  std::vector<page::Text> text = {};   ///< paragraphs
  std::vector<page::Picture> figures = {};
  std::vector<page::Table> tables = {};
  std::vector<AgreementRow> rows = {};
  std::vector<BeyondRow> findings = {};

  /// A figure with its captions: words(name.paper) and words(name.found). Unless `plot` has them,
  /// its title is words(name.title), and its files are called `name`, with two digits for "fig9".
  void draw(const std::string& name, Figure plot, const page::Values& values = {});
  /// A row of the table of agreement, judged by the one rule of agreement.hpp. words(name) is
  /// "place
  /// || what the paper says || what was measured".
  void claim(const std::string& name, const page::Values& values, const PaperRange& range,
             const Found& found);
  /// A row of the table of what is beyond the paper. words(name) is "what || what was measured".
  void report(const std::string& name, const page::Values& values);
};

/// Points of a figure with their standard errors.
struct VariedCurve {
  std::vector<double> x, y, error;
  int errors_from = 0;  ///< degrees of freedom of all errors together: samples less points
  std::vector<std::string> origins = {};  ///< of the points: VariedValue::origin
};

/// A panel over the paper's frequencies, 1 to 60 Hz: the same axis in every figure.
Panel frequency_panel(const std::string& y_label);

/// Points with bars.
Curve points_of(VariedCurve points, const std::string& title, Ink ink);

/// A function drawn between two x, evenly in log x where `is_log`.
struct Drawn {
  double low, high;
  bool is_log;
};
template <class Function>
Curve curve_of(const Function& function, const Drawn& range, const std::string& title, Ink ink,
               bool dashed = true);

/// The figure's data: panel, curve, x, y, y_error, y_low as CSV.
std::string figure_csv(const Figure& figure);

}  // namespace ballast

#include <cmath>

namespace ballast {

template <class Function>
Curve curve_of(const Function& function, const Drawn& range, const std::string& title, Ink ink,
               bool dashed) {
  Curve curve{.title = title, .ink = ink, .dashed = dashed};
  constexpr int parts = 200;
  for (int k = 0; k <= parts; ++k) {
    const double s = static_cast<double>(k) / parts;
    curve.x.push_back(range.is_log ? range.low * std::pow(range.high / range.low, s)
                                   : range.low + s * (range.high - range.low));
    curve.y.push_back(function(curve.x.back()));
  }
  return curve;
}

}  // namespace ballast

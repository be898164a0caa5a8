#pragma once
// What a part of the report is made of. Its words stand in texts/*.md under its name.

#include <cmath>
#include <string>
#include <vector>

#include "experiments/page/page.hpp"
#include "experiments/paper/agreement.hpp"
#include "experiments/paper/paper_data.hpp"

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

  /// A figure with its captions: words(name.paper) and words(name.found). Unless `plot` has one,
  /// its title is words(name.title); its files are called `name`, with two digits for "fig9".
  void draw(const std::string& name, Figure plot, const page::Values& values = {});
  /// A row of the table of agreement, judged by the one rule of agreement.hpp. words(name) is
  /// "place
  /// || what the paper says || what was measured".
  void claim(const std::string& name, const page::Values& values, const PaperRange& range,
             const Found& found);
  /// A row of the table of what is beyond the paper. words(name) is "what || what was measured".
  void report(const std::string& name, const page::Values& values);
  /// A table, unless it has no rows.
  void add(page::Table table);
};

/// "1.23 ± 0.04"
page::Text words_of(const SampleMean& mean, double factor = 1.0);
/// "3": samples that are finished.
page::Text samples_of(const Group& group);
/// Text of a fitted exponent: "−1.93 [−2.05, −1.81] (R² 0.995)".
page::Text words_of(const PowerFit& fit);
/// "0.03 [0.02, 0.04]": with its 95 % interval.
page::Text words_of(const Proportion& fit, int digits = 3);
/// "χ²/dof 3.2, p 0.004"; what a reader has to know about it: words("misfit").
page::Text words_of(const Misfit& misfit);
/// "0.004", "< 1e-4"
page::Text words_of_p(double p);
/// "−1.00 [−1.2, −0.8]": the 95 % interval by Student's t; without one where there is one sample.
page::Text words_with_interval(const SampleMean& mean);
/// Of a difference of logarithms: "+3.1 % [0.2, 6.1]"; one sample has no interval.
page::Text words_of_change(const SampleMean& change);

/// A panel over the paper's frequencies, 1 to 60 Hz: the same axis in every figure.
Panel frequency_panel(const std::string& y_label);

/// What the legend says of points that are means over seeds.
inline constexpr const char* mean_title = "mean over samples ± standard error";
/// Points with bars.
Curve curve_of(const Points& points, const std::string& title, Ink ink,
               MarkShape shape = MarkShape::circle);

/// A function drawn between two x, evenly in log x where `is_log`.
struct Drawn {
  double low, high;
  bool is_log;
};
template <class Function>
Curve curve_of(const Function& function, const Drawn& range, const std::string& title, Ink ink,
               bool dashed = true) {
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

/// The figure's data: panel, curve, x, y, y_error, y_low as CSV.
std::string figure_csv(const Figure& figure);

}  // namespace ballast

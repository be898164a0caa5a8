#pragma once
// What a part of the report is made of.

#include <string>
#include <vector>

#include "experiments/page/page.hpp"

namespace ballast {

enum class Agreement { agrees, partly, differs, reported };
const char* word_of(Agreement agreement);

/// One row of the table paper | Ballast | agreement.
struct AgreementRow {
  std::string place;   ///< "Fig. 9"
  std::string paper;   ///< what the paper says
  page::Text ballast;  ///< what was measured, with its interval
  Agreement agreement = Agreement::reported;
};

struct PaperFigure {
  Figure plot;
  page::Text paper;  ///< what the paper says about it
  page::Text found;  ///< what is drawn, and what was found
};

struct PaperSection {
  std::string id;  ///< "fig9"
  std::string heading;
  std::vector<page::Text> notes;  ///< what is missing, loudly
  std::vector<page::Text> text;   ///< paragraphs
  std::vector<PaperFigure> figures;
  std::vector<page::Table> tables;
  std::vector<AgreementRow> rows;
};

/// A panel over the paper's frequencies, 1 to 60 Hz: the same axis in every figure.
Panel frequency_panel(const std::string& y_label);

/// Points with bars.
Curve points_of(std::vector<double> x, std::vector<double> y, std::vector<double> error,
                const std::string& title, Ink ink);
/// A function drawn between two x, evenly in log x where `is_log`.
template <class Function>
Curve curve_of(const Function& function, double low, double high, bool is_log,
               const std::string& title, Ink ink, bool dashed = true);

/// The figure's data: panel, curve, x, y, y_error, y_low as CSV.
std::string figure_csv(const Figure& figure);

}  // namespace ballast

#include <cmath>

namespace ballast {

template <class Function>
Curve curve_of(const Function& function, double low, double high, bool is_log,
               const std::string& title, Ink ink, bool dashed) {
  Curve curve;
  curve.title = title;
  curve.ink = ink;
  curve.dashed = dashed;
  constexpr int parts = 200;
  for (int k = 0; k <= parts; ++k) {
    const double s = static_cast<double>(k) / parts;
    curve.x.push_back(is_log ? low * std::pow(high / low, s) : low + s * (high - low));
    curve.y.push_back(function(curve.x.back()));
  }
  return curve;
}

}  // namespace ballast

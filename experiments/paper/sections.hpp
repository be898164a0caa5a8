#pragma once
// The report's sections: what is run (campaign.hpp), what is measured (observables.hpp,
// grain_fields.hpp), fitted and drawn.

#include <span>
#include <string>
#include <vector>

#include "experiments/paper/paper_data.hpp"
#include "experiments/paper/section.hpp"

namespace ballast {

/// One section of the report: the target of `ballast paper` that makes it, and which of the
/// campaign's runs it draws. Its heading is words(name.heading).
struct ReportSection {
  const char* name;                                           ///< "fig9"
  PaperSection (*make)(PaperData&);                           ///< without name and heading
  bool needs_motion;                                          ///< the 5 Hz runs with stored states
  std::vector<Varied> needs;                                  ///< points of these
  bool (*needs_point)(const CampaignPoint& point) = nullptr;  ///< of them only where true
};
/// The first result, then in the paper's order. A new figure is its file, its words in texts/, and
/// in sections.cpp its declaration and its row.
std::span<const ReportSection> paper_sections();

/// Names that `ballast paper` takes: those of the sections, and "all".
std::vector<std::string> paper_targets();
/// Indices of the runs a target needs, in the campaign's order. Throws std::invalid_argument naming
/// the target and what there is.
std::vector<size_t> runs_for(const Campaign& campaign, const std::string& target);
/// What a target needs as plans, one for each stage: to be run in this order. Runs of which a row
/// alone is known are left out. Throws as runs_for.
std::vector<Plan> stages_of(const PaperData& data, const std::string& target);
/// The sections of a target. Throws std::invalid_argument when there is none.
std::vector<PaperSection> make_sections(PaperData& data, const std::string& target);

/// The finished values of what is varied. Says in the section what the campaign has planned of them
/// and not finished: "PARTIAL: 3 of 10 frequencies, 6 of 30 runs."
std::vector<VariedValue> read_values(PaperData& data, Varied varied, PaperSection& section);

/// The values of what is varied as the axes of a figure: y the mean of `quantity` with its standard
/// error.
VariedCurve curve_of_values(const std::vector<VariedValue>& values, double Observation::*quantity,
                            double factor = 1.0);

/// C of Eq. 3, sample by sample.
SampleMean prefactor_of(const VariedValue& value);

/// "1.23 ± 0.04"
page::Text words_of(const SampleMean& mean, double factor = 1.0);
/// "3": samples that are finished.
page::Text samples_of(const VariedValue& value);
/// Text of a fitted exponent: "−1.93 [−2.05, −1.81] (R² 0.995)".
page::Text words_of(const PowerFit& fit);
/// How far a law misses a curve's points, in their errors.
struct Misfit {
  double reduced = not_known;  ///< chi^2 over its degrees of freedom
  double p = not_known;        ///< of so large a misfit where the law holds
};
Misfit misfit_of(const PowerFit& fit, const VariedCurve& curve);
/// "χ²/dof 3.2, p 0.004"; what a reader has to know about it: words("misfit").
page::Text words_of(const Misfit& misfit);
/// "0.004", "< 1e-4"
page::Text words_of_p(double p);

/// What the legend says of points that are means over seeds.
inline constexpr const char* mean_title = "mean over samples ± standard error";
/// Measured points, the fitted power law, and the paper's exponent through the fit at x = `middle`.
std::vector<Curve> power_law_curves(const VariedCurve& points, const PowerFit& fit, double expected,
                                    double middle);

}  // namespace ballast

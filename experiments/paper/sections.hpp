#pragma once
// The report's sections, one file each: what is run (campaign.hpp), what is measured
// (observables.hpp, grain_fields.hpp), fitted and drawn.

#include "experiments/paper/paper_data.hpp"
#include "experiments/paper/section.hpp"

namespace ballast {

PaperSection fig3_section(PaperData& data);   ///< x(t) and f(t), first contraction (Eq. 1)
PaperSection fig4_section(PaperData& data);   ///< f_g(x), its branches, the jam
PaperSection fig5_section(PaperData& data);   ///< the phenomenological model (Eq. 2)
PaperSection fig6_section(PaperData& data);   ///< grain velocities, vorticity
PaperSection fig7_section(PaperData& data);   ///< force chains, principal stress directions
PaperSection fig8_section(PaperData& data);   ///< phase portraits
PaperSection fig9_section(PaperData& data);   ///< Delta x_max and v_max against nu
PaperSection fig10_section(PaperData& data);  ///< Delta x_max against f_max
PaperSection fig11_section(PaperData& data);  ///< Eq. 3
PaperSection fig12_section(PaperData& data);  ///< solid fraction against time
PaperSection fig13_section(PaperData& data);  ///< compaction rate (Eqs. 4 and 5)
PaperSection packing_section(PaperData& data);
PaperSection looseness_section(PaperData& data);
PaperSection sensitivity_section(PaperData& data);
PaperSection investigation_section(PaperData& data);  ///< why exponents, C and compaction differ

/// The sections of a target ("all": every one), in the paper's order.
std::vector<PaperSection> make_sections(PaperData& data, const std::string& target);

/// A sweep's values as the axes of a figure: x by `abscissa` of each sample's mean, y the mean of
/// `quantity` with its standard error.
struct SweepCurve {
  std::vector<double> x, y, error;
};
SweepCurve curve_of_sweep(const std::vector<SweepValue>& values, double Observation::*quantity,
                          double factor = 1.0);

/// C of Eq. 3, sample by sample.
SampleMean prefactor_of(const SweepValue& value);

/// Text of a fitted exponent: "−1.93 [−2.05, −1.81] (R² 0.995)".
std::string words_of(const PowerFit& fit);
/// "χ²/dof 3.2" of a curve's points about the fit, with their errors; "χ²/dof –" when these are not
/// known.
std::string misfit_words(const PowerFit& fit, const SweepCurve& curve);
/// What a reader has to know about it.
inline constexpr const char* misfit_meaning =
    "χ²/dof compares the points’ distances from the fitted law with the standard errors between "
    "samples (pooled): "
    "about 1 "
    "if the law holds within the scatter; above about 3 it does not, and the interval then says "
    "how well a line can be "
    "drawn, not that the points lie on one.";
/// agrees: the interval holds `expected`, or the exponent is within `tolerance` of it; partly:
/// within three times that.
Agreement judge_exponent(const PowerFit& fit, double expected, double tolerance = 0.1);

}  // namespace ballast

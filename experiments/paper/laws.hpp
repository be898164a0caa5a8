#pragma once
// Tests whether all varied runs fall on one curve. Eq. 3 says that Delta x_max depends on nu,
// f_max, g and m_w through its right side X alone, and linearly. The grouping (through X alone) is
// tested apart from the linearity: ln Delta x_max is fitted by a polynomial of ln X.

#include "experiments/paper/sections.hpp"

namespace ballast {

struct CurvePoint {
  size_t series = 0;  ///< its place in the list of groups
  Group group;
  double x = not_known;  ///< X [m]

  double log_rise() const { return group.log_mean("rise"); }
};

/// ln Delta x_max as a polynomial of u = ln(X/X0). X0 is the geometric mean of the points' X.
struct LogPolynomial {
  WeightedFit fit;
  double middle = 1.0;  ///< X0 [m]

  Eigen::VectorXd row(double x) const;                            ///< 1, u, u^2 ...
  Eigen::VectorXd slope_row(double x) const;                      ///< its derivative
  double at(double x) const { return std::exp(fit.at(row(x))); }  ///< Delta x_max [m]
};

struct MasterCurve {
  std::vector<CurvePoint> points;  ///< distinct runs; the base of all series counts once
  double least = not_known, most = not_known;  ///< X of the points [m]
  PooledError between;  ///< scatter of a sample's ln Delta x_max about its point's mean
  PooledError paired;   ///< the same without each packing's mean offset
  LogPolynomial line, curve;
  VarianceRatio line_misfit, curve_misfit;  ///< with the errors `between`
  VarianceRatio paired_misfit;              ///< of the curve, with the errors `paired`
  VarianceRatio bend;                       ///< improvement of the curve over the line
  VarianceRatio third;                      ///< improvement of a cubic over the curve
  VarianceRatio offsets;                    ///< improvement by a factor for each series
  double largest_offset = not_known, offset_error = not_known;  ///< of a series, in ln Delta x_max

  bool is_known() const { return points.size() > 4; }
};

/// `groups` has a list for each series: the groups at the values of one variable of Eq. 3.
MasterCurve fit_master_curve(const std::vector<Groups>& groups);

/// chi^2 over the degrees of freedom of a fit whose points have the pooled error `error`.
VarianceRatio misfit_of(const WeightedFit& fit, const PooledError& error);

/// The least f_max/(m g) at which f_max >> f_g is taken to hold, and the least m_w/m of the walls
/// on the curve.
constexpr double least_load = 2.0, least_wall = 0.2;

/// Reports a finding: the fit of C with the shape of the box as a second variable beside X.
void report_box(PaperData& data, PaperSection& section);

}  // namespace ballast

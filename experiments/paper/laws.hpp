#pragma once
// Do all that is varied fall on one curve? Eq. 3 says that Delta x_max depends on nu, f_max, g and
// m_w through its right side X alone, and linearly. The first half, the grouping, is tested apart
// from the second: ln Delta x_max as a polynomial of ln X.

#include "experiments/paper/sections.hpp"

namespace ballast {

struct CurvePoint {
  size_t series = 0;  ///< of the list of groups
  Group group;
  double x = not_known;  ///< X [m]

  double log_rise() const { return group.log_mean("rise"); }
};

/// ln Delta x_max as a polynomial of ln(X/X0), X0 the middle of the points.
struct LogPolynomial {
  WeightedFit fit;
  double middle = 1.0;  ///< X0 [m]

  Eigen::VectorXd row(double x) const;        ///< 1, u, u^2 ...
  Eigen::VectorXd slope_row(double x) const;  ///< its derivative
  double at(double x) const;                  ///< Delta x_max [m]
};

struct OneCurve {
  std::vector<CurvePoint> points;  ///< distinct runs: the base of all series counts once
  double least = not_known, most = not_known;  ///< X of the points [m]
  PooledError between;  ///< ln Delta x_max of a sample about its point's mean
  PooledError paired;   ///< the same when each packing's mean offset is taken out
  LogPolynomial line, curve;
  VarianceRatio line_misfit, curve_misfit;  ///< with the errors `between`
  VarianceRatio paired_misfit;              ///< of the curve, with the errors `paired`
  VarianceRatio bend;                       ///< of the curve over the line
  VarianceRatio third;                      ///< of a cubic over the curve
  VarianceRatio offsets;                    ///< of a factor for each series over the curve
  double largest_offset = not_known, offset_error = not_known;  ///< of a series, in ln Delta x_max

  bool is_known() const { return points.size() > 4; }
};

/// `groups`: a list for each series, the values of one thing that Eq. 3 has.
OneCurve one_curve(const std::vector<Groups>& groups);

/// chi^2 over the degrees of freedom of a fit whose errors are the pooled one.
VarianceRatio misfit_of(const WeightedFit& fit, const PooledError& error);

/// f_max/(m g) from which on f_max >> f_g is taken to hold.
constexpr double least_load = 2.0;

/// A finding: C with the shape of the box as a second variable beside X.
void report_box(PaperData& data, PaperSection& section);

}  // namespace ballast

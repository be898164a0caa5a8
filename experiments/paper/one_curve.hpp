#pragma once
// Do all that is varied fall on one curve? Eq. 3 says that Delta x_max depends on nu, f_max, g and
// m_w through its right side X alone, and linearly. The first half, the grouping, is tested apart
// from the second: ln Delta x_max as a polynomial of ln X.

#include <vector>

#include "experiments/measure/weighted_fit.hpp"
#include "experiments/paper/run_groups.hpp"

namespace ballast {

/// One thing varied: its points have a colour, a mark and a row in every table.
struct Series {
  Varied varied;
  const char *name, *title;  ///< in words, and in the legend
  Ink ink;
  MarkShape shape;  ///< as in the paper's Fig. 11
  double exponent;  ///< of Eq. 3, in abscissa_of
};
std::span<const Series> all_series();
/// What an exponent is of: nu [Hz], f_max/(m g0), g [m/s^2], m/(m + m_w).
double abscissa_of(const VariedValue& value, Varied varied);

struct CurvePoint {
  size_t series = 0;  ///< index into all_series()
  VariedValue value;
  double x = not_known;  ///< X [m]

  double log_rise() const;  ///< mean over samples of ln Delta x_max
};

/// ln Delta x_max as a polynomial of ln(X/X0), X0 the middle of the points.
struct LogPolynomial {
  WeightedFit fit;
  double middle = 1.0;  ///< X0 [m]

  Eigen::VectorXd row(double x) const;        ///< 1, u, u^2 ...
  Eigen::VectorXd slope_row(double x) const;  ///< its derivative
  double at(double x) const;                  ///< Delta x_max [m]
};

/// A series's own exponent beside what the curve through all other sweeps says of it.
struct SeriesExponent {
  size_t series = 0;
  int points = 0;
  double own = not_known, own_error = not_known;
  double predicted = not_known, predicted_error = not_known;
  bool is_inside = false;  ///< the other sweeps reach over its X
  double p = not_known;    ///< of their difference
};

struct OneCurve {
  std::vector<CurvePoint> points;  ///< distinct runs: the base of all sweeps counts once
  PooledError between;             ///< ln Delta x_max of a sample about its point's mean
  PooledError paired;              ///< the same when each packing's mean offset is taken out
  double weighing = 1.0;           ///< the error of a sample that the fits take
  LogPolynomial line, curve, cubic;
  Misfit line_misfit, curve_misfit;  ///< with the errors `between`
  Misfit paired_misfit;              ///< of the curve, with the errors `paired`
  Improvement bend;                  ///< of the curve over the line
  Improvement third;                 ///< of the cubic over the curve
  Improvement offsets;               ///< of a factor for each series over the curve
  double largest_offset = not_known, offset_error = not_known;  ///< of a series, in ln Delta x_max
  std::vector<SeriesExponent> exponents;
  SampleMean curvature;  ///< of u^2, each packing by itself

  bool is_known() const { return points.size() > 4; }
};

/// `values`: one list for each of all_series().
OneCurve one_curve(const std::vector<std::vector<VariedValue>>& values);

/// The force of the grains over m g that gives this C in the limit f_max >> f_g, when the wall and
/// all grains move together: C = (9/4 pi^2) (F/m g)^2.
double force_of_prefactor(double prefactor);

}  // namespace ballast

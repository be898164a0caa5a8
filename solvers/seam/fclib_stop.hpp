#pragma once
// Siconos' measure of an answer (ContactError::fclib) as a reason to stop, for whoever evaluates
// errors.
//
//   |r - P_K(r - (u + mu |u_T| n))| over all contacts / max(|q|, |r|, |u|)  <=  tolerance
//
// How it stands to the natural map changes while impulses grow, so no tolerance on the one can
// stand for a tolerance on the other.

#include <limits>
#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "problems/algebra/mass_root.hpp"

namespace ballast {

class FclibStop {
 public:
  /// `problem` outlives it. Throws InvalidProblem for a mass block that is not positive definite.
  FclibStop(const FrictionProblem& problem, double tolerance);

  double tolerance() const { return tolerance_; }
  /// The measure of `r`, from u = W r + q recomputed: one product with W.
  double measure(const Impulses& r);
  /// The measure is below its tolerance. `natural_map` of the same impulses [m/s] says whether a
  /// look is worth its product: not while it is neither half of what it was at the last look nor
  /// near the aim. The first looks are always taken.
  bool reached(const Impulses& r, double natural_map);
  /// Where the natural map should stand when the measure is reached [m/s], from the last look;
  /// infinite before the first.
  double aim() const { return aim_; }

  /// reached() asks for a hair less than the tolerance, because the judge sums in another order.
  static constexpr double margin = 1e-3;

 private:
  static constexpr int first_looks = 4;
  static constexpr double near_aim = 3.0;

  const FrictionProblem* problem_;
  double tolerance_, aim_ = std::numeric_limits<double>::infinity();
  double looked_at_ = std::numeric_limits<double>::infinity();
  int looks_ = 0;
  std::vector<MassRoot> roots_;
  Eigen::VectorXd q_, u_, v_;
  double q_norm_ = 0.0;
};

}  // namespace ballast

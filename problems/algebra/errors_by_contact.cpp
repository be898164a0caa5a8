#include "problems/algebra/errors_by_contact.hpp"

#include <cmath>
#include <limits>

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"

namespace ballast {

std::vector<double> errors_by_contact(const FrictionProblem& problem, const Impulses& r) {
  Eigen::VectorXd u;
  contact_velocity(problem, r, u);
  std::vector<Eigen::Matrix3d> diagonal;
  delassus_diagonal(problem, diagonal);
  // a one-row contact is a frictionless one without tangential motion
  const auto padded = [&](const Eigen::VectorXd& x, int c) {
    Eigen::Vector3d entries = Eigen::Vector3d::Zero();
    for (int k = 0; k < problem.contact_rows(c); ++k) entries[k] = x[problem.row_begin[c] + k];
    return entries;
  };
  std::vector<double> errors;
  for (int c = 0; c < problem.contact_count(); ++c) {
    const double lambda_max = largest_eigenvalue(diagonal[static_cast<size_t>(c)]);
    const double error =
        lambda_max > 0.0
            ? ContactJudge::scaled_natural_map(padded(r, c), padded(u, c),
                                               problem.friction[static_cast<size_t>(c)], lambda_max)
            : 0.0;
    errors.push_back(std::isfinite(error) ? error : std::numeric_limits<double>::infinity());
  }
  return errors;
}

}  // namespace ballast

#include "problems/algebra/no_solution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "platform/clock.hpp"
#include "platform/text.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"

namespace ballast {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// |W^T y| below this part of |W|^T y is rounding.
constexpr double cancelled = 1e-12;

/// W, q and the scale of impulses of one problem, for many weights.
struct Prover {
  const FrictionProblem& problem;
  SparseRows w, absolute;  ///< W; |W|, entry by entry
  Eigen::VectorXd q;
  std::vector<double> natural;  ///< natural impulse of each contact's island (least_growth)

  int normal(int c) const { return problem.row_begin[c]; }

  /// The proof by these `weights` >= 0 of the contacts.
  NoSolutionProof proof(const Eigen::VectorXd& weights) const {
    NoSolutionProof proof;
    const double sum = weights.sum();
    if (!(sum > 0.0) || !std::isfinite(sum)) return proof;
    Eigen::VectorXd y = Eigen::VectorXd::Zero(problem.row_count());
    for (int c = 0; c < problem.contact_count(); ++c) y[normal(c)] = weights[c] / sum;
    proof.approach = -q.dot(y);
    // Sums that cancel to rounding prove nothing.
    if (!(proof.approach > 1e-10 * q.cwiseAbs().dot(y))) return {};
    const double slope = (w.transpose() * y).norm();
    // Without bodies no scale says which impulses are large: W^T y must be zero to rounding.
    if (!problem.has_dynamics && slope > cancelled * (absolute.transpose() * y).norm()) return {};
    proof.least_impulse = slope > 0.0 ? proof.approach / slope : infinity;
    double scale = 0.0;
    for (int c = 0; c < problem.contact_count(); ++c)
      if (weights[c] > 0.0) scale = std::max(scale, natural[c]);
    proof.least_growth = scale > 0.0 ? proof.least_impulse / scale : infinity;
    const double largest = weights.maxCoeff(&proof.first_contact);
    proof.contacts = static_cast<int>((weights.array() > 1e-3 * largest).count());
    return proof;
  }

  /// One Gauss-Seidel sweep of the frictionless problem: normal impulses alone.
  void sweep(Eigen::VectorXd& r) const {
    for (int c = 0; c < problem.contact_count(); ++c) {
      double u = q[normal(c)], own = 0.0;
      for (SparseRows::InnerIterator entry(w, normal(c)); entry; ++entry) {
        u += entry.value() * r[entry.col()];
        if (entry.col() == normal(c)) own = entry.value();
      }
      if (own > 0.0) r[normal(c)] = std::max(0.0, r[normal(c)] - u / own);
    }
  }
};

/// Replaces values by the largest of their contact's island; where only W is known, of all.
void spread_over_islands(const FrictionProblem& problem, std::vector<double>& values) {
  if (values.empty()) return;
  if (!problem.has_dynamics) {
    values.assign(values.size(), *std::ranges::max_element(values));
    return;
  }
  for (const std::vector<int>& island : contact_islands(problem)) {
    double largest = 0.0;
    for (const int c : island) largest = std::max(largest, values[c]);
    for (const int c : island) values[c] = largest;
  }
}

}  // namespace

NoSolutionProof prove_no_solution(const FrictionProblem& problem, const Impulses& r, int sweeps,
                                  double max_seconds) {
  const Stopwatch watch;
  if (watch.has_passed(max_seconds)) return {};
  const int contacts = problem.contact_count();
  Prover prover{problem, delassus_matrix(problem), {}, {}, {}};
  if (!problem.has_dynamics) prover.absolute = prover.w.cwiseAbs();
  free_contact_velocity(problem, prover.q);
  std::vector<Eigen::Matrix3d> diagonal;
  delassus_diagonal(problem, diagonal);
  prover.natural.resize(contacts);
  for (int c = 0; c < contacts; ++c) {
    const double lambda = largest_eigenvalue(diagonal[c]);
    if (lambda > 0.0)
      prover.natural[c] =
          prover.q.segment(problem.row_begin[c], problem.contact_rows(c)).norm() / lambda;
    if (!problem.has_dynamics) continue;
    for (const int body : {problem.dynamics.body_a[c], problem.dynamics.body_b[c]})
      if (body >= 0)  // that angular momenta count, too, can only make a claim rarer
        prover.natural[c] = std::max(prover.natural[c], problem.dynamics.momentum(body));
  }
  spread_over_islands(problem, prover.natural);
  NoSolutionProof best;
  const auto consider = [&](const Eigen::VectorXd& y) {
    const NoSolutionProof proof = prover.proof(y);
    if (proof.least_growth > best.least_growth) best = proof;
  };
  // Single contacts that no normal impulse moves.
  for (int c = 0; c < contacts && !best.proved(); ++c)
    if (!(diagonal[c](0, 0) > 0.0)) consider(Eigen::VectorXd::Unit(contacts, c));
  // The direction of the given impulses.
  Eigen::VectorXd y(contacts);
  for (int c = 0; c < contacts; ++c) {
    const double normal = r.size() == problem.row_count() ? r[prover.normal(c)] : 0.0;
    y[c] = std::isfinite(normal) ? std::max(0.0, normal) : 0.0;
  }
  consider(y);
  // Where sweeps diverge, the increment of a sweep tends to the null space of W.
  Eigen::VectorXd swept = Eigen::VectorXd::Zero(problem.row_count()), before;
  constexpr double most_work = 3e8;  // multiplications
  sweeps = static_cast<int>(std::min<double>(sweeps, most_work / (1.0 + prover.w.nonZeros())));
  for (int k = 0; k < sweeps && !best.proved() && !watch.has_passed(max_seconds); ++k) {
    before = swept;
    prover.sweep(swept);
    for (int c = 0; c < contacts; ++c)
      y[c] = std::max(0.0, swept[prover.normal(c)] - before[prover.normal(c)]);
    consider(y);
  }
  return best;
}

std::string NoSolutionProof::words() const {
  if (!proved()) return "";
  const std::string who = contacts == 1
                              ? printed("contact %d sinks in at %.3g m/s", first_contact, approach)
                              : printed("%d contacts (one is %d) sink in at %.3g m/s in the mean",
                                        contacts, first_contact, approach);
  if (!std::isfinite(least_impulse))
    return "there is no solution: " + who + " whatever the impulses";
  return "no impulses of a sensible size are a solution: " + who +
         printed(" whatever impulses below %.3g N s do", least_impulse);
}

}  // namespace ballast

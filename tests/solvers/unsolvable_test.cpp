// The answers of every backend for problems that no impulses solve, and for an unsymmetric W.

#include "tests/problems/algebra/unsolvable.hpp"
#include "tests/solvers/conformance_support.hpp"

using namespace ballast;

namespace {

const Budget brief{.tolerance = 1e-8, .max_iterations = 500, .max_seconds = 1.0};

/// A stored W whose diagonal blocks deviate from symmetry by `part` of their diagonal, as with
/// implicit gyroscopic terms, and q such that some contacts slide, some stick and some open.
FrictionProblem gyroscopic(double part, std::uint64_t seed) {
  FrictionProblem problem = only_delassus(known(4, 5, 0.8, 10.0, seed).problem);
  SparseRows& w = problem.delassus.w;
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int first = problem.row_begin[c];
    if (problem.contact_rows(c) < 3) continue;
    for (const auto& [i, j] : {std::pair(0, 1), std::pair(1, 2), std::pair(2, 0)}) {
      const double size =
          0.5 * part * std::sqrt(w.coeff(first + i, first + i) * w.coeff(first + j, first + j));
      w.coeffRef(first + i, first + j) += size;
      w.coeffRef(first + j, first + i) -= size;
    }
  }
  w.makeCompressed();
  return problem;
}

}  // namespace

TEST_CASE("no backend solves what has no solution, and the two say so") {
  for_each_backend([](const SolverEntry& entry) {
    const std::optional<SolverRun> immovable = run(entry, immovable_contact(-1.0), brief);
    if (immovable) CHECK(immovable->verdict == Verdict::no_solution);
    const std::optional<SolverRun> squeezed = run(entry, squeezed_contacts(), brief);
    if (!squeezed) return;
    CAPTURE(name_of(squeezed->solved.reason), squeezed->solved.impulses.transpose());
    CHECK_FALSE(squeezed->is_solved());
  });
}

TEST_CASE("with the greatest friction a claim is as good as with any") {
  for_each_backend([](const SolverEntry& entry) {
    for (const double mu : {10.0, 1e3, largest_friction}) {
      const std::optional<SolverRun> result = run(entry, rough_contact(mu), brief);
      if (!result) return;
      CAPTURE(mu, name_of(result->verdict), result->error.natural_map_rms,
              result->error.approach_rms, result->solved.impulses.transpose());
      CHECK(result->error.finite);
      if (result->is_solved()) CHECK(result->error.min_normal_velocity > -4e-8);
    }
  });
}

TEST_CASE("W is judged as it is stored, symmetric or not") {
  int solved = 0, backends = 0;
  for (const SolverEntry& entry : solver_list()) {
    if (!entry.make) continue;
    CAPTURE(entry.name);
    ++backends;
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      const FrictionProblem problem = gyroscopic(0.16, seed);
      const std::optional<SolverRun> result = run(entry, problem, brief);
      if (!result || !result->is_solved()) continue;
      ++solved;
      // u = W r + q with the stored W, entry by entry.
      const Eigen::VectorXd u =
          Eigen::MatrixXd(problem.delassus.w) * result->solved.impulses + problem.delassus.q;
      for (int c = 0; c < problem.contact_count(); ++c) CHECK(u[problem.row_begin[c]] > -1e-7);
      if (entry.law != ContactLaw::coulomb) continue;
      for (int c = 0; c < problem.contact_count(); ++c) {
        const int first = problem.row_begin[c];
        if (problem.contact_rows(c) < 3) continue;
        const Eigen::Vector3d r = result->solved.impulses.segment<3>(first);
        const double slip = u.segment<2>(first + 1).norm();
        // Sliding contacts have the friction mu r_N against the slip.
        CHECK(std::abs(r.tail<2>().dot(u.segment<2>(first + 1)) +
                       problem.friction[c] * r[0] * slip) < 1e-5);
      }
    }
  }
  CHECK(solved > 2 * backends);  // of three problems each, with any backends that a build has
}

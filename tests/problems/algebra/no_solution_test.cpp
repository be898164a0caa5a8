#include "problems/algebra/no_solution.hpp"

#include <cmath>

#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/made_problems.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/problems/algebra/unsolvable.hpp"

using namespace ballast;

TEST_CASE("two bodies that nothing can move and that approach have no solution") {
  const FrictionProblem problem = immovable_contact(-1.0);
  const NoSolutionProof proof = prove_no_solution(problem, Impulses::Zero(3));
  CHECK(proof.proved());
  CHECK(std::isinf(proof.least_impulse));
  CHECK(proof.approach == 1.0);
  CHECK(proof.contacts == 1);
  CHECK(proof.words() == "there is no solution: contact 0 sinks in at 1 m/s whatever the impulses");
  // A contact that moves sideways only.
  FrictionProblem sideways = immovable_contact(-1.0);
  sideways.delassus.w.coeffRef(1, 1) = sideways.delassus.w.coeffRef(2, 2) = 1.0;
  CHECK(prove_no_solution(sideways, Impulses::Zero(3)).proved());
  CHECK_FALSE(prove_no_solution(immovable_contact(0.5), Impulses::Zero(3)).proved());
}

TEST_CASE("a body between two walls that close has no solution, sweeps find the proof") {
  const NoSolutionProof proof = prove_no_solution(squeezed_contacts(), Impulses::Zero(6));
  CHECK(proof.proved());
  CHECK(proof.contacts == 2);
  CHECK(proof.approach == Approx(1.0));
  // Impulses of a diverging solver prove it too.
  const Impulses r = (1e12 * Impulses::Unit(6, 0)) + (1e12 + 1.0) * Impulses::Unit(6, 3);
  CHECK(prove_no_solution(squeezed_contacts(), r, 0).proved());
}

TEST_CASE("a heavy body on a light one is no problem without solution, however heavy") {
  for (const double heavy : {1e3, 1e8, 1e12}) {
    FrictionProblem problem;
    problem.has_dynamics = true;
    problem.row_begin = {0, 1, 2};
    problem.friction = {0.0, 0.0};
    DynamicsForm& d = problem.dynamics;
    d.add_body(Eigen::MatrixXd::Constant(1, 1, 1.0));
    d.add_body(Eigen::MatrixXd::Constant(1, 1, heavy));
    d.body_a = {-1, 0};
    d.body_b = {0, 1};
    d.h = {1.0, -1.0, 1.0};
    d.h_begin = {0, 1, 3};
    d.v_free = Eigen::Vector2d(-0.01, -0.01);
    d.bias = Eigen::Vector2d::Zero();
    INFO("of " << heavy << " kg");
    CHECK_FALSE(prove_no_solution(problem, Impulses::Zero(2)).proved());
    CHECK_FALSE(prove_no_solution(problem, Eigen::Vector2d(1.0 + heavy, heavy)).proved());
  }
}

TEST_CASE("a stiff W without bodies that hardly sees some weights proves nothing") {
  // A body of 1 kg at rest on one of 1e-9 kg that sinks into the floor: r_N = 1, 1 + 1e-9.
  const double k = 1e9;
  Eigen::MatrixXd w = k * Eigen::MatrixXd::Identity(6, 6);
  w.topRightCorner(3, 3) = w.bottomLeftCorner(3, 3) = -k * Eigen::Matrix3d::Identity();
  w.topLeftCorner(3, 3) += Eigen::Matrix3d::Identity();
  const FrictionProblem problem = stored_problem({0.5, 0.5}, w, -Impulses::Unit(6, 3));
  CHECK_FALSE(prove_no_solution(problem, Impulses::Zero(6)).proved());
  const Impulses r = Impulses::Unit(6, 0) + Impulses::Unit(6, 3);
  CHECK_FALSE(prove_no_solution(problem, r).proved());
}

TEST_CASE("a proof below some size does not say that there is no solution") {
  NoSolutionProof proof{.least_impulse = 1e9, .least_growth = 1e9, .approach = 1.0, .contacts = 1};
  CHECK(proof.words() ==
        "no impulses of a sensible size are a solution: contact 0 sinks in at 1 m/s whatever "
        "impulses below 1e+09 N s do");
}

TEST_CASE("no proof is searched when the time is over") {
  CHECK_FALSE(prove_no_solution(squeezed_contacts(), Impulses::Zero(6), 500, 0.0).proved());
}

TEST_CASE("a heavy body elsewhere hides no proof") {
  FrictionProblem problem;
  problem.has_dynamics = true;
  problem.row_begin = {0, 1, 2, 3};
  problem.friction = {0.0, 0.0, 0.0};
  DynamicsForm& d = problem.dynamics;
  d.add_body(Eigen::MatrixXd::Constant(1, 1, 1.0));
  d.add_body(Eigen::MatrixXd::Constant(1, 1, 1e20));
  // The first body is between two closing walls, the second on another wall.
  d.body_a = {-1, 0, -1};
  d.body_b = {0, -1, 1};
  d.h = {1.0, -1.0, 1.0};
  d.h_begin = {0, 1, 2, 3};
  d.v_free = Eigen::Vector2d(0.0, -1.0);
  d.bias = Eigen::Vector3d(-1.0, -1.0, 0.0);
  CHECK(prove_no_solution(problem, Impulses::Zero(3)).proved());
}

TEST_CASE("what weights prove is what dense matrices say") {
  FrictionProblem problem = oracle::mixed_problem();
  // Makes contact 4, which nothing moves, part: sinking in there would be the better proof.
  problem.dynamics.bias[problem.row_begin[4]] = 1.0;
  const Eigen::MatrixXd w = oracle::dense_delassus(problem);
  const Eigen::VectorXd q = oracle::dense_q(problem);
  int proofs = 0;
  for (int c = 0; c < problem.contact_count(); ++c) {
    // Without sweeps the weights are the normal impulses.
    const int row = problem.row_begin[c];
    const NoSolutionProof proof =
        prove_no_solution(problem, 2.5 * Impulses::Unit(problem.row_count(), row), 0);
    if (q[row] >= 0.0) {
      CHECK(proof.least_impulse == 0.0);
      continue;
    }
    ++proofs;
    CHECK(proof.approach == Approx(-q[row]));
    CHECK(proof.least_impulse == Approx(-q[row] / w.row(row).norm()));
  }
  CHECK(proofs > 0);
}

TEST_CASE("problems with a solution are never proved to have none") {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    const KnownSolution known = make_known_solution({.seed = seed});
    const NoSolutionProof proof = prove_no_solution(known.problem, known.r);
    CHECK_FALSE(proof.proved());
    CHECK(proof.least_impulse <= known.r.norm());
    CHECK(proof.words().empty());
  }
  for (const StressProblem& stress : stress_problems()) {
    CAPTURE(stress.name);
    CHECK_FALSE(
        prove_no_solution(stress.problem, Impulses::Zero(stress.problem.row_count())).proved());
  }
}

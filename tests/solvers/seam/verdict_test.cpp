#include "solvers/seam/verdict.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/problems/algebra/unsolvable.hpp"

using namespace ballast;

namespace {

constexpr StopReason claimed = StopReason::reached_tolerance;

Verdict verdict(const FrictionProblem& problem, const Impulses& r, double tolerance = 1e-8) {
  return verdict_of(claimed, contact_error(problem, r), tolerance);
}

}  // namespace

TEST_CASE("every verdict has a word of its own, as records keep it") {
  CHECK(std::string(name_of(Verdict::solved)) == "solved");
  CHECK(std::string(name_of(Verdict::unsolved)) == "unsolved");
  CHECK(std::string(name_of(Verdict::denied)) == "denied");
  CHECK(std::string(name_of(Verdict::no_solution)) == "no_solution");
}

TEST_CASE("a contact that no impulse moves and that sinks in has no solution") {
  CHECK(verdict(immovable_contact(-1.0), Impulses::Zero(3)) == Verdict::no_solution);
  CHECK(verdict(immovable_contact(1.0), Impulses::Zero(3)) == Verdict::solved);
  CHECK(verdict_of(StopReason::stalled, contact_error(immovable_contact(-1.0), Impulses::Zero(3)),
                   1e-8) == Verdict::no_solution);
  // an impulse there where u_N > 0 answers nothing
  CHECK(verdict(immovable_contact(1.0), Eigen::Vector3d(2.0, 0.0, 0.0)) == Verdict::denied);
}

TEST_CASE("impulses that swallow the velocities solve nothing") {
  Impulses r = Impulses::Zero(6);
  r[0] = r[3] = 1e17;  // r - rho u == r: the natural map is zero
  const ContactError error = contact_error(squeezed_contacts(), r);
  CHECK(error.natural_map_rms <= 1e-8);
  CHECK(error.min_normal_velocity == -1.0);
  CHECK(verdict_of(claimed, error, 1e-8) == Verdict::no_solution);
  CHECK(words_of(Verdict::no_solution, claimed, error, 1e-8) ==
        "no solution found; r grows without bound: 1e+17 times what a contact alone needs");
  CHECK(error.fclib < 1e-8);
  CHECK(fclib_verdict_of(claimed, error, 1e-8) == Verdict::no_solution);
  r[0] = r[3] = 1e3;  // on the way there
  CHECK(verdict(squeezed_contacts(), r) == Verdict::denied);
  CHECK(verdict_of(StopReason::iteration_limit, contact_error(squeezed_contacts(), r), 1e-8) ==
        Verdict::unsolved);
}

TEST_CASE("with much friction a small natural map is not enough") {
  // No impulse at all: the contact sinks in, and mu |u_T| hides it.
  const ContactError falls = contact_error(rough_contact(1e9), Impulses::Zero(3));
  CHECK(falls.natural_map_rms < 1e-10);
  CHECK(falls.approach_rms == Approx(9.81e-3));
  CHECK(verdict_of(claimed, falls, 1e-8) == Verdict::denied);
  CHECK(words_of(Verdict::denied, claimed, falls, 1e-8) ==
        "the judge denies it: -u_N is 0.00981 m/s (rms), at most 4e-08 may be");
  // What stands is solved.
  CHECK(verdict(rough_contact(1e4), Eigen::Vector3d(9.81e-3, -1e-3, 0.0)) == Verdict::solved);
}

TEST_CASE("a miss says which part of the law, and by how much") {
  const ContactError error = contact_error(rough_contact(0.5), Impulses::Zero(3));
  CHECK(words_of(Verdict::denied, claimed, error, 1e-8).find("the natural map is") !=
        std::string::npos);
  CHECK(words_of(Verdict::unsolved, StopReason::time_limit, error, 1e-8) == "unsolved: time_limit");
  ContactError broken = error;
  broken.finite = false;
  CHECK(verdict_of(claimed, broken, 1e300) == Verdict::denied);
  CHECK(words_of(Verdict::denied, claimed, broken, 1e300) ==
        "the judge denies it: the impulses, or velocities that they give, are not finite");
}

TEST_CASE("what is not solved is searched for a proof that it cannot be") {
  const auto finding = [](const FrictionProblem& problem, const Impulses& r, StopReason reason) {
    return finding_on(problem, r, reason, contact_error(problem, r), 1e-8);
  };
  const Finding none = finding(squeezed_contacts(), Impulses::Zero(6), StopReason::stalled);
  CHECK(none.verdict == Verdict::no_solution);
  CHECK(none.words ==
        "there is no solution: 2 contacts (one is 0) sink in at 1 m/s in the mean whatever the "
        "impulses");
  const Finding early = finding(rough_contact(0.5), Impulses::Zero(3), StopReason::time_limit);
  CHECK(early.verdict == Verdict::unsolved);
  CHECK(early.words == "unsolved: time_limit");
  const Finding good = finding(rough_contact(1e4), Eigen::Vector3d(9.81e-3, -1e-3, 0.0), claimed);
  CHECK(good.verdict == Verdict::solved);
  CHECK(good.words == "solved");
}

#include "problems/algebra/known_solutions.hpp"

#include "problems/algebra/contact_error.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

TEST_CASE("the known solution is one") {
  for (const int contacts : {0, 1, 5, 40, 400})
    for (const double friction : {0.0, 0.5, 10.0})
      for (const double mass_ratio : {1.0, 1e6}) {
        KnownSolutionSettings settings;
        settings.contacts = contacts;
        settings.friction_max = friction;
        settings.mass_ratio = mass_ratio;
        settings.seed = contacts + 7;
        const KnownSolution known = make_known_solution(settings);
        REQUIRE_NOTHROW(known.problem.validate());
        const ContactError error = contact_error(known.problem, known.r);
        CHECK(error.natural_map_max <= 1e-12 * (1.0 + friction * friction));
        Eigen::VectorXd u;
        contact_velocity(known.problem, known.r, u);
        CHECK((u - known.u).lpNorm<Eigen::Infinity>() < 1e-12 * (1 + friction));
      }
}

TEST_CASE("every kind of contact occurs") {
  KnownSolutionSettings settings;
  settings.contacts = 400;
  settings.friction_min = 0.1;
  const KnownSolution known = make_known_solution(settings);
  int open = 0, stick = 0, slip = 0, one_row = 0, ground = 0;
  for (int c = 0; c < 400; ++c) {
    const int first = known.problem.row_begin[c];
    if (known.problem.contact_rows(c) == 1)
      ++one_row;
    else if (known.r[first] == 0.0)
      ++open;
    else
      ++(known.u.segment<3>(first).norm() > 0.0 ? slip : stick);
    ground += known.problem.dynamics.body_a[c] == -1;
  }
  CHECK(open > 60);
  CHECK(stick > 80);
  CHECK(slip > 80);
  CHECK(one_row > 20);
  CHECK(ground > 5);
}

TEST_CASE("W has full rank below the number of unknowns and not above") {
  KnownSolutionSettings settings;
  settings.frictionless_fraction = 0.0;
  settings.bodies = 10;
  settings.contacts = 40;
  const FrictionProblem problem = make_known_solution(settings).problem;
  Eigen::FullPivLU<Eigen::MatrixXd> lu(oracle::dense_delassus(problem));
  lu.setThreshold(1e-10);
  CHECK(lu.rank() == 60);
  CHECK(problem.row_count() == 120);
}

TEST_CASE("the seed decides every bit") {
  KnownSolutionSettings settings;
  const KnownSolution a = make_known_solution(settings), b = make_known_solution(settings);
  CHECK(a.problem.dynamics.h == b.problem.dynamics.h);
  CHECK(a.problem.dynamics.bias == b.problem.dynamics.bias);
  CHECK(a.r == b.r);
  settings.seed = 2;
  CHECK(make_known_solution(settings).problem.dynamics.h != a.problem.dynamics.h);
}

TEST_CASE("repeated contacts and other units keep the solution") {
  KnownSolutionSettings settings;
  const KnownSolution plain = make_known_solution(settings);
  settings.copies = 5;
  settings.mass_unit = 1e3;
  settings.velocity_unit = 100.0;
  const KnownSolution other = make_known_solution(settings);
  REQUIRE_NOTHROW(other.problem.validate());
  CHECK(other.problem.contact_count() == 5 * plain.problem.contact_count());
  CHECK(contact_error(other.problem, other.r).natural_map_max <= 1e-11 * 100.0);
  CHECK(other.r.sum() == Approx(1e5 * plain.r.sum()));
  Eigen::VectorXd v, w;
  body_velocity(plain.problem.dynamics, plain.problem.row_begin, plain.r, v);
  body_velocity(other.problem.dynamics, other.problem.row_begin, other.r, w);
  CHECK((w - 100.0 * v).lpNorm<Eigen::Infinity>() < 1e-11 * 100.0);
}

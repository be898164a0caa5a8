#include "problems/algebra/known_solutions.hpp"

#include "problems/algebra/contact_error.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

TEST_CASE("the known solution is one") {
  for (const int contacts : {0, 1, 5, 40, 400})
    for (const double friction : {0.0, 0.5, 10.0})
      for (const double mass_ratio : {1.0, 1e6}) {
        const KnownSolution known = make_known_solution({.contacts = contacts,
                                                         .friction_max = friction,
                                                         .mass_ratio = mass_ratio,
                                                         .seed = contacts + 7ul});
        REQUIRE_NOTHROW(known.problem.validate());
        const ContactError error = contact_error(known.problem, known.r);
        CHECK(error.natural_map_max <= 1e-12 * (1.0 + friction * friction));
        Eigen::VectorXd u;
        contact_velocity(known.problem, known.r, u);
        CHECK((u - known.u).lpNorm<Eigen::Infinity>() < 1e-12 * (1 + friction));
      }
}

TEST_CASE("every kind of contact occurs") {
  const KnownSolution known = make_known_solution({.contacts = 400, .friction_min = 0.1});
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

TEST_CASE("the seed decides every bit") {
  const KnownSolution a = make_known_solution({}), b = make_known_solution({});
  CHECK(a.problem.dynamics.h == b.problem.dynamics.h);
  CHECK(a.problem.dynamics.bias == b.problem.dynamics.bias);
  CHECK(a.r == b.r);
  CHECK(make_known_solution({.seed = 2}).problem.dynamics.h != a.problem.dynamics.h);
}

TEST_CASE("repeated contacts and other units keep the solution") {
  const KnownSolution plain = make_known_solution({}),
                      other = make_known_solution(
                          {.copies = 5, .mass_unit = 1e3, .velocity_unit = 100.0});
  REQUIRE_NOTHROW(other.problem.validate());
  CHECK(other.problem.contact_count() == 5 * plain.problem.contact_count());
  CHECK(contact_error(other.problem, other.r).natural_map_max <= 1e-11 * 100.0);
  CHECK(other.r.sum() == Approx(1e5 * plain.r.sum()));
  Eigen::VectorXd v, w;
  body_velocity(plain.problem.dynamics, plain.problem.row_begin, plain.r, v);
  body_velocity(other.problem.dynamics, other.problem.row_begin, other.r, w);
  CHECK((w - 100.0 * v).lpNorm<Eigen::Infinity>() < 1e-11 * 100.0);
}

TEST_CASE("a contact frame is a rotation whose first row is the normal, and moves with the body") {
  const Eigen::Vector3d n = Eigen::Vector3d(1.0, 2.0, -2.0) / 3.0, arm(1.0, -2.0, 0.5);
  const Eigen::Matrix3d frame = contact_frame(n, Eigen::Vector3d::UnitX());
  CHECK(Eigen::Vector3d(frame.row(0)) == n);
  CHECK((frame * frame.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-15);
  CHECK(frame.determinant() == Approx(1.0));
  Eigen::VectorXd v(6);
  v << 0.3, -0.2, 0.1, 0.25, 3.0, -1.0;
  const Eigen::Vector3d moved = v.head<3>() + Eigen::Vector3d(v.tail<3>()).cross(arm);
  CHECK((rigid_rows(frame, arm) * v - frame * moved).norm() < 1e-14);
}

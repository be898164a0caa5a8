#include "solvers/parts/unit_mass_system.hpp"

#include <limits>

#include "platform/random.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// The slow twin: I + G^T K G, dense.
Eigen::MatrixXd dense(const UnitMassContacts& contacts, const std::vector<Eigen::Matrix3d>& gain) {
  constexpr int width = UnitMassContacts::width;
  const int n = contacts.unknown_count();
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(n, n);
  for (int c = 0; c < contacts.contact_count(); ++c) {
    Eigen::MatrixXd g = Eigen::MatrixXd::Zero(3, n);
    for (int s = 0; s < 2; ++s)
      g.middleCols<width>(width * contacts[c].body[s]) += contacts[c].g[s];
    a += g.transpose() * gain[c] * g;
  }
  return a;
}

/// Some contacts open, some stick, some slip (unsymmetric).
std::vector<Eigen::Matrix3d> some_gains(int contacts, double stiffness, std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Matrix3d> gains;
  for (int c = 0; c < contacts; ++c) {
    Eigen::Matrix3d k = Eigen::Matrix3d::Zero();
    if (c % 3 == 1) k = stiffness * Eigen::Matrix3d::Identity();
    if (c % 3 == 2) k << stiffness, 0, 0, 0.4 * stiffness, 0, 0, 0, 0, random.uniform();
    gains.push_back(k);
  }
  return gains;
}

}  // namespace

TEST_CASE("the system in the bodies' unknowns is solved like a dense one", "[factors]") {
  UnitMassContacts contacts;
  UnitMassSystem system;
  for (const int bodies : {1, 5, 30})
    for (const double stiffness : {1.0, 1e5}) {
      CAPTURE(bodies, stiffness);
      KnownSolutionSettings settings;
      settings.bodies = bodies;
      settings.contacts = 3 * bodies;
      settings.mass_ratio = 10.0;
      const FrictionProblem problem = make_known_solution(settings).problem;
      contacts.prepare(problem);
      system.prepare(contacts);
      const std::vector<Eigen::Matrix3d> gains = some_gains(contacts.contact_count(), stiffness, 3);
      REQUIRE(system.factor(gains));
      const Eigen::MatrixXd a = dense(contacts, gains);
      const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(a.rows(), -1.0, 1.0);
      Eigen::VectorXd x;
      system.solve(b, x);
      CHECK((a * x - b).norm() < 1e-10 * b.norm());
      CHECK((x - a.partialPivLu().solve(b)).norm() < 1e-9 * x.norm());
    }
}

TEST_CASE("a system that is not finite is not factored, and the next one is", "[factors]") {
  UnitMassContacts contacts;
  const FrictionProblem problem = make_known_solution({}).problem;
  contacts.prepare(problem);
  UnitMassSystem system;
  system.prepare(contacts);
  std::vector<Eigen::Matrix3d> gains = some_gains(contacts.contact_count(), 1.0, 1);
  gains[4](0, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(system.factor(gains));
  gains[4].setZero();
  CHECK(system.factor(gains));
}

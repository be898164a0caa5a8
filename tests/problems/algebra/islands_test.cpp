// Islands: the component search beside a slow obvious one, and parts that say what the whole says.

#include "problems/algebra/islands.hpp"

#include <algorithm>
#include <set>

#include "platform/random.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

FrictionProblem random_problem(int bodies, int contacts, std::uint64_t seed) {
  return make_known_solution({.bodies = bodies, .contacts = contacts, .seed = seed}).problem;
}

/// The slow obvious way: every body takes the smaller label of its neighbours until nothing
/// changes.
std::vector<int> labels_of(const FrictionProblem& problem) {
  const DynamicsForm& dynamics = problem.dynamics;
  std::vector<int> label(dynamics.body_count());
  for (int b = 0; b < dynamics.body_count(); ++b) label[b] = b;
  for (bool changed = true; changed;) {
    changed = false;
    for (int c = 0; c < problem.contact_count(); ++c) {
      const int a = dynamics.body_a[c], b = dynamics.body_b[c];
      if (a < 0 || b < 0 || label[a] == label[b]) continue;
      label[a] = label[b] = std::min(label[a], label[b]);
      changed = true;
    }
  }
  return label;
}

Impulses random_rows(int rows, std::uint64_t seed) {
  Random random(seed);
  Impulses r(rows);
  for (int i = 0; i < rows; ++i) r[i] = random.uniform(-1.0, 1.0);
  return r;
}

}  // namespace

TEST_CASE("disjoint sets are named by their smallest member") {
  DisjointSets sets;
  sets.reset(6);
  sets.join(5, 3);
  sets.join(4, 5);
  CHECK(sets.find(3) == 3);
  CHECK(sets.find(4) == 3);
  CHECK(sets.find(5) == 3);
  sets.join(4, 1);
  CHECK(sets.find(5) == 1);
  CHECK(sets.find(0) == 0);
  sets.reset(6);
  CHECK(sets.find(5) == 5);
}

TEST_CASE("islands are the ones that the slow obvious search finds, each body and contact once") {
  Islands islands;
  int several = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const int bodies = 1 + static_cast<int>(seed % 30), contacts = static_cast<int>(seed * 7 % 40);
    const FrictionProblem problem = random_problem(bodies, contacts, seed);
    const DynamicsForm& dynamics = problem.dynamics;
    islands.find(problem);
    const std::vector<int> label = labels_of(problem);
    std::vector<int> island_of(bodies, -1), contact_seen(contacts, 0);
    std::set<int> names;
    int last_first = -1;
    for (int i = 0; i < islands.count(); ++i) {
      REQUIRE(!islands.bodies(i).empty());
      CHECK(islands.bodies(i)[0] > last_first);
      last_first = islands.bodies(i)[0];
      CHECK(std::is_sorted(islands.bodies(i).begin(), islands.bodies(i).end()));
      CHECK(std::is_sorted(islands.contacts(i).begin(), islands.contacts(i).end()));
      CHECK(names.insert(label[islands.bodies(i)[0]]).second);
      for (const int b : islands.bodies(i)) {
        CHECK(label[b] == label[islands.bodies(i)[0]]);
        CHECK(island_of[b] == -1);
        island_of[b] = i;
      }
      for (const int c : islands.contacts(i)) ++contact_seen[c];
    }
    for (int c = 0; c < contacts; ++c) {
      const int a = dynamics.body_a[c], b = dynamics.body_b[c];
      CHECK(contact_seen[c] == (a >= 0 || b >= 0));
      // a body with a contact is in an island, and all bodies of its label with it
      for (const int body : {a, b})
        if (body >= 0)
          for (int other = 0; other < bodies; ++other)
            if (label[other] == label[body]) CHECK(island_of[other] == island_of[body]);
    }
    for (int b = 0; b < bodies; ++b) {
      const bool touched =
          std::find(dynamics.body_a.begin(), dynamics.body_a.end(), b) != dynamics.body_a.end() ||
          std::find(dynamics.body_b.begin(), dynamics.body_b.end(), b) != dynamics.body_b.end();
      CHECK((island_of[b] >= 0) == touched);
    }
    several += islands.count() > 1;
  }
  CHECK(several > 10);
}

TEST_CASE("an island is a valid problem, and its velocities are the whole problem's") {
  Islands islands;
  FrictionProblem part;
  Impulses rows;
  Eigen::VectorXd u, u_part, u_whole;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const FrictionProblem problem = random_problem(25, 12, seed);
    islands.find(problem);
    REQUIRE(islands.count() > 1);
    const Impulses r = random_rows(problem.row_count(), seed);
    contact_velocity(problem, r, u);
    Impulses back = Impulses::Zero(problem.row_count());
    for (int i = 0; i < islands.count(); ++i) {
      islands.extract(problem, i, part);
      part.validate();
      islands.gather(problem, i, r, rows);
      contact_velocity(part, rows, u_part);
      islands.gather(problem, i, u, u_whole);
      CHECK((u_part - u_whole).norm() <= 1e-13 * (1.0 + u_whole.norm()));
      islands.scatter(problem, i, rows, back);
    }
    for (int c = 0; c < problem.contact_count(); ++c)
      if (problem.dynamics.body_a[c] >= 0 || problem.dynamics.body_b[c] >= 0)
        for (int k = problem.row_begin[c]; k < problem.row_begin[c + 1]; ++k)
          CHECK(back[k] == r[k]);
  }
}

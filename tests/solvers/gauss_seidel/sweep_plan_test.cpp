#include "solvers/gauss_seidel/sweep_plan.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

#include "platform/random.hpp"
#include "platform/worker_team.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "solvers/backends/gauss_seidel.hpp"
#include "solvers/backends/nncg.hpp"
#include "solvers/gauss_seidel/body_sweep.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// A long box of bodies, each in contact with some of those near by: slabs can be cut. Contacts
/// with a fixed wall, and frictionless ones.
FrictionProblem long_box(int bodies, std::uint64_t seed) {
  KnownSolutionSettings settings;
  settings.bodies = bodies;
  settings.contacts = 3 * bodies;
  settings.frictionless_fraction = 0.2;
  settings.seed = seed;
  FrictionProblem problem = make_known_solution(settings).problem;
  Random random(seed);
  DynamicsForm& d = problem.dynamics;
  for (int c = 0; c < problem.contact_count(); ++c) {
    if (d.body_a[c] < 0 || d.body_b[c] < 0) continue;
    // blocks keep their sizes: every body has six unknowns
    d.body_a[c] = static_cast<int>(random.uniform() * (bodies - 20));
    d.body_b[c] = d.body_a[c] + 1 + static_cast<int>(random.uniform() * 19);
  }
  return problem;
}

std::set<int> bodies_of(const FrictionProblem& problem, const SweepPlan& plan,
                        const SweepPlan::Part& part) {
  std::set<int> bodies;
  for (int i = part.begin; i < part.end; ++i)
    for (const int body :
         {problem.dynamics.body_a[plan.contacts()[i]], problem.dynamics.body_b[plan.contacts()[i]]})
      if (body >= 0) bodies.insert(body);
  return bodies;
}

void check_disjoint(const FrictionProblem& problem, const SweepPlan& plan,
                    const std::vector<SweepPlan::Part>& parts) {
  std::set<int> all;
  size_t sum = 0;
  for (const SweepPlan::Part& part : parts) {
    const std::set<int> bodies = bodies_of(problem, plan, part);
    all.insert(bodies.begin(), bodies.end());
    sum += bodies.size();
  }
  CHECK(all.size() == sum);
}

}  // namespace

TEST_CASE("a sweep's plan: every contact once, and nothing that runs side by side shares a body") {
  SweepPlan plan;
  for (const int bodies : {1, 30, 600, 1200, 4000, 4000}) {
    const FrictionProblem problem =
        bodies < 100 ? make_known_solution({.bodies = bodies, .contacts = bodies}).problem
                     : long_box(bodies, static_cast<std::uint64_t>(bodies));
    CAPTURE(bodies);
    plan.prepare(problem);
    std::vector<int> sorted = plan.contacts();
    std::sort(sorted.begin(), sorted.end());
    for (int c = 0; c < problem.contact_count(); ++c) REQUIRE(sorted[c] == c);
    REQUIRE(sorted.size() == static_cast<size_t>(problem.contact_count()));
    const int slabs = std::max(1, bodies / SweepPlan::slab_bodies);
    CHECK(static_cast<int>(plan.interiors().size()) == slabs);
    CHECK(plan.interfaces().size() + 1 == plan.interiors().size());
    check_disjoint(problem, plan, plan.interiors());
    check_disjoint(problem, plan, plan.interfaces());
    int next = 0;
    for (const auto* parts : {&plan.interiors(), &plan.interfaces()})
      for (const SweepPlan::Part& part : *parts) {
        CHECK(part.begin == next);
        next = part.end;
        for (int i = part.begin; i < part.end; ++i)
          REQUIRE((problem.contact_rows(plan.contacts()[i]) == 1) == (i >= part.friction_end));
      }
    CHECK(next == problem.contact_count());
    std::vector<int> slab_of(problem.dynamics.body_count(), -1);
    for (int slab = 0; slab < slabs; ++slab)
      for (const int body : plan.bodies(slab)) {
        REQUIRE(slab_of[body] == -1);
        slab_of[body] = slab;
      }
    CHECK(std::count(slab_of.begin(), slab_of.end(), -1) == 0);
    for (int slab = 0; slab < slabs; ++slab)
      for (int i = plan.interiors()[slab].begin; i < plan.interiors()[slab].end; ++i)
        for (const int body : {problem.dynamics.body_a[plan.contacts()[i]],
                               problem.dynamics.body_b[plan.contacts()[i]]})
          if (body >= 0) REQUIRE(slab_of[body] == slab);
  }
}

TEST_CASE("a sweep's plan: contacts that open come last, those that open fastest at the end") {
  FrictionProblem problem = long_box(1200, 11);
  Random random(11);
  for (int c = 0; c < problem.contact_count(); ++c)
    problem.dynamics.bias[problem.row_begin[c]] = random.uniform(-2.0, 2.0);
  Eigen::VectorXd u;
  contact_velocity(problem, Impulses::Zero(problem.row_count()), u);
  std::vector<double> opening;
  for (int c = 0; c < problem.contact_count(); ++c)
    opening.push_back(std::max(
        0.0, std::min(u[problem.row_begin[c]], problem.dynamics.bias[problem.row_begin[c]])));
  const double widest = *std::max_element(opening.begin(), opening.end());
  constexpr int none = SweepPlan::gap_octaves;
  SweepPlan plan;
  plan.prepare(problem);
  const auto octave = [&](int i) {
    const double its = opening[plan.contacts()[i]];
    return its > 0.0 ? std::max(-none, std::ilogb(its / widest)) : -none;
  };
  int opened = 0;
  for (const auto* parts : {&plan.interiors(), &plan.interfaces()})
    for (const SweepPlan::Part& part : *parts)
      for (const auto& [begin, end] :
           {std::pair(part.begin, part.friction_end), std::pair(part.friction_end, part.end)})
        for (int i = begin; i < end; ++i) {
          if (i > begin) REQUIRE(octave(i) >= octave(i - 1));
          opened += octave(i) > -none;
        }
  CHECK(opened > problem.contact_count() / 5);
}

TEST_CASE("no contacts, and contacts that nothing moves, have a plan") {
  FrictionProblem problem = make_known_solution({.bodies = 3, .contacts = 2}).problem;
  problem.dynamics.body_a = {-1, -1};
  problem.dynamics.body_b = {-1, -1};
  SweepPlan plan;
  plan.prepare(problem);
  CHECK(plan.contacts().size() == 2);
  problem.clear();
  plan.prepare(problem);
  CHECK(plan.contacts().empty());
}

TEST_CASE("the same bits whatever the number of threads") {
  const FrictionProblem problem = long_box(3000, 3);
  for (const bool accelerated : {false, true}) {
    Impulses first;
    for (const int threads : {1, 2, 3, 7}) {
      const auto solver = accelerated ? make_nncg() : make_gauss_seidel({});
      WorkerTeam team;
      team.resize(threads);
      solver->use_team(&team);
      solver->prepare(problem);
      const Solved solved = solver->solve(problem, Impulses::Zero(problem.row_count()),
                                          {.tolerance = 0.0, .max_iterations = 40});
      if (threads == 1) first = solved.impulses;
      CAPTURE(accelerated, threads);
      CHECK(solved.impulses == first);
    }
  }
}

TEST_CASE("a team does every part once, again and again, and may change its size") {
  WorkerTeam team;
  std::atomic<long> sum{0};
  long expected = 0;
  for (int round = 0; round < 2000; ++round) {
    if (round % 400 == 0) team.resize(1 + (round / 400) % 4);
    const int parts = round % 9;
    team.run(parts, [&](int part) { sum += part + 1; });
    expected += parts * (parts + 1) / 2;
    REQUIRE(sum == expected);
  }
}

#include "solvers/gauss_seidel/sweep_plan.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "platform/random.hpp"
#include "platform/worker_team.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "solvers/backends/backends.hpp"
#include "tests/catch.hpp"
#include "tests/support/solved.hpp"

using namespace ballast;

namespace {

/// A long box of bodies, each in contact with some of those near by: slabs can be cut. Contacts
/// with a fixed wall, and frictionless ones.
FrictionProblem long_box(int bodies, std::uint64_t seed) {
  FrictionProblem problem =
      make_known_solution(
          {.bodies = bodies, .contacts = 3 * bodies, .frictionless_fraction = 0.2, .seed = seed})
          .problem;
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

/// The same with its bodies numbered at random: slabs are not ranges of numbers.
FrictionProblem shuffled(FrictionProblem problem, std::uint64_t seed) {
  Random random(seed);
  std::vector<int> number(problem.dynamics.body_count());
  std::iota(number.begin(), number.end(), 0);
  for (int i = static_cast<int>(number.size()) - 1; i > 0; --i)
    std::swap(number[i], number[random.below(i + 1)]);
  for (auto* side : {&problem.dynamics.body_a, &problem.dynamics.body_b})
    for (int& body : *side)
      if (body >= 0) body = number[body];
  return problem;
}

/// Whether each slab is a range of the bodies' numbers, up to some at its two ends.
bool is_in_order(const SweepPlan& plan) {
  for (int slab = 0; slab < plan.slabs(); ++slab)
    if (const auto bodies = plan.bodies(slab);
        !bodies.empty() && bodies.back() - bodies.front() + 1 > std::ssize(bodies) + 50)
      return false;
  return true;
}

/// No body is met by two of the parts.
void check_disjoint(const FrictionProblem& problem, const SweepPlan& plan,
                    std::span<const SweepPlan::Part> parts) {
  std::map<int, size_t> part_of;
  for (size_t k = 0; k < parts.size(); ++k)
    for (int i = parts[k].begin; i < parts[k].end; ++i)
      for (const auto* side : {&problem.dynamics.body_a, &problem.dynamics.body_b})
        if (const int body = (*side)[plan.contacts()[i]]; body >= 0)
          REQUIRE(part_of.emplace(body, k).first->second == k);
}

struct Graph {
  std::vector<int> a, b, contacts;
  int bodies;

  Graph(int body_count, int count, std::uint64_t seed) : bodies(body_count) {
    Random random(seed);
    for (int c = 0; c < count; ++c) {
      a.push_back(random.below(bodies + 1) - 1);
      b.push_back(random.below(bodies + 1) - 1);
      if (a[c] == b[c]) b[c] = -1;
    }
    contacts.resize(count);
    std::iota(contacts.begin(), contacts.end(), 0);
    for (int i = count - 1; i > 0; --i) std::swap(contacts[i], contacts[random.below(i + 1)]);
  }
};

/// First fit, by asking every group.
std::vector<std::vector<int>> slowly(const Graph& graph) {
  std::vector<std::vector<int>> groups;
  std::map<int, int> last;
  for (const int c : graph.contacts) {
    int group = 0;
    for (const int body : {graph.a[c], graph.b[c]})
      if (body >= 0 && last.count(body)) group = std::max(group, last[body] + 1);
    while (group < static_cast<int>(groups.size()) && groups[group].size() == group_lanes) ++group;
    if (group == static_cast<int>(groups.size())) groups.emplace_back();
    groups[group].push_back(c);
    for (const int body : {graph.a[c], graph.b[c]})
      if (body >= 0) last[body] = group;
  }
  return groups;
}

}  // namespace

TEST_CASE("a sweep's plan: every contact once, and nothing that runs side by side shares a body") {
  SweepPlan plan;
  for (const auto& [bodies, in_order] : {std::pair(1, true),
                                         {30, true},
                                         {600, true},
                                         {1200, true},
                                         {4000, true},
                                         {1200, false},
                                         {4000, false},
                                         {4000, false}}) {
    FrictionProblem problem =
        bodies < 100 ? make_known_solution({.bodies = bodies, .contacts = bodies}).problem
                     : long_box(bodies, static_cast<std::uint64_t>(bodies));
    if (!in_order) problem = shuffled(std::move(problem), 4);
    CAPTURE(bodies, in_order);
    plan.prepare(problem);
    CHECK(is_in_order(plan) == in_order);
    std::vector<int> sorted = plan.contacts();
    std::sort(sorted.begin(), sorted.end());
    for (int c = 0; c < problem.contact_count(); ++c) REQUIRE(sorted[c] == c);
    REQUIRE(sorted.size() == static_cast<size_t>(problem.contact_count()));
    const int slabs = std::max(1, bodies / SweepPlan::slab_bodies);
    CHECK(plan.slabs() == slabs);
    const std::span parts(plan.parts());
    CHECK(static_cast<int>(parts.size()) == 2 * slabs - 1);
    check_disjoint(problem, plan, parts.first(slabs));
    check_disjoint(problem, plan, parts.subspan(slabs));
    int next = 0;
    for (const SweepPlan::Part& part : parts) {
      CHECK(part.begin == next);
      next = part.end;
      for (int i = part.begin; i < part.end; ++i)
        REQUIRE((problem.contact_rows(plan.contacts()[i]) == 1) == (i >= part.friction_end));
    }
    CHECK(next == problem.contact_count());
    // Every body is in one slab, and contacts within it are between its bodies.
    std::vector<int> slab_of(problem.dynamics.body_count(), -1);
    for (int slab = 0; slab < slabs; ++slab)
      for (const int body : plan.bodies(slab)) {
        REQUIRE(slab_of[body] == -1);
        slab_of[body] = slab;
      }
    CHECK(std::count(slab_of.begin(), slab_of.end(), -1) == 0);
    for (int slab = 0; slab < slabs; ++slab)
      for (int i = parts[slab].begin; i < parts[slab].end; ++i)
        for (const auto* side : {&problem.dynamics.body_a, &problem.dynamics.body_b})
          if (const int body = (*side)[plan.contacts()[i]]; body >= 0)
            REQUIRE(slab_of[body] == slab);
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
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int row = problem.row_begin[c];
    opening.push_back(std::max(0.0, std::min(u[row], problem.dynamics.bias[row])));
  }
  const double widest = *std::max_element(opening.begin(), opening.end());
  constexpr int none = SweepPlan::gap_octaves;
  SweepPlan plan;
  plan.prepare(problem);
  const auto octave = [&](int i) {
    const double its = opening[plan.contacts()[i]];
    return its > 0.0 ? std::max(-none, std::ilogb(its / widest)) : -none;
  };
  int opened = 0;
  for (const SweepPlan::Part& part : plan.parts())
    for (int i = part.begin; i < part.end; ++i) {
      if (i != part.begin && i != part.friction_end) REQUIRE(octave(i) >= octave(i - 1));
      opened += octave(i) > -none;
    }
  CHECK(opened > problem.contact_count() / 5);
}

TEST_CASE("no contact joins other slabs than neighbours, and no body meets two interfaces") {
  const FrictionProblem problem = long_box(2000, 7);  // four slabs
  SweepPlan plan;
  plan.prepare(problem);
  REQUIRE(is_in_order(plan));
  REQUIRE(plan.slabs() == 4);
  const int first = plan.bodies(1).front(), second = plan.bodies(2).front();
  const int before = first - 200, middle = first + 200, after = second + 200;
  using Contacts = std::vector<std::pair<int, int>>;
  // one contact more over a cut, one over two cuts, two over two cuts that meet in a body
  for (const Contacts& contacts :
       {Contacts{{before, middle}}, {{before, after}}, {{before, middle}, {middle, after}}}) {
    FrictionProblem changed = problem;
    int c = 0;
    for (const auto& [a, b] : contacts) {
      changed.dynamics.body_a[c] = a;
      changed.dynamics.body_b[c++] = b;
    }
    plan.prepare(changed);
    CHECK(plan.slabs() >= 3);
    const std::span parts(plan.parts());
    check_disjoint(changed, plan, parts.first(plan.slabs()));
    check_disjoint(changed, plan, parts.subspan(plan.slabs()));
  }
}

TEST_CASE("a body that was numbered elsewhere comes to its neighbours' slab") {
  FrictionProblem problem = long_box(1200, 5);
  const auto swap_numbers = [&](int here, int there) {
    for (auto* side : {&problem.dynamics.body_a, &problem.dynamics.body_b})
      for (int& body : *side) body = body == here ? there : body == there ? here : body;
  };
  for (int here = 50; here < 450; here += 40) swap_numbers(here, here + 700);
  SweepPlan plan;
  plan.prepare(problem);
  REQUIRE(plan.slabs() == 2);
  for (int here = 50; here < 450; here += 40) {
    CHECK(std::ranges::binary_search(plan.bodies(0), here + 700));
    CHECK(std::ranges::binary_search(plan.bodies(1), here));
  }
}

TEST_CASE("each member has neighbouring slabs with about as many contacts as the others") {
  // A third of the bodies are in a crowd that cannot be cut finely, at the end of a long box.
  FrictionProblem problem = long_box(9000, 6);
  Random random(6);
  DynamicsForm& d = problem.dynamics;
  for (int c = 0; c < problem.contact_count(); ++c)
    if (d.body_a[c] >= 6000 && d.body_b[c] >= 6000)
      d.body_b[c] = 6000 + random.below(d.body_a[c] - 5999);
  for (int c = 0; c < problem.contact_count(); ++c)
    if (d.body_a[c] == d.body_b[c]) d.body_b[c] = -1;
  problem = shuffled(std::move(problem), 6);
  for (const int members : {1, 2, 3}) {
    WorkerTeam team;
    team.resize(members);
    SweepPlan plan;
    plan.use_team(&team);
    plan.prepare(problem);
    const auto contacts_of = [&](int slab) {
      return plan.parts()[slab].end - plan.parts()[slab].begin;
    };
    const std::vector<int>& edges = plan.edges();
    REQUIRE(edges.front() == 0);
    REQUIRE(edges.back() == plan.slabs());
    const int ranges = static_cast<int>(edges.size() - 1) / members;
    int passed = 0, most = 0, largest = 0, all = 0;
    std::vector<int> until{0};  // contacts of the first slabs
    for (int slab = 0; slab < plan.slabs(); ++slab) {
      until.push_back(all += contacts_of(slab));
      largest = std::max(largest, contacts_of(slab));
    }
    for (int member = 0; member < members; ++member) {
      const int now = until[edges[(member + 1) * ranges]];
      most = std::max(most, now - std::exchange(passed, now));
    }
    CAPTURE(members, plan.slabs(), largest, all, most);
    CHECK(passed == all);
    CHECK(largest > 2 * all / plan.slabs());
    // No other cut into two is much better, interfaces aside.
    for (const int cut : until)
      if (members == 2) CHECK(most <= 1.05 * std::max(cut, all - cut));
    std::atomic<int> slabs = 0;
    plan.for_slabs([&](int begin, int end) { slabs += end - begin; });
    CHECK(slabs == plan.slabs());
  }
}

TEST_CASE("a last slab without contacts is some member's") {
  FrictionProblem problem = make_known_solution({.bodies = 1200, .contacts = 1}).problem;
  problem.dynamics.body_a = {3};
  problem.dynamics.body_b = {4};
  for (const int members : {1, 2}) {
    WorkerTeam team;
    team.resize(members);
    SweepPlan plan;
    plan.use_team(&team);
    plan.prepare(problem);
    REQUIRE(plan.slabs() == 2);
    REQUIRE(plan.parts()[1].begin == plan.parts()[1].end);
    CHECK(plan.edges().back() == 2);
  }
}

TEST_CASE("no contacts, and contacts that nothing moves, have a plan") {
  FrictionProblem problem = make_known_solution({.bodies = 3, .contacts = 2}).problem;
  problem.dynamics.body_a = {-1, -1};
  problem.dynamics.body_b = {-1, -1};
  SweepPlan plan;
  plan.prepare(problem);
  CHECK(plan.contacts().size() == 2);
  problem.clear_contacts();
  plan.prepare(problem);
  CHECK(plan.contacts().empty());
}

TEST_CASE("the same bits whatever the number of threads") {
  const FrictionProblem problem = long_box(3000, 3);
  for (const bool accelerated : {false, true}) {
    Impulses first;
    for (const int threads : {1, 2, 3, 7}) {
      const auto solver = accelerated ? make_nncg() : make_gauss_seidel();
      WorkerTeam team;
      team.resize(threads);
      solver->use_team(&team);
      const Solved solved = from_rest(*solver, problem, {.tolerance = 0.0, .max_iterations = 40});
      if (threads == 1) first = solved.impulses;
      CAPTURE(accelerated, threads);
      CHECK(solved.impulses == first);
    }
  }
}

TEST_CASE("groups are the first fit: no body twice in one, and every body's contacts in order") {
  for (const int bodies : {3, 40, 400}) {
    const Graph graph(bodies, 1000, bodies);
    ContactGroups groups;
    std::vector<int> a, b;
    for (const int c : graph.contacts) {
      a.push_back(graph.a[c]);
      b.push_back(graph.b[c]);
    }
    groups.make(graph.contacts, a, b, graph.bodies);
    const auto expected = slowly(graph);
    REQUIRE(groups.count() == static_cast<int>(expected.size()));
    std::map<int, std::vector<int>> met;  // contacts of each body, as the groups have them
    for (int g = 0; g < groups.count(); ++g) {
      std::set<int> bodies_here;
      for (int lane = 0; lane < group_lanes; ++lane) {
        const int c = groups.lanes(g)[lane];
        const bool filled = lane < static_cast<int>(expected[g].size());
        REQUIRE(c == (filled ? expected[g][lane] : -1));
        if (!filled) continue;
        for (const int body : {graph.a[c], graph.b[c]}) {
          if (body < 0) continue;
          REQUIRE(bodies_here.insert(body).second);
          met[body].push_back(c);
        }
      }
    }
    std::map<int, std::vector<int>> given;
    for (const int c : graph.contacts)
      for (const int body : {graph.a[c], graph.b[c]})
        if (body >= 0) given[body].push_back(c);
    CHECK(met == given);
  }
}

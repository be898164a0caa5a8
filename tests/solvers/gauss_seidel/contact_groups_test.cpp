#include "solvers/gauss_seidel/contact_groups.hpp"

#include <map>
#include <numeric>
#include <set>

#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

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

TEST_CASE("groups are the first fit: no body twice in one, and every body's contacts in order") {
  for (const int bodies : {3, 40, 400}) {
    const Graph graph(bodies, 1000, bodies);
    ContactGroups groups;
    groups.begin(graph.bodies);
    groups.add(graph.contacts, graph.a, graph.b);
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

TEST_CASE("what is added later stands in later groups") {
  const std::vector<int> a{0, 1, 2}, b{-1, -1, -1}, first{0}, second{1, 2};
  ContactGroups groups;
  groups.begin(3);
  groups.add(first, a, b);
  groups.add(second, a, b);
  REQUIRE(groups.count() == 2);
  CHECK(groups.lanes(0)[0] == 0);
  CHECK(groups.lanes(0)[1] == -1);
  CHECK(groups.lanes(1)[0] == 1);
  CHECK(groups.lanes(1)[1] == 2);
}

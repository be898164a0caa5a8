#include "experiments/compare/compare_diff.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "experiments/compare/stored_comparison.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

/// The repeats of one solve on one side.
struct Repeats {
  std::string case_name;
  std::vector<double> seconds;  ///< of those that are solved, sorted
  bool solved = true;           ///< every one of them
  double median() const { return solved ? seconds[seconds.size() / 2] : 0.0; }
  double spread() const {
    return solved && seconds.front() > 0.0 ? seconds.back() / seconds.front() : 1.0;
  }
};

std::map<SolveIdentity, Repeats> grouped(std::span<const CompareRow> rows) {
  std::map<SolveIdentity, Repeats> groups;
  for (const CompareRow& row : rows) {
    if (row.verdict == Verdict::unreadable) continue;  // no backend was tried
    Repeats& repeats = groups[identity_of(row)];
    repeats.case_name = row.case_name;
    // The median tells solved from unsolved: no time is 0.
    repeats.seconds.push_back(std::max(row.seconds(), 1e-9));
    repeats.solved = repeats.solved && row.verdict == Verdict::solved;
  }
  for (auto& [identity, repeats] : groups)
    std::sort(repeats.seconds.begin(), repeats.seconds.end());
  return groups;
}

Change change_of(const ChangedSolve& solve, double least) {
  if (solve.before == 0.0 && solve.after == 0.0) return Change::same;
  if (solve.after == 0.0) return Change::lost;
  if (solve.before == 0.0) return Change::gained;
  const double ratio = solve.after / solve.before, bound = std::max(least, solve.spread);
  return ratio > bound ? Change::slower : ratio * bound < 1.0 ? Change::faster : Change::same;
}

int rank_of(Change change) { return change == Change::lost ? 0 : change == Change::slower ? 1 : 2; }

}  // namespace

const char* name_of(Change change) {
  static constexpr const char* names[] = {"same",   "faster",      "slower",    "lost",
                                          "gained", "only before", "only after"};
  return name_in(names, change);
}

std::vector<ChangedSolve> compare_diff(std::span<const CompareRow> before,
                                       std::span<const CompareRow> after, double least) {
  const std::map<SolveIdentity, Repeats> old_groups = grouped(before), new_groups = grouped(after);
  std::vector<ChangedSolve> changes;
  const auto add = [&](const SolveIdentity& identity, const Repeats* was, const Repeats* is) {
    ChangedSolve solve;
    solve.case_name = (was ? was : is)->case_name;
    solve.solver = std::get<1>(identity);
    solve.tolerance = std::get<2>(identity);
    solve.start = std::get<3>(identity);
    if (was) solve.before = was->median();
    if (is) solve.after = is->median();
    if (was && is) {
      solve.spread = std::max(was->spread(), is->spread());
      solve.change = change_of(solve, least);
    } else {
      solve.change = was ? Change::only_before : Change::only_after;
    }
    changes.push_back(solve);
  };
  for (const auto& [identity, was] : old_groups) {
    const auto is = new_groups.find(identity);
    add(identity, &was, is == new_groups.end() ? nullptr : &is->second);
  }
  for (const auto& [identity, is] : new_groups)
    if (!old_groups.contains(identity)) add(identity, nullptr, &is);
  std::stable_sort(changes.begin(), changes.end(), [](const auto& a, const auto& b) {
    return std::tuple(rank_of(a.change), a.case_name, a.solver) <
           std::tuple(rank_of(b.change), b.case_name, b.solver);
  });
  return changes;
}

}  // namespace ballast

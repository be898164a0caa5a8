#include "experiments/compare/stored_comparison.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

#include "experiments/compare/compare_page.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// Rows of equal identity are the same solve.
using SolveIdentity = std::tuple<std::string, std::string, double, StartKind, Measure>;
SolveIdentity identity_of(const CompareRow& row) {
  return {row.facts.content, row.solver, row.tolerance, row.start, row.measure};
}

std::string machine_name(size_t place) { return "M" + std::to_string(place + 1); }

Change change_of(const ChangedSolve& solve, double least) {
  if (solve.before == 0.0 && solve.after == 0.0) return Change::same;
  if (solve.after == 0.0) return Change::lost;
  if (solve.before == 0.0) return Change::gained;
  const double ratio = solve.after / solve.before, bound = std::max(least, solve.spread);
  return ratio > bound ? Change::slower : ratio * bound < 1.0 ? Change::faster : Change::same;
}

}  // namespace

StoredComparison read_comparison(const fs::path& folder) {
  if (!is_folder(folder / "rows"))
    throw Error(folder.string() + ": no folder of a comparison: it has no rows");
  const Manifest manifest = Manifest::read(folder / "manifest.json");
  StoredComparison stored{folder, manifest.machine(), manifest.commit(), manifest.started(), {}};
  // rows/ also holds files of older builds and of other limits, so results.csv selects the rows.
  CsvReader table(folder / "results.csv");
  const std::vector<std::string> columns = compare_columns();
  while (table.next()) {
    table.require_cells(columns.size());
    const std::string& key = table.cells().back();
    if (key.empty() || key == columns.back()) continue;  // an unreadable case; the head
    const fs::path file = folder / "rows" / (key + ".json");
    stored.rows.push_back(compare_row_of_json(read_whole_file(file), file.string()));
  }
  std::ranges::sort(stored.rows, {}, [](const CompareRow& row) {
    return std::tie(row.case_name, row.solver, row.tolerance, row.start, row.repeat, row.key);
  });
  return stored;
}

MergedComparison merged(std::vector<StoredComparison> comparisons) {
  std::ranges::stable_sort(comparisons, {}, &StoredComparison::started);
  MergedComparison all;
  for (const StoredComparison& c : comparisons)
    if (std::ranges::find(all.machines, c.machine) == all.machines.end())
      all.machines.push_back(c.machine);
  std::map<std::string, std::string> names;  // of problems by content, all different
  std::set<std::string> taken;
  for (size_t m = 0; m < all.machines.size(); ++m) {
    const std::string mark = all.machines.size() > 1 ? machine_name(m) : "";
    std::map<SolveIdentity, const StoredComparison*> newest;
    for (const StoredComparison& c : comparisons)
      if (c.machine == all.machines[m])
        for (const CompareRow& row : c.rows) newest[identity_of(row)] = &c;
    for (const StoredComparison& c : comparisons) {
      if (c.machine != all.machines[m]) continue;
      for (CompareRow row : c.rows) {
        if (row.verdict == Verdict::unreadable || newest[identity_of(row)] != &c) continue;
        if (!all.rows.empty() && row.measure != all.rows.front().measure)
          throw Error(std::string("some comparisons are of the measure ") +
                      name_of(all.rows.front().measure) + ", others of " + name_of(row.measure) +
                      ": their tolerances bound different things");
        const auto [name, is_new] = names.try_emplace(row.facts.content, row.case_name);
        for (int count = 2; is_new && !taken.insert(name->second).second; ++count)
          name->second = row.case_name + " (" + std::to_string(count) + ")";
        row.word = row.case_name;
        row.case_name = (mark.empty() ? "" : mark + " · ") + name->second;
        row.key = mark + row.key;
        all.rows.push_back(std::move(row));
      }
    }
  }
  return all;
}

std::vector<CompareRow> write_origins(const fs::path& folder,
                                      const std::vector<StoredComparison>& comparisons,
                                      const std::string& command) {
  MergedComparison all = merged(comparisons);
  if (all.rows.empty()) throw Error("compare: the comparisons have no rows");
  Manifest manifest("compare merge", {command}, "");
  for (const StoredComparison& c : comparisons) {
    const auto m = std::ranges::find(all.machines, c.machine) - all.machines.begin();
    manifest.summary(c.folder.string(), machine_name(static_cast<size_t>(m)) + ": " + c.machine +
                                            "; " + c.program + "; " + c.started);
  }
  create_folder(folder);
  manifest.write(folder / "manifest.json");
  return std::move(all.rows);
}

void write_merged(const fs::path& folder, std::span<const CompareRow> rows) {
  write_whole_file(folder / "results.csv", compare_csv(rows));
  write_compare_page(folder, rows);
}

const char* name_of(Change change) {
  static constexpr const char* names[] = {"same",   "faster",      "slower",    "lost",
                                          "gained", "only before", "only after"};
  return name_in(names, change);
}

std::vector<ChangedSolve> compare_diff(std::span<const CompareRow> before,
                                       std::span<const CompareRow> after, double least) {
  std::map<SolveIdentity, std::array<std::vector<const CompareRow*>, 2>> solves;
  for (const size_t side : {0, 1})
    for (const CompareRow& row : side == 0 ? before : after)
      if (row.verdict != Verdict::unreadable) solves[identity_of(row)][side].push_back(&row);
  std::vector<ChangedSolve> changes;
  for (const auto& [identity, sides] : solves) {
    ChangedSolve& solve =
        changes.emplace_back(ChangedSolve{(sides[0].empty() ? sides[1] : sides[0]).front()});
    for (const size_t side : {0, 1}) {
      if (sides[side].empty()) continue;
      const RepeatedSolve repeats = over_repeats(sides[side]);
      // 0 stands for unsolved, so no time of a solved case is 0
      (side == 0 ? solve.before : solve.after) =
          repeats.solved ? std::max(repeats.median, 1e-9) : 0.0;
      if (repeats.fastest > 0.0)
        solve.spread = std::max(solve.spread, repeats.slowest / repeats.fastest);
    }
    solve.change = sides[0].empty()   ? Change::only_after
                   : sides[1].empty() ? Change::only_before
                                      : change_of(solve, least);
  }
  std::ranges::stable_sort(changes, {}, [](const ChangedSolve& solve) {
    return std::tuple(solve.change != Change::lost, solve.change != Change::slower,
                      solve.row->case_name, solve.row->solver);
  });
  return changes;
}

}  // namespace ballast

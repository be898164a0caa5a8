#include "experiments/compare/stored_comparison.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "experiments/compare/compare_page.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// Names of problems by what they hold, each another.
class ProblemNames {
 public:
  const std::string& of(const CompareRow& row) {
    const auto [found, is_new] = names_.try_emplace(row.facts.content, row.case_name);
    if (!is_new) return found->second;
    for (int count = 2; !taken_.insert(found->second).second; ++count)
      found->second = row.case_name + " (" + std::to_string(count) + ")";
    return found->second;
  }

 private:
  std::map<std::string, std::string> names_;
  std::set<std::string> taken_;
};

std::string machine_name(size_t place) { return "M" + std::to_string(place + 1); }

}  // namespace

SolveIdentity identity_of(const CompareRow& row) {
  return {row.facts.content, row.solver, row.tolerance, row.start, row.measure};
}

StoredComparison read_comparison(const fs::path& folder) {
  if (!is_folder(folder / "rows"))
    throw Error(folder.string() + ": no folder of a comparison: it has no rows");
  const Manifest manifest = Manifest::read(folder / "manifest.json");
  StoredComparison stored{folder, manifest.machine(), manifest.commit(), manifest.started(), {}};
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "rows"))
    if (entry.path().extension() == ".json")
      stored.rows.push_back(
          compare_row_of_json(read_whole_file(entry.path()), entry.path().string()));
  // A folder lists its files in any order.
  const auto place = [](const CompareRow& row) {
    return std::tie(row.case_name, row.solver, row.tolerance, row.start, row.repeat, row.key);
  };
  std::sort(stored.rows.begin(), stored.rows.end(),
            [&](const CompareRow& a, const CompareRow& b) { return place(a) < place(b); });
  return stored;
}

MergedComparison merged(std::vector<StoredComparison> comparisons) {
  std::ranges::stable_sort(comparisons, {}, &StoredComparison::started);
  MergedComparison all;
  for (const StoredComparison& c : comparisons)
    if (std::ranges::find(all.machines, c.machine) == all.machines.end())
      all.machines.push_back(c.machine);
  ProblemNames names;
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
        row.word = row.case_name;
        row.case_name = (mark.empty() ? "" : mark + " · ") + names.of(row);
        row.key = mark + row.key;
        all.rows.push_back(std::move(row));
      }
    }
  }
  return all;
}

size_t write_merged(const fs::path& folder, const std::vector<StoredComparison>& comparisons,
                    const std::string& command) {
  const MergedComparison all = merged(comparisons);
  if (all.rows.empty()) throw Error("compare merge: the comparisons have no rows");
  Manifest manifest("compare merge", {command}, "");
  for (const StoredComparison& c : comparisons) {
    const auto m = std::ranges::find(all.machines, c.machine) - all.machines.begin();
    manifest.summary(c.folder.string(), machine_name(static_cast<size_t>(m)) + ": " + c.machine +
                                            "; " + c.program + "; " + c.started);
  }
  create_folder(folder);
  write_whole_file(folder / "results.csv", compare_csv(all.rows));
  manifest.write(folder / "manifest.json");
  write_compare_page(folder, all.rows);
  return all.rows.size();
}

}  // namespace ballast

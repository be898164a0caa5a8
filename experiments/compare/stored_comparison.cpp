#include "experiments/compare/stored_comparison.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "experiments/run/manifest.hpp"
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

std::vector<MachineRows> merged_machines(std::span<const StoredComparison> comparisons) {
  std::vector<size_t> order(comparisons.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return comparisons[a].started < comparisons[b].started;
  });
  std::vector<MachineRows> machines;
  for (const size_t k : order) {
    const auto same = [&](const MachineRows& m) { return m.machine == comparisons[k].machine; };
    auto found = std::find_if(machines.begin(), machines.end(), same);
    if (found == machines.end())
      found = machines.insert(machines.end(), {comparisons[k].machine, {}, {}});
    found->sources.push_back(k);
  }
  ProblemNames names;
  for (MachineRows& machine : machines) {
    // The newest comparison that holds a solve has the last word.
    std::map<SolveIdentity, size_t> newest;
    for (const size_t k : machine.sources)
      for (const CompareRow& row : comparisons[k].rows) newest[identity_of(row)] = k;
    for (const size_t k : machine.sources)
      for (const CompareRow& row : comparisons[k].rows) {
        if (row.verdict == Verdict::unreadable || newest[identity_of(row)] != k) continue;
        machine.rows.push_back(row);
        machine.rows.back().case_name = names.of(row);
      }
  }
  return machines;
}

std::vector<CompareRow> pooled_rows(std::span<const MachineRows> machines) {
  std::vector<CompareRow> rows;
  for (size_t m = 0; m < machines.size(); ++m)
    for (CompareRow row : machines[m].rows) {
      if (!rows.empty() && row.measure != rows.front().measure)
        throw Error(std::string("some comparisons are of the measure ") +
                    name_of(rows.front().measure) + ", others of " + name_of(row.measure) +
                    ": their tolerances bound different things");
      row.case_name = "M" + std::to_string(m + 1) + " · " + row.case_name;
      rows.push_back(std::move(row));
    }
  return rows;
}

}  // namespace ballast

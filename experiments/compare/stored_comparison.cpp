#include "experiments/compare/stored_comparison.hpp"

#include <algorithm>

#include "experiments/run/manifest.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast {
namespace fs = std::filesystem;

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

}  // namespace ballast

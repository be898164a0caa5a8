// `ballast compare merge`: comparisons of several machines and days as one site.

#include <iostream>
#include <memory>

#include "experiments/commands/command.hpp"
#include "experiments/compare/comparison_site.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast {
namespace {

struct MergeOptions {
  std::vector<std::string> folders;
  std::filesystem::path output = "results/site";
};

ExitCode merge(const MergeOptions& options) {
  require_own_folder(options.output, {"machines"});
  std::vector<StoredComparison> comparisons;
  size_t rows = 0;
  for (const std::string& folder : options.folders) {
    comparisons.push_back(read_comparison(folder));
    rows += comparisons.back().rows.size();
  }
  if (rows == 0) throw Error("compare merge: the comparisons have no rows");
  write_comparison_site(options.output, comparisons, own_command());
  std::cout << comparisons.size() << " comparisons, " << rows
            << " rows: " << (options.output / "index.html").string() << std::endl;
  return ExitCode::ok;
}

}  // namespace

Command compare_merge_command() {
  const auto options = std::make_shared<MergeOptions>();
  return {"merge",
          "Comparisons of several machines, commits, days as one site; ratios within a machine",
          {{"folders", &options->folders, "Folders of comparisons", required},
           {"--output DIR", &options->output, "Folder of the site: any web host serves it", shown}},
          [options] { return merge(*options); }};
}

}  // namespace ballast

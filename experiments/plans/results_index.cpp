#include "experiments/plans/results_index.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "experiments/run/manifest.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

fs::path plans_folder(const fs::path& results) { return results / "plans"; }

/// Empty where nothing is known.
std::string number_text(double x) {
  if (std::isnan(x)) return "";
  return printed("%.6g", x);
}

struct Facts {
  std::string state = "waiting", seconds, error, commit;
  long steps_done = 0;
};

/// What the run's folder says of it.
Facts facts_of(const fs::path& path, const std::string& key, long steps, bool failed) {
  Facts facts;
  const RunFolder folder(path);
  if (failed) facts.state = "failed";
  if (!folder.has_run()) return facts;
  if (!failed) facts.state = "begun";
  facts.steps_done = std::min(steps, steps_in_log(path));
  try {
    const Manifest manifest = Manifest::read(folder.manifest());
    if (folder.is_finished(key)) {
      facts.state = "finished";
      facts.steps_done = steps;
    }
    facts.seconds = number_text(manifest.summary_number("drive_seconds"));
    facts.error = number_text(manifest.summary_number("error_mean_relative"));
    facts.commit = manifest.commit();
  } catch (const Error&) {  // not written yet, or damaged: the run itself will say so
  }
  return facts;
}

/// The rows of one plan.
void add_rows(CsvWriter& csv, const fs::path& results, const fs::path& file,
              const std::map<std::string, std::string>& failed) {
  try {
    const Json plan = Json::parse(read_whole_file(file));
    for (const Json& run : plan.at("runs")) {
      const std::string key = run.at("key");
      const long steps = run.at("steps");
      const Facts facts = facts_of(results / "runs" / key, key, steps, failed.contains(key));
      csv.add_row(std::vector<std::string>{plan.at("plan"), run.at("name"), key, facts.state,
                                           std::to_string(facts.steps_done), std::to_string(steps),
                                           facts.seconds, facts.error, facts.commit});
    }
  } catch (const Json::exception&) {
    throw Error(file.string() + ": is no plan that ballast noted: " + broken_json);
  }
}

}  // namespace

void note_plan(const fs::path& results, const std::string& plan,
               const std::vector<ResolvedRun>& runs) {
  Json list = Json::array();
  for (const ResolvedRun& run : runs)
    list.push_back({{"name", run.run.name},
                    {"key", run.key},
                    {"packing", run.packing},
                    {"steps", run.steps},
                    {"scene", run.run.scene},
                    {"overrides", run.run.overrides}});
  create_folder(plans_folder(results));
  const Json text{{"plan", plan}, {"runs", std::move(list)}};
  write_whole_file(plans_folder(results) / (plan + ".json"),
                   text.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void write_index(const fs::path& results, const std::map<std::string, std::string>& failed) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(plans_folder(results)))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  CsvWriter csv;
  csv.add_row(std::vector<std::string>{"plan", "name", "key", "state", "steps_done", "steps",
                                       "seconds", "error_mean", "commit"});
  // Plans may share a folder: all that were ever run there are in the one table.
  for (const fs::path& file : files) add_rows(csv, results, file, failed);
  write_whole_file(results / "index.csv", csv.take());
}

}  // namespace ballast

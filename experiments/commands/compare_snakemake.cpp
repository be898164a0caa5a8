#include "experiments/commands/compare_snakemake.hpp"

#include <set>

#include <nlohmann/json.hpp>

#include "experiments/compare/compare_case.hpp"
#include "experiments/plans/snakemake.hpp"
#include "platform/atomic_file.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {

std::string cluster_file(const std::string& name);  // of experiments/plans/cluster

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Jobs begin in another folder.
std::string absolute_word(const std::string& word) {
  return is_made_case(word) ? word : fs::absolute(word).lexically_normal().string();
}

Json arguments(const ComparisonPlan& plan, const std::vector<std::string>& cases,
               const std::string& solvers, const fs::path& results) {
  Json words = {"compare"};
  for (const std::string& word : cases) words.push_back(absolute_word(word));
  for (const std::string& word : plan.options) words.push_back(word);
  for (const std::string& word :
       {std::string("--solvers"), solvers, std::string("--output"), results.string()})
    words.push_back(word);
  return words;
}

}  // namespace

void write_compare_snakemake(const ComparisonPlan& plan, const fs::path& folder_given) {
  const fs::path folder = fs::absolute(folder_given).lexically_normal(),
                 results = fs::absolute(plan.results).lexically_normal();
  write_slurm_profile(folder);
  for (const char* name : {"rows", "logs", "snakemake"}) create_folder(results / name);
  // One word may be many cases; a word of one case names it alone.
  std::set<std::string> words;
  for (const CompareCase& c : compare_cases(plan.cases)) words.insert(c.word);
  std::string all_solvers;
  for (const std::string& solver : plan.solvers)
    all_solvers += (all_solvers.empty() ? "" : ",") + solver;
  Json jobs = Json::object();
  size_t count = 0;
  for (const std::string& word : words) {
    ++count;
    for (const std::string& solver : plan.solvers) {
      Json job = arguments(plan, {word}, solver, results);
      job.push_back("--part");
      jobs[printed("case%zu-%s", count, solver.c_str())] = job;
    }
  }
  const Json all = {{"program", own_program().string()},
                    {"results", results.string()},
                    {"finish", arguments(plan, plan.cases, all_solvers, results)},
                    {"jobs", jobs}};
  write_whole_file(folder / "jobs.json",
                   all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  write_whole_file(folder / "Snakefile", cluster_file("compare.smk"));
}

}  // namespace ballast

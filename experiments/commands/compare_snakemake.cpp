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

std::string absolute_word(const std::string& word) {
  return is_made_case(word) ? word : fs::absolute(word).lexically_normal().string();
}

Json arguments(const ComparisonPlan& plan, const std::vector<std::string>& cases,
               const std::string& solvers, const std::vector<std::string>& external) {
  Json words = {"compare"};
  for (const std::string& word : cases) words.push_back(absolute_word(word));
  for (const std::string& word : plan.options) words.push_back(word);
  for (const std::string& word : {std::string("--solvers"), solvers, std::string("--output"),
                                  fs::absolute(plan.results).lexically_normal().string()})
    words.push_back(word);
  if (!external.empty()) words.push_back("--external");
  for (const std::string& word : external) words.push_back(word);
  return words;
}

Json part(Json arguments) {
  arguments.push_back("--part");
  return arguments;
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
  Json jobs = Json::object();
  size_t count = 0;
  for (const std::string& word : words) {
    const std::string name = printed("case%zu-", ++count);
    for (const std::string& solver : plan.solvers)
      jobs[name + solver] = part(arguments(plan, {word}, solver, {}));
    // A name that no backend has.
    if (!plan.external.empty())
      jobs[name + "external"] = part(arguments(plan, {word}, "none", plan.external));
  }
  std::string all_solvers;
  for (const std::string& solver : plan.solvers)
    all_solvers += (all_solvers.empty() ? "" : ",") + solver;
  Json finish =
      arguments(plan, plan.cases, all_solvers.empty() ? "none" : all_solvers, plan.external);
  for (const std::string& word : plan.finish) finish.push_back(word);
  const Json all = {{"program", own_program().string()},
                    {"folder", fs::current_path().string()},
                    {"results", results.string()},
                    {"finish", finish},
                    {"jobs", jobs}};
  write_whole_file(folder / "jobs.json",
                   all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  write_whole_file(folder / "Snakefile", cluster_file("compare.smk"));
}

}  // namespace ballast

#include "experiments/compare/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "experiments/measure/curve_fit.hpp"
#include "platform/random.hpp"

namespace ballast {
namespace {

using Eigen::VectorXd;
using Weights = std::map<std::string, double>;  ///< by run

/// The weighted mean of each backend over `members`, of which some run has a weight > 0.
VectorXd means_of(const TriedCases& tried, const std::vector<Eigen::Index>& members,
                  const Weights& weights) {
  VectorXd sum = VectorXd::Zero(tried.log_seconds.cols());
  double total = 0.0;
  for (const Eigen::Index c : members) {
    const double weight = weights.at(run_of(tried.cases[static_cast<size_t>(c)]->case_name));
    sum += weight * tried.log_seconds.row(c).transpose();
    total += weight;
  }
  return sum / total;
}

}  // namespace

std::string base_family(const CompareRow& row) {
  return row.family.substr(0, row.family.find(", "));
}

std::string run_of(const std::string& case_name) {
  return case_name.substr(0, case_name.rfind("step_"));
}

std::vector<TriedCases> tried_cases(std::span<const CompareRow> rows, double shift) {
  const double limit = limit_of(rows);
  std::vector<TriedCases> result;
  for (CompareTable& table : compare_tables(rows)) {
    TriedCases& tried = result.emplace_back(TriedCases{table.start, table.tolerance, {}, {}, {}});
    for (const BackendSummary& s : table.backends) tried.solvers.push_back(s.solver);
    std::ranges::sort(tried.solvers);
    const size_t solvers = tried.solvers.size();
    std::erase_if(table.cases, [&](const auto& one) { return one.second.size() != solvers; });
    tried.log_seconds.resize(static_cast<Eigen::Index>(table.cases.size()),
                             static_cast<Eigen::Index>(solvers));
    for (const auto& [name, solves] : table.cases) {
      Eigen::Index c = std::ssize(tried.cases), s = 0;
      tried.cases.push_back(solves.begin()->second.row);
      for (const auto& [solver, solve] : solves)
        tried.log_seconds(c, s++) =
            std::log(shift + (solve.solved ? std::min(solve.median, limit) : limit));
    }
  }
  std::ranges::stable_sort(result, std::greater(), &TriedCases::tolerance);
  return result;
}

std::vector<Estimate> ranks_of(const TriedCases& tried, const std::vector<Eigen::Index>& members) {
  const size_t solvers = tried.solvers.size();
  if (members.empty()) return std::vector<Estimate>(solvers, {not_known, not_known, not_known});
  std::vector<std::vector<double>> ranks(solvers);
  // a rank is 1 + the number of smaller means + half the number of other equal ones
  const auto rank = [&](const Weights& weights) {
    const Eigen::ArrayXd means = means_of(tried, members, weights);
    for (size_t s = 0; s < solvers; ++s) {
      const double mean = means[static_cast<Eigen::Index>(s)];
      ranks[s].push_back(0.5 + static_cast<double>((means < mean).count()) +
                         0.5 * static_cast<double>((means == mean).count()));
    }
  };
  Weights each;
  for (const Eigen::Index c : members)
    each[run_of(tried.cases[static_cast<size_t>(c)]->case_name)] = 1.0;
  rank(each);
  std::vector<std::string> runs;
  for (const auto& [run, weight] : each) runs.push_back(run);
  Random random(1);
  for (int k = 0; runs.size() >= fewest_runs && k < resamples; ++k) {
    Weights drawn = each;
    for (auto& [run, weight] : drawn) weight = 0.0;
    for (size_t n = 0; n < runs.size(); ++n)
      ++drawn[runs[static_cast<size_t>(random.below(static_cast<int>(runs.size())))]];
    rank(drawn);
  }
  std::vector<Estimate> estimates;
  for (const std::vector<double>& values : ranks) {
    const std::span drawn = std::span(values).subspan(1);
    estimates.push_back({values[0], quantile(drawn, 0.025), quantile(drawn, 0.975)});
  }
  return estimates;
}

}  // namespace ballast

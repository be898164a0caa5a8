#include "experiments/compare/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

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

/// The rank of each mean: 1 + the number of smaller means + half the number of other equal ones.
VectorXd ranked(const VectorXd& means) {
  VectorXd ranks(means.size());
  for (Eigen::Index i = 0; i < means.size(); ++i)
    ranks[i] = 0.5 + static_cast<double>((means.array() < means[i]).count()) +
               0.5 * static_cast<double>((means.array() == means[i]).count());
  return ranks;
}

/// The first value, and the 95 % interval of the others if they were drawn.
Estimate estimate_of(const std::vector<double>& values, bool is_drawn) {
  if (!is_drawn) return {values[0], not_known, not_known};
  const std::span drawn = std::span(values).subspan(1);
  return {values[0], quantile(drawn, 0.025), quantile(drawn, 0.975)};
}

}  // namespace

std::string base_family(const CompareRow& row) {
  return row.family.substr(0, row.family.find(", "));
}

std::string run_of(const std::string& case_name) {
  return case_name.substr(0, case_name.rfind("step_"));
}

std::vector<TriedCases> tried_cases(std::span<const CompareRow> rows, double shift) {
  using Repeats = std::vector<const CompareRow*>;
  std::map<std::pair<double, StartKind>, std::map<std::string, std::map<std::string, Repeats>>> all;
  for (const CompareRow& row : rows)
    if (row.verdict != Verdict::unreadable)
      all[{-row.tolerance, row.start}][row.case_name][row.solver].push_back(&row);
  const double limit = limit_of(rows);
  std::vector<TriedCases> result;
  for (auto& [setting, cases] : all) {
    TriedCases& tried = result.emplace_back(TriedCases{setting.second, -setting.first, {}, {}, {}});
    std::set<std::string> solvers;
    for (const auto& [name, by_solver] : cases)
      for (const auto& [solver, repeats] : by_solver) solvers.insert(solver);
    tried.solvers.assign(solvers.begin(), solvers.end());
    std::erase_if(cases, [&](const auto& one) { return one.second.size() != solvers.size(); });
    tried.log_seconds.resize(static_cast<Eigen::Index>(cases.size()),
                             static_cast<Eigen::Index>(solvers.size()));
    Eigen::Index c = 0;
    for (const auto& [name, by_solver] : cases) {
      tried.cases.push_back(by_solver.begin()->second.front());
      Eigen::Index s = 0;
      for (const auto& [solver, repeats] : by_solver) {
        const RepeatedSolve solve = over_repeats(repeats);
        tried.log_seconds(c, s++) =
            std::log(shift + (solve.solved ? std::min(solve.median, limit) : limit));
      }
      ++c;
    }
  }
  return result;
}

std::vector<Estimate> ranks_of(const TriedCases& tried, const std::vector<Eigen::Index>& members) {
  const size_t solvers = tried.solvers.size();
  if (members.empty()) return std::vector<Estimate>(solvers, {not_known, not_known, not_known});
  std::vector<std::vector<double>> ranks(solvers);
  const auto rank = [&](const Weights& weights) {
    const VectorXd order = ranked(means_of(tried, members, weights));
    for (size_t s = 0; s < solvers; ++s) ranks[s].push_back(order[static_cast<Eigen::Index>(s)]);
  };
  Weights each, none;
  for (const Eigen::Index c : members)
    each[run_of(tried.cases[static_cast<size_t>(c)]->case_name)] = 1.0;
  rank(each);
  std::vector<std::string> runs;
  for (const auto& [run, weight] : each) runs.push_back(run);
  for (const std::string& run : runs) none[run] = 0.0;
  const bool is_drawn = runs.size() >= fewest_runs;
  Random random(1);
  for (int k = 0; is_drawn && k < resamples; ++k) {
    Weights drawn = none;
    for (size_t n = 0; n < runs.size(); ++n)
      ++drawn[runs[static_cast<size_t>(random.below(static_cast<int>(runs.size())))]];
    rank(drawn);
  }
  std::vector<Estimate> estimates;
  for (const std::vector<double>& values : ranks)
    estimates.push_back(estimate_of(values, is_drawn));
  return estimates;
}

}  // namespace ballast

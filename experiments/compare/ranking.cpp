#include "experiments/compare/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/measure/curve_fit.hpp"
#include "platform/random.hpp"

namespace ballast {
namespace {

using Eigen::VectorXd;
using Weights = std::map<std::string, double>;  ///< of runs

/// Weighted means of a group's backends; empty where no member has a weight.
VectorXd means_of(const CaseGroup& group, const Weights* weights) {
  VectorXd sum = VectorXd::Zero(group.tried->log_seconds.cols());
  double total = 0.0;
  for (const Eigen::Index c : group.members) {
    const std::string& name = group.tried->cases[static_cast<size_t>(c)]->case_name;
    const double weight = weights ? weights->at(run_of(name)) : 1.0;
    sum += weight * group.tried->log_seconds.row(c).transpose();
    total += weight;
  }
  return total > 0.0 ? VectorXd(sum / total) : VectorXd();
}

/// 1 + how many are less, and half of the others that are equal.
VectorXd ranked(const VectorXd& means) {
  VectorXd ranks(means.size());
  for (Eigen::Index i = 0; i < means.size(); ++i)
    ranks[i] = 0.5 + static_cast<double>((means.array() < means[i]).count()) +
               0.5 * static_cast<double>((means.array() == means[i]).count());
  return ranks;
}

double kendall(const VectorXd& a, const VectorXd& b) {
  double agree = 0.0, in_a = 0.0, in_b = 0.0;
  const auto sign = [](double x) { return static_cast<double>((x > 0.0) - (x < 0.0)); };
  for (Eigen::Index i = 0; i < a.size(); ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const double left = sign(a[i] - a[j]), right = sign(b[i] - b[j]);
      agree += left * right;
      in_a += left * left;
      in_b += right * right;
    }
  return agree / std::sqrt(in_a * in_b);  // 0/0: one of the two has no order
}

/// Calls take(means of each group) for what the groups are and for each of the draws in which every
/// group has members. False: too few runs to draw from.
template <size_t count, typename Take>
bool draw(const CaseGroup* const (&groups)[count], const Take& take) {
  std::vector<VectorXd> means(count);
  std::set<std::string> names;
  size_t fewest = SIZE_MAX;
  for (size_t g = 0; g < count; ++g) {
    means[g] = means_of(*groups[g], nullptr);
    std::set<std::string> own = runs_of(*groups[g]);
    fewest = std::min(fewest, own.size());
    names.merge(own);
  }
  take(means);
  if (fewest < fewest_runs) return false;
  const std::vector<std::string> runs(names.begin(), names.end());
  Random random(1);
  for (int k = 0; k < resamples; ++k) {
    Weights weights;
    for (const std::string& run : runs) weights[run] = 0.0;
    for (size_t n = 0; n < runs.size(); ++n)
      ++weights[runs[static_cast<size_t>(random.below(static_cast<int>(runs.size())))]];
    bool all = true;
    for (size_t g = 0; g < count; ++g) {
      means[g] = means_of(*groups[g], &weights);
      all = all && means[g].size() > 0;
    }
    if (all) take(means);
  }
  return true;
}

/// The first value, and the range of the others.
Estimate estimate_of(const std::vector<double>& values, bool is_drawn) {
  if (!is_drawn) return {values[0], not_known, not_known};
  const std::span drawn = std::span(values).subspan(1);
  return {values[0], quantile(drawn, 0.025), quantile(drawn, 0.975)};
}

}  // namespace

std::string world_of(const CompareRow& row) { return row.family.substr(0, row.family.find(", ")); }

std::string run_of(const std::string& case_name) {
  return case_name.substr(0, case_name.rfind("step_"));
}

std::set<std::string> runs_of(const CaseGroup& group) {
  std::set<std::string> runs;
  for (const Eigen::Index c : group.members)
    runs.insert(run_of(group.tried->cases[static_cast<size_t>(c)]->case_name));
  return runs;
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

std::vector<Estimate> ranks_of(const CaseGroup& group) {
  const size_t solvers = group.tried->solvers.size();
  if (group.members.empty())
    return std::vector<Estimate>(solvers, {not_known, not_known, not_known});
  std::vector<std::vector<double>> ranks(solvers);
  const bool is_drawn = draw({&group}, [&](const std::vector<VectorXd>& means) {
    const VectorXd order = ranked(means[0]);
    for (size_t s = 0; s < solvers; ++s) ranks[s].push_back(order[static_cast<Eigen::Index>(s)]);
  });
  std::vector<Estimate> estimates;
  for (const std::vector<double>& values : ranks)
    estimates.push_back(estimate_of(values, is_drawn));
  return estimates;
}

Estimate agreement(const CaseGroup& a, const CaseGroup& b) {
  std::vector<Eigen::Index> left, right;  // places of the backends that both have
  for (size_t s = 0; s < a.tried->solvers.size(); ++s) {
    const auto found = std::ranges::find(b.tried->solvers, a.tried->solvers[s]);
    if (found == b.tried->solvers.end()) continue;
    left.push_back(static_cast<Eigen::Index>(s));
    right.push_back(found - b.tried->solvers.begin());
  }
  if (a.members.empty() || b.members.empty()) return {not_known, not_known, not_known};
  std::vector<double> taus;
  const bool is_drawn = draw({&a, &b}, [&](const std::vector<VectorXd>& means) {
    taus.push_back(kendall(means[0](left), means[1](right)));
  });
  return estimate_of(taus, is_drawn);
}

}  // namespace ballast

// case_facts: what cost is drawn against, and the key of a problem's content.

#include <algorithm>
#include <cmath>
#include <limits>
#include <cstdio>
#include <string_view>

#include <Eigen/Eigenvalues>

#include "experiments/compare/bench_case.hpp"
#include "experiments/content_key.hpp"
#include "problems/contact_error.hpp"
#include "problems/delassus.hpp"

namespace ballast {
namespace {

/// Above it a dense eigenvalue problem takes longer than some of the solves.
constexpr int most_rows_for_eigenvalues = 1000;

/// Hashes arrays of plain numbers.
class ContentHash {
 public:
  void add(const void* data, size_t bytes) {
    hash_ = fnv1a(std::string_view(reinterpret_cast<const char*>(&bytes), sizeof bytes), hash_);
    hash_ = fnv1a(std::string_view(static_cast<const char*>(data), bytes), hash_);
  }
  template <typename Values>
  void add(const Values& values) {
    add(values.data(), static_cast<size_t>(values.size()) * sizeof(*values.data()));
  }
  std::string key() const {
    char hex[17];
    std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(hash_));
    return hex;
  }

 private:
  std::uint64_t hash_ = fnv1a("");
};

std::string content_of(const FrictionProblem& problem, const Impulses& start, double scale) {
  ContentHash hash;
  hash.add(problem.row_begin);
  hash.add(problem.friction);
  if (problem.has_dynamics) {
    const DynamicsForm& d = problem.dynamics;
    hash.add(d.dof_begin);
    hash.add(d.mass);
    hash.add(d.body_a);
    hash.add(d.body_b);
    hash.add(d.h);
    hash.add(d.v_free);
    hash.add(d.bias);
  }
  if (problem.has_delassus) {
    const SparseRows& w = problem.delassus.w;
    hash.add(w.outerIndexPtr(), static_cast<size_t>(w.outerSize() + 1) * sizeof(int));
    hash.add(w.innerIndexPtr(), static_cast<size_t>(w.nonZeros()) * sizeof(int));
    hash.add(w.valuePtr(), static_cast<size_t>(w.nonZeros()) * sizeof(double));
    hash.add(problem.delassus.q);
  }
  hash.add(start);
  hash.add(&scale, sizeof scale);
  return hash.key();
}

double rank_deficiency(const FrictionProblem& problem, int touched_dofs) {
  const int rows = problem.row_count();
  if (rows == 0) return 0.0;
  if (rows <= most_rows_for_eigenvalues) {
    const Eigen::MatrixXd w = Eigen::MatrixXd(delassus_matrix(problem));
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (w + w.transpose()), Eigen::EigenvaluesOnly).eigenvalues();
    const double least = 1e-10 * values.cwiseAbs().maxCoeff();
    return 1.0 - static_cast<double>((values.array() > least).count()) / rows;
  }
  if (!problem.has_dynamics) return std::numeric_limits<double>::quiet_NaN();
  return std::max(0.0, 1.0 - static_cast<double>(touched_dofs) / rows);
}

int touched_dofs(const DynamicsForm& dynamics) {
  std::vector<char> is_touched(static_cast<size_t>(dynamics.body_count()), 0);
  for (const std::vector<int>* bodies : {&dynamics.body_a, &dynamics.body_b})
    for (const int body : *bodies)
      if (body >= 0) is_touched[static_cast<size_t>(body)] = 1;
  int dofs = 0;
  for (int body = 0; body < dynamics.body_count(); ++body)
    if (is_touched[static_cast<size_t>(body)]) dofs += dynamics.body_dofs(body);
  return dofs;
}

}  // namespace

CaseFacts case_facts(const FrictionProblem& problem, const Impulses& warm_start, double velocity_scale) {
  problem.validate();
  CaseFacts facts;
  facts.contacts = problem.contact_count();
  facts.rows = problem.row_count();
  if (problem.has_dynamics) facts.dofs = touched_dofs(problem.dynamics);
  facts.rank_deficiency = rank_deficiency(problem, facts.dofs);
  std::vector<Eigen::Matrix3d> blocks;
  delassus_diagonal(problem, blocks);
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const Eigen::Matrix3d& block : blocks) {
    const double lambda = largest_eigenvalue(block);
    if (!(lambda > 0.0)) continue;
    least = std::min(least, lambda);
    most = std::max(most, lambda);
  }
  if (most > 0.0) facts.mass_ratio = most / least;
  // a problem at rest (q = 0) has no scale of its own
  facts.velocity_scale = velocity_scale > 0.0 ? velocity_scale : 1.0;
  facts.content = content_of(problem, warm_start, facts.velocity_scale);
  return facts;
}

}  // namespace ballast

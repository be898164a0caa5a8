// load_case and case_facts: what cost is drawn against, and the key of a problem's content.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include <Eigen/Eigenvalues>

#include "experiments/compare/compare_case.hpp"
#include "platform/text.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"

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
  std::string key() const { return hash_text(hash_); }

 private:
  std::uint64_t hash_ = fnv1a("");
};

double rank_deficiency(const FrictionProblem& problem, int touched_dofs) {
  const int rows = problem.row_count();
  if (rows == 0) return 0.0;
  if (rows <= most_rows_for_eigenvalues) {
    const Eigen::MatrixXd w = Eigen::MatrixXd(delassus_matrix(problem));
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                                       0.5 * (w + w.transpose()), Eigen::EigenvaluesOnly)
                                       .eigenvalues();
    const double least = 1e-10 * values.cwiseAbs().maxCoeff();
    return 1.0 - static_cast<double>((values.array() > least).count()) / rows;
  }
  if (!problem.has_dynamics) return std::numeric_limits<double>::quiet_NaN();
  return std::max(0.0, 1.0 - static_cast<double>(touched_dofs) / rows);
}

/// Bodies that a contact touches.
std::vector<int> touched_bodies(const DynamicsForm& dynamics) {
  std::vector<char> is_touched(static_cast<size_t>(dynamics.body_count()), 0);
  for (const std::vector<int>* bodies : {&dynamics.body_a, &dynamics.body_b})
    for (const int body : *bodies)
      if (body >= 0) is_touched[static_cast<size_t>(body)] = 1;
  std::vector<int> touched;
  for (int body = 0; body < dynamics.body_count(); ++body)
    if (is_touched[static_cast<size_t>(body)]) touched.push_back(body);
  return touched;
}

/// Largest over smallest of what is > 0; 1 without any.
double ratio_of(const std::vector<double>& values) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const double value : values) {
    if (!(value > 0.0)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  return most > 0.0 ? most / least : 1.0;
}

double mass_ratio(const FrictionProblem& problem, const std::vector<int>& touched) {
  std::vector<double> values;
  if (problem.has_dynamics) {  // a block's first entry: translations come first
    for (const int body : touched)
      values.push_back(
          problem.dynamics.mass[static_cast<size_t>(problem.dynamics.mass_begin[body])]);
  } else {
    std::vector<Eigen::Matrix3d> blocks;
    delassus_diagonal(problem, blocks);
    for (const Eigen::Matrix3d& block : blocks) values.push_back(largest_eigenvalue(block));
  }
  return ratio_of(values);
}

}  // namespace

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

LoadedCase load_case(FrictionProblem problem, double velocity_scale) {
  problem.validate();
  LoadedCase loaded;
  loaded.problem = std::move(problem);
  // what the judge calls velocity scale: the rms of q
  if (!(velocity_scale > 0.0))
    velocity_scale =
        contact_error(loaded.problem, Impulses::Zero(loaded.problem.row_count())).velocity_scale;
  loaded.facts = case_facts(loaded.problem, {}, velocity_scale);
  loaded.describe_contact = [](int c) {
    return c < 0 ? std::string() : "contact " + std::to_string(c);
  };
  return loaded;
}

CaseFacts case_facts(const FrictionProblem& problem, const Impulses& warm_start,
                     double velocity_scale) {
  problem.validate();
  CaseFacts facts;
  facts.contacts = problem.contact_count();
  facts.rows = problem.row_count();
  std::vector<int> touched;
  if (problem.has_dynamics) touched = touched_bodies(problem.dynamics);
  for (const int body : touched) facts.dofs += problem.dynamics.body_dofs(body);
  facts.rank_deficiency = rank_deficiency(problem, facts.dofs);
  facts.mass_ratio = mass_ratio(problem, touched);
  // a problem at rest (q = 0) has no scale of its own
  facts.velocity_scale = velocity_scale > 0.0 ? velocity_scale : 1.0;
  facts.content = content_of(problem, warm_start, facts.velocity_scale);
  return facts;
}

}  // namespace ballast

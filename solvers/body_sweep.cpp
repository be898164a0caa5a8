#include "solvers/body_sweep.hpp"

#include <algorithm>
#include <cmath>

#include "problems/delassus.hpp"

namespace ballast {
namespace {

/// Both sides' rows of G = H L^-T, padded; a side that does not move gets zero rows and the velocity that stays zero.
template <int Rows>
void scale_rows(const DynamicsForm& dynamics, const std::vector<MassRoot>& roots, int c,
                double (*rows)[Rows][body_width], int* body) {
  const double* block = dynamics.h.data() + dynamics.h_begin[c];
  const int bodies[2] = {dynamics.body_a[c], dynamics.body_b[c]};
  for (int s = 0; s < 2; ++s) {
    std::fill(rows[s][0], rows[s][0] + Rows * body_width, 0.0);
    body[s] = dynamics.body_count();
    if (bodies[s] < 0) continue;
    body[s] = bodies[s];
    roots[bodies[s]].scaled_columns<Rows>(block, [side = rows[s]](int k, const double* column) {
      for (int i = 0; i < Rows; ++i) side[i][k] = column[i];
    });
    block += Rows * roots[bodies[s]].dofs;
  }
}

}  // namespace

void BodySweep::prepare(const FrictionProblem& problem) {
  prepare_bodies(problem.dynamics);
  const int contacts = problem.contact_count();
  int one_row = 0;
  for (int c = 0; c < contacts; ++c) one_row += problem.contact_rows(c) == 1;
  friction_.resize(contacts - one_row);
  turn_.resize(contacts - one_row);
  lambda_max_.resize(contacts - one_row);
  one_row_.resize(one_row);
  one_row_lambda_max_.resize(one_row);

  runs_.clear();
  record_.resize(contacts);
  is_one_row_.resize(contacts);
  int next[2] = {0, 0};  // record of each kind
  for (int c = 0; c < contacts; ++c) {
    const bool short_one = problem.contact_rows(c) == 1;
    if (runs_.empty() || runs_.back().one_row != short_one) runs_.push_back({short_one, c, next[short_one], 0});
    ++runs_.back().count;
    is_one_row_[c] = short_one;
    const int record = record_[c] = next[short_one]++;
    if (short_one)
      prepare_one_row(problem, c, record);
    else
      prepare_friction(problem, c, record);
  }
}

void BodySweep::prepare_bodies(const DynamicsForm& dynamics) {
  factor_masses(dynamics, roots_);
  const int bodies = dynamics.body_count();
  free_velocity_.assign(bodies + 1, BodyVelocity{});
  velocity_.resize(free_velocity_.size());
  for (int b = 0; b < bodies; ++b) {
    double* w = free_velocity_[b].w;
    const double* v = dynamics.v_free.data() + dynamics.dof_begin[b];
    std::copy(v, v + dynamics.body_dofs(b), w);
    roots_[b].multiply_upper(w);
  }
}

void BodySweep::prepare_friction(const FrictionProblem& problem, int c, int record) {
  FrictionRecord& k = friction_[record];
  scale_rows(problem.dynamics, roots_, c, k.rows, k.body);
  std::copy_n(problem.dynamics.bias.data() + problem.row_begin[c], 3, k.bias);
  make_principal(k, problem.friction[c], turn_[record], lambda_max_[record]);
}

void BodySweep::prepare_one_row(const FrictionProblem& problem, int c, int record) {
  OneRowRecord& k = one_row_[record];
  double rows[2][1][body_width];
  scale_rows(problem.dynamics, roots_, c, rows, k.body);
  for (int s = 0; s < 2; ++s) std::copy_n(rows[s][0], body_width, k.rows[s]);
  k.bias = problem.dynamics.bias[problem.row_begin[c]];
  make_principal(k, one_row_lambda_max_[record]);
}

void BodySweep::load(const FrictionProblem& problem, const Impulses& r) {
  velocity_ = free_velocity_;
  for (const Run& run : runs_)
    for (int i = 0; i < run.count; ++i) {
      const double* rc = r.data() + problem.row_begin[run.first_contact + i];
      if (run.one_row)
        load_impulse(one_row_[run.first_record + i], rc, velocity_.data());
      else
        load_impulse(friction_[run.first_record + i], turn_[run.first_record + i], rc, velocity_.data());
    }
}

void BodySweep::store(const FrictionProblem& problem, Impulses& r) const {
  for (const Run& run : runs_)
    for (int i = 0; i < run.count; ++i) {
      double* rc = r.data() + problem.row_begin[run.first_contact + i];
      if (run.one_row)
        rc[0] = one_row_[run.first_record + i].y;
      else
        friction_[run.first_record + i].impulse(turn_[run.first_record + i], rc);
    }
}

void BodySweep::sweep() {
  for (const Run& run : runs_)
    if (run.one_row)
      sweep_one_row(one_row_.data() + run.first_record, run.count, velocity_.data());
    else
      sweep_friction(friction_.data() + run.first_record, run.count, velocity_.data());
}

void BodySweep::sweep(const SweepVariant& variant, const std::vector<int>& contacts) {
  for (const int c : contacts) {
    const int record = record_[c];
    if (is_one_row_[c])
      resolve_by_variant(variant, one_row_[record], one_row_lambda_max_[record], velocity_.data());
    else
      resolve_by_variant(variant, friction_[record], lambda_max_[record], velocity_.data());
  }
}

double BodySweep::error() const {
  double sum = 0.0;
  int counted = 0;
  for (const Run& run : runs_)
    for (int record = run.first_record; record < run.first_record + run.count; ++record) {
      const double lambda_max = run.one_row ? one_row_lambda_max_[record] : lambda_max_[record];
      if (!(lambda_max > 0.0)) continue;
      const double value = run.one_row ? natural_map(one_row_[record], lambda_max, velocity_.data())
                                       : natural_map(friction_[record], lambda_max, velocity_.data());
      sum += value * value;
      ++counted;
    }
  return counted > 0 ? std::sqrt(sum / counted) : 0.0;
}

void BodySweep::save(Eigen::VectorXd& state) const {
  state.resize(3 * friction_.size() + one_row_.size() + body_width * velocity_.size());
  double* x = state.data();
  for (const FrictionRecord& k : friction_) x = std::copy_n(k.y, 3, x);
  for (const OneRowRecord& k : one_row_) *x++ = k.y;
  for (const BodyVelocity& v : velocity_) x = std::copy_n(v.w, body_width, x);
}

void BodySweep::restore(const Eigen::VectorXd& state) {
  const double* x = state.data();
  for (FrictionRecord& k : friction_) {
    std::copy_n(x, 3, k.y);
    x += 3;
  }
  for (OneRowRecord& k : one_row_) k.y = *x++;
  for (BodyVelocity& v : velocity_) {
    std::copy_n(x, body_width, v.w);
    x += body_width;
  }
}

void BodySweep::impulse_weights(Eigen::VectorXd& weights) const {
  weights.resize(3 * friction_.size() + one_row_.size());
  double* x = weights.data();
  for (const FrictionRecord& k : friction_) {
    *x++ = k.local.inverse_normal > 0.0 ? 1.0 / std::sqrt(k.local.inverse_normal) : 0.0;
    *x++ = std::sqrt(k.local.s1);
    *x++ = std::sqrt(k.local.s2);
  }
  for (const double lambda_max : one_row_lambda_max_) *x++ = std::sqrt(lambda_max);
}

}  // namespace ballast

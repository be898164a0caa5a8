#include "solvers/gauss_seidel/scalar_sweep.hpp"

#include <algorithm>
#include <cmath>

#include "problems/algebra/delassus.hpp"

namespace ballast {
namespace {

/// Both sides' rows of G = H L^-T; a side that does not move gets zero rows and the velocity
/// `nowhere`, which stays zero.
template <int Rows>
void scale_rows(const DynamicsForm& dynamics, const std::vector<MassRoot>& roots, int c,
                int nowhere, double (*rows)[Rows][row_width], int* body) {
  const double* block = dynamics.h.data() + dynamics.h_begin[c];
  const int bodies[2] = {dynamics.body_a[c], dynamics.body_b[c]};
  for (int s = 0; s < 2; ++s) {
    std::fill(rows[s][0], rows[s][0] + Rows * row_width, 0.0);
    body[s] = nowhere;
    if (bodies[s] < 0) continue;
    body[s] = bodies[s];
    roots[bodies[s]].scaled_columns<Rows>(block, [side = rows[s]](int k, const double* column) {
      for (int i = 0; i < Rows; ++i) side[i][k] = column[i];
    });
    block += Rows * roots[bodies[s]].dofs;
  }
}

}  // namespace

void ScalarSweep::prepare(const FrictionProblem& problem) {
  prepare_ranges(problem);
  prepare_bodies(problem.dynamics);
  // Records do not depend on each other: every thread makes its share.
  run_parts(team_, size_of(team_), [&](int member) {
    const std::vector<int>& order = plan_.contacts();
    const size_t begin = order.size() * member / size_of(team_),
                 end = order.size() * (member + 1) / size_of(team_);
    for (size_t i = begin; i < end; ++i)
      if (is_one_row_[order[i]])
        prepare_one_row(problem, order[i], record_[order[i]]);
      else
        prepare_friction(problem, order[i], record_[order[i]]);
  });
}

/// Numbers the records in the order of the plan.
void ScalarSweep::prepare_ranges(const FrictionProblem& problem) {
  const int contacts = problem.contact_count();
  record_.resize(contacts);
  is_one_row_.resize(contacts);
  nowhere_.resize(contacts);
  int friction = 0, one_row = 0, nowhere = problem.dynamics.body_count();
  // Records of a part follow each other, friction before one row; each part has a zero velocity of
  // its own for what does not move.
  const auto number = [&](const std::vector<SweepPlan::Part>& parts, std::vector<Range>& ranges) {
    ranges.clear();
    for (const SweepPlan::Part& part : parts) {
      ranges.push_back(
          {friction, part.friction_end - part.begin, one_row, part.end - part.friction_end});
      for (int i = part.begin; i < part.end; ++i) {
        const int c = plan_.contacts()[i];
        nowhere_[c] = nowhere;
        is_one_row_[c] = i >= part.friction_end;
        record_[c] = is_one_row_[c] ? one_row++ : friction++;
      }
      ++nowhere;
    }
  };
  number(plan_.interiors(), interiors_);
  number(plan_.interfaces(), interfaces_);
  friction_.resize(friction);
  friction_impulse_.resize(friction);
  turn_.resize(friction);
  lambda_max_.resize(friction);
  one_row_.resize(one_row);
  one_row_impulse_.resize(one_row);
  one_row_lambda_max_.resize(one_row);
}

template <typename Task>
void ScalarSweep::for_parts(const Task& task) {
  run_parts(team_, static_cast<int>(interiors_.size()), [&](int part) { task(interiors_[part]); });
  run_parts(team_, static_cast<int>(interfaces_.size()),
            [&](int part) { task(interfaces_[part]); });
}

// Masses factored, and the free velocities in the variables w = L^T v.
void ScalarSweep::prepare_bodies(const DynamicsForm& dynamics) {
  // Bodies, then the zero velocities of what never moves.
  factor_masses(dynamics, roots_);
  const int bodies = dynamics.body_count();
  free_velocity_.assign(bodies + interiors_.size() + interfaces_.size(), BodyVelocity{});
  velocity_.resize(free_velocity_.size());
  for (int b = 0; b < bodies; ++b) {
    double* w = free_velocity_[b].w;
    const double* v = dynamics.v_free.data() + dynamics.dof_begin[b];
    std::copy(v, v + dynamics.body_dofs(b), w);
    roots_[b].multiply_upper(w);
  }
}

// Rows and bias of one contact, then its principal coordinates.
void ScalarSweep::prepare_friction(const FrictionProblem& problem, int c, int record) {
  FrictionRecord& k = friction_[record];
  scale_rows(problem.dynamics, roots_, c, nowhere_[c], k.rows, k.body);
  std::copy_n(problem.dynamics.bias.data() + problem.row_begin[c], 3, k.bias);
  make_principal(k, problem.friction[c], turn_[record], lambda_max_[record]);
}

void ScalarSweep::prepare_one_row(const FrictionProblem& problem, int c, int record) {
  OneRowRecord& k = one_row_[record];
  double rows[2][1][row_width];
  scale_rows(problem.dynamics, roots_, c, nowhere_[c], rows, k.body);
  for (int s = 0; s < 2; ++s) std::copy_n(rows[s][0], row_width, k.rows[s]);
  k.bias = problem.dynamics.bias[problem.row_begin[c]];
  make_principal(k, one_row_lambda_max_[record]);
}

void ScalarSweep::load(const FrictionProblem& problem, const Impulses& r) {
  // The bodies start free, and every impulse pushes them once.
  velocity_ = free_velocity_;
  for (int c = 0; c < problem.contact_count(); ++c) {
    const double* rc = r.data() + problem.row_begin[c];
    const int record = record_[c];
    if (is_one_row_[c]) {
      load_impulse(one_row_[record], rc, one_row_impulse_[record], velocity_.data());
    } else {
      load_impulse(friction_[record], turn_[record], rc, friction_impulse_[record],
                   velocity_.data());
      friction_impulse_[record].slip = 0.0;
    }
  }
}

void ScalarSweep::store(const FrictionProblem& problem, Impulses& r) const {
  for (int c = 0; c < problem.contact_count(); ++c) {
    double* rc = r.data() + problem.row_begin[c];
    const int record = record_[c];
    if (is_one_row_[c])
      rc[0] = one_row_impulse_[record];
    else
      store_impulse(friction_[record], turn_[record], friction_impulse_[record], rc);
  }
}

void ScalarSweep::sweep() {
  for_parts([this](const Range& range) {
    sweep_friction(friction_.data() + range.friction, friction_impulse_.data() + range.friction,
                   range.friction_count, velocity_.data());
    sweep_one_row(one_row_.data() + range.one_row, one_row_impulse_.data() + range.one_row,
                  range.one_row_count, velocity_.data());
  });
}

void ScalarSweep::start_search() {
  friction_search_.assign(friction_.size(), ImpulseSearch{});
  one_row_search_.assign(one_row_.size(), OneRowSearch{});
  velocity_before_.assign(velocity_.size(), BodyVelocity{});
  velocity_direction_.assign(velocity_.size(), BodyVelocity{});
}

/// A slab's velocities, by the thread that sweeps its interior next: they stay in its cache.
void ScalarSweep::move_along(std::span<const int> bodies, SearchStep step) {
  // `before` is the velocity with which the last sweep began.
  for (const int b : bodies)
    for (int i = 0; i < body_width; ++i) {
      double &x = velocity_[b].w[i], &p = velocity_direction_[b].w[i],
             &before = velocity_before_[b].w[i];
      const double change = x - before, along = step.beta * p + step.ahead * change;
      p = along + step.gain * change;
      x += along;
      before = x;
    }
}

double ScalarSweep::sweep(SearchStep step) {
  const auto sweep_range = [&](Range& range) {
    range.change_square =
        sweep_friction(friction_.data() + range.friction, friction_impulse_.data() + range.friction,
                       friction_search_.data() + range.friction, step, range.friction_count,
                       velocity_.data()) +
        sweep_one_row(one_row_.data() + range.one_row, one_row_impulse_.data() + range.one_row,
                      one_row_search_.data() + range.one_row, step, range.one_row_count,
                      velocity_.data());
  };
  // Interiors first, with the bodies that are theirs; then the interfaces between slabs.
  run_parts(team_, static_cast<int>(interiors_.size()), [&](int slab) {
    move_along(plan_.bodies(slab), step);
    sweep_range(interiors_[slab]);
  });
  run_parts(team_, static_cast<int>(interfaces_.size()),
            [&](int k) { sweep_range(interfaces_[k]); });
  double square = 0.0;
  for (const std::vector<Range>* ranges : {&interiors_, &interfaces_})
    for (const Range& range : *ranges) square += range.change_square;
  return square;
}

void ScalarSweep::sweep(const SweepVariant& variant, const std::vector<int>& contacts) {
  for (const int c : contacts) {
    const int record = record_[c];
    if (is_one_row_[c])
      resolve_by_variant(variant, one_row_[record], one_row_impulse_[record], velocity_.data());
    else
      resolve_by_variant(variant, friction_[record], friction_impulse_[record], lambda_max_[record],
                         velocity_.data());
  }
}

double ScalarSweep::error() {
  // The same sums in the same order, whoever made them.
  for_parts([this](Range& range) {
    RootMeanSquare mean;
    // As the judge does: contacts that nothing moves are left out.
    for (int k = range.friction; k < range.friction + range.friction_count; ++k) {
      if (!(lambda_max_[k] > 0.0)) continue;
      const double value =
          natural_map(friction_[k], friction_impulse_[k], lambda_max_[k], velocity_.data());
      mean.add(value);
    }
    for (int k = range.one_row; k < range.one_row + range.one_row_count; ++k) {
      if (!(one_row_lambda_max_[k] > 0.0)) continue;
      const double value =
          natural_map(one_row_[k], one_row_impulse_[k], one_row_lambda_max_[k], velocity_.data());
      mean.add(value);
    }
    range.error = mean;
  });
  // The parts' sums, always in the same order.
  RootMeanSquare mean;
  for (const std::vector<Range>* ranges : {&interiors_, &interfaces_})
    for (const Range& range : *ranges) mean.add(range.error);
  return mean.value();
}

void ScalarSweep::save(Eigen::VectorXd& state) const {
  // Impulses with friction, those of one row, then velocities: restore() reads the same order.
  state.resize(3 * friction_.size() + one_row_.size() + body_width * velocity_.size());
  double* x = state.data();
  for (const FrictionImpulse& k : friction_impulse_) x = std::copy_n(k.y, 3, x);
  x = std::copy(one_row_impulse_.begin(), one_row_impulse_.end(), x);
  for (const BodyVelocity& v : velocity_) x = std::copy_n(v.w, body_width, x);
}

void ScalarSweep::restore(const Eigen::VectorXd& state) {
  const double* x = state.data();
  for (FrictionImpulse& k : friction_impulse_) {
    std::copy_n(x, 3, k.y);
    x += 3;
  }
  for (double& k : one_row_impulse_) k = *x++;
  for (BodyVelocity& v : velocity_) {
    std::copy_n(x, body_width, v.w);
    x += body_width;
  }
}

void ScalarSweep::impulse_weights(Eigen::VectorXd& weights) const {
  // Roots of W's diagonal in the records' coordinates, where a
  // contact's block is diag(W_NN, s1, s2).
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

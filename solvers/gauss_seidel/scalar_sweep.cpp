#include "solvers/gauss_seidel/scalar_sweep.hpp"

#include <algorithm>
#include <numeric>

#include "platform/for_each_cpu.hpp"
#include "problems/algebra/contact_error.hpp"
#include "solvers/gauss_seidel/lanes.hpp"

namespace ballast {
namespace {

using Record = ScalarSweep::Record;
using Impulse = ScalarSweep::Impulse;
using Velocity = ScalarSweep::Velocity;

// GCC's vector extensions: the same bits on every instruction set, as in lanes.hpp.
using Vector8 = double __attribute__((vector_size(64)));
using Vector4 = double __attribute__((vector_size(32)));

BALLAST_INLINE Vector8 load8(const double* x) { return *reinterpret_cast<const Vector8*>(x); }
BALLAST_INLINE void store8(double* x, const Vector8& value) {
  *reinterpret_cast<Vector8*>(x) = value;
}

BALLAST_INLINE Vector4 halves(const Vector8& x) {
  return __builtin_shufflevector(x, x, 0, 1, 2, 3) + __builtin_shufflevector(x, x, 4, 5, 6, 7);
}

BALLAST_INLINE double sum(const Vector8& x) {
  const Vector4 p = halves(x);
  return (p[0] + p[1]) + (p[2] + p[3]);
}

/// The sums of three vectors' entries, each as sum() adds them.
BALLAST_INLINE Vector4 three_sums(const Vector8& x, const Vector8& y, const Vector8& z) {
  const Vector4 p = halves(x), q = halves(y), s = halves(z);
  const Vector4 pq =
      __builtin_shufflevector(p, q, 0, 4, 2, 6) + __builtin_shufflevector(p, q, 1, 5, 3, 7);
  const Vector4 ss =
      __builtin_shufflevector(s, s, 0, 0, 2, 2) + __builtin_shufflevector(s, s, 1, 1, 3, 3);
  return __builtin_shufflevector(pq, ss, 0, 1, 4, 5) + __builtin_shufflevector(pq, ss, 2, 3, 6, 7);
}

/// Returns G w, summed over both sides.
BALLAST_INLINE Vector4 relative_velocity(const Record& k, const Vector8& wa, const Vector8& wb) {
  const auto moved = [&](int i) __attribute__((always_inline)) {
    return load8(k.rows[0][i]) * wa + load8(k.rows[1][i]) * wb;
  };
  return three_sums(moved(0), moved(1), moved(2));
}

/// Solves one contact and moves its bodies.
BALLAST_INLINE void relax(const Record& k, Impulse& r, Velocity* velocity) {
  double* va = velocity[k.body[0]].w;
  double* vb = velocity[k.body[1]].w;
  const Vector8 wa = load8(va), wb = load8(vb);
  const Vector4 u = relative_velocity(k, wa, wb);
  // The impulse that would stop the contact, then Coulomb's law.
  double y = r.y[0] - (u[0] + k.bias[0]) * k.local.inverse_normal;
  double t1 = r.y[1] - (u[1] + k.bias[1]) * k.local.inverse_s1;
  double t2 = r.y[2] - (u[2] + k.bias[2]) * k.local.inverse_s2;
  apply_coulomb(k.local, y, t1, t2, r.slip);
  // The bodies feel the change: w += G^T (dy, d1, d2).
  const double dy = y - r.y[0], d1 = t1 - r.y[1], d2 = t2 - r.y[2];
  r.y[0] = y;
  r.y[1] = t1;
  r.y[2] = t2;
  const auto push = [&](int s) __attribute__((always_inline)) {
    return load8(k.rows[s][0]) * dy + load8(k.rows[s][1]) * d1 + load8(k.rows[s][2]) * d2;
  };
  store8(va, wa + push(0));
  store8(vb, wb + push(1));
}

/// The same for a one-row contact: a third of the work.
BALLAST_INLINE void relax_one_row(const Record& k, Impulse& r, Velocity* velocity) {
  double* va = velocity[k.body[0]].w;
  double* vb = velocity[k.body[1]].w;
  const Vector8 wa = load8(va), wb = load8(vb), ga = load8(k.rows[0][0]), gb = load8(k.rows[1][0]);
  double y = r.y[0] - (sum(ga * wa + gb * wb) + k.bias[0]) * k.local.inverse_normal;
  if (y <= 0.0) y = 0.0;
  const double dy = y - r.y[0];
  r.y[0] = y;
  store8(va, wa + ga * dy);
  store8(vb, wb + gb * dy);
}

/// The first `with_friction` contacts have three rows, the others one row.
BALLAST_FOR_EACH_CPU
void sweep_records(const Record* records, Impulse* impulses, int with_friction, int count,
                   Velocity* velocity) {
  for (int c = 0; c < with_friction; ++c) relax(records[c], impulses[c], velocity);
  for (int c = with_friction; c < count; ++c) relax_one_row(records[c], impulses[c], velocity);
}

/// Moves x along its search (see SearchStep). The caller restores a slip root in lane 3.
template <typename Vector>
BALLAST_INLINE void move_along(SearchStep step, double* x, double* before, double* direction) {
  Vector now = *reinterpret_cast<const Vector*>(x), &began = *reinterpret_cast<Vector*>(before);
  step.move(Vector(now - began), *reinterpret_cast<Vector*>(direction), now);
  *reinterpret_cast<Vector*>(x) = began = now;
}

BALLAST_FOR_EACH_CPU
void move_bodies(SearchStep step, Velocity* x, Velocity* before, Velocity* direction, int count) {
  for (int b = 0; b < count; ++b) move_along<Vector8>(step, x[b].w, before[b].w, direction[b].w);
}

/// Moves and sweeps the contacts. Returns the square of the change by the sweep.
BALLAST_FOR_EACH_CPU
double sweep_records_along(SearchStep step, const Record* records, Impulse* impulses,
                           Impulse* before, Impulse* direction, int with_friction, int count,
                           Velocity* velocity) {
  double square = 0.0, square_one_row = 0.0;
  for (int c = 0; c < with_friction; ++c) {
    Impulse& r = impulses[c];
    const double slip = r.slip;
    move_along<Vector4>(step, r.y, before[c].y, direction[c].y);
    r.slip = slip;
    relax(records[c], r, velocity);
    const double d0 = r.y[0] - before[c].y[0], d1 = r.y[1] - before[c].y[1],
                 d2 = r.y[2] - before[c].y[2];
    square += d0 * d0 + d1 * d1 + d2 * d2;
  }
  for (int c = with_friction; c < count; ++c) {
    double &y = impulses[c].y[0], &began = before[c].y[0];
    step.move(y - began, direction[c].y[0], y);
    began = y;
    relax_one_row(records[c], impulses[c], velocity);
    square_one_row += (y - began) * (y - began);
  }
  return square + square_one_row;
}

/// w += G^T change. Avoids Vector8, as without AVX the compiler broadcasts a number through memory.
void push_bodies(const Record& k, const double* change, Velocity* velocity) {
  for (int s = 0; s < 2; ++s)
    for (int j = 0; j < ScalarSweep::width; ++j)
      velocity[k.body[s]].w[j] +=
          k.rows[s][0][j] * change[0] + k.rows[s][1][j] * change[1] + k.rows[s][2][j] * change[2];
}

/// Takes its arguments in registers: in memory, the caller's clone would make vectors of them, for
/// which store forwarding fails.
[[gnu::noinline]] double judged(double rn, double r1, double r2, double un, double u1, double u2,
                                double mu, double lambda_max) {
  return ContactJudge::scaled_natural_map({rn, r1, r2}, {un, u1, u2}, mu, lambda_max);
}

/// The judge's scaled natural map at the current iterate [m/s]. Compiled for one instruction set: a
/// change from wide registers to the narrow ones of judged() may cost more than the computation.
double natural_map(const Record& k, const Impulse& r, double lambda_max, const Velocity* velocity) {
  const Vector4 moved =
      relative_velocity(k, load8(velocity[k.body[0]].w), load8(velocity[k.body[1]].w));
  // Turn the record's (y, r_T) and (u_N, u_T - c u_N) back into the judge's r and u.
  const double un = moved[0] + k.bias[0];
  return judged(r.y[0] - k.local.c1 * r.y[1] - k.local.c2 * r.y[2], r.y[1], r.y[2], un,
                moved[1] + k.bias[1] + k.local.c1 * un, moved[2] + k.bias[2] + k.local.c2 * un,
                k.local.mu, lambda_max);
}

/// Writes both sides' rows of G = H L^-T in the problem's tangents. A side that does not move gets
/// zero rows and the velocity `nowhere`, which stays zero.
template <int Rows>
void scale_rows(const DynamicsForm& dynamics, const std::vector<MassRoot>& roots, int c,
                int nowhere, Record& k) {
  const double* block = dynamics.h.data() + dynamics.h_begin[c];
  const int bodies[2] = {dynamics.body_a[c], dynamics.body_b[c]};
  for (int s = 0; s < 2; ++s) {
    k.body[s] = bodies[s] < 0 ? nowhere : bodies[s];
    if (bodies[s] < 0) continue;
    roots[bodies[s]].scaled_columns<Rows>(block, [&k, s](int j, const double* column) {
      for (int i = 0; i < Rows; ++i) k.rows[s][i][j] = column[i];
    });
    block += Rows * roots[bodies[s]].dofs;
  }
}

/// Turns H L^-T and the given bias into principal coordinates. Returns lambda_max(W_cc).
BALLAST_FOR_EACH_CPU
double to_principal(Record& k, double mu, TangentTurn& turn) {
  // W_cc = G G^T from six scalar products of rows, three at once.
  const auto product = [&k](int i, int j) __attribute__((always_inline)) {
    return load8(k.rows[0][i]) * load8(k.rows[0][j]) + load8(k.rows[1][i]) * load8(k.rows[1][j]);
  };
  Eigen::Matrix3d w = Eigen::Matrix3d::Zero();
  if (k.row_count == 1) {
    w(0, 0) = sum(product(0, 0));
    make_principal(w, mu, k.local, turn);
    return w(0, 0);
  }
  const Vector4 first = three_sums(product(0, 0), product(1, 0), product(2, 0));
  const Vector4 rest = three_sums(product(1, 1), product(2, 1), product(2, 2));
  w << first[0], first[1], first[2], first[1], rest[0], rest[1], first[2], rest[1], rest[2];
  make_principal(w, mu, k.local, turn);
  // Turn the tangents and subtract c times the normal row (see PrincipalContact).
  turn.to_principal(k.bias[1], k.bias[2]);
  k.bias[1] -= k.local.c1 * k.bias[0];
  k.bias[2] -= k.local.c2 * k.bias[0];
  for (auto& rows : k.rows) {
    const Vector8 n = load8(rows[0]), t1 = load8(rows[1]), t2 = load8(rows[2]);
    store8(rows[1], turn.cosine * t1 + turn.sine * t2 - k.local.c1 * n);
    store8(rows[2], turn.cosine * t2 - turn.sine * t1 - k.local.c2 * n);
  }
  return largest_eigenvalue(w);
}

}  // namespace

void ScalarSweep::prepare(const FrictionProblem& problem) {
  const std::vector<int>& order = plan_.contacts();
  place_.resize(order.size());
  for (size_t i = 0; i < order.size(); ++i) place_[order[i]] = static_cast<int>(i);
  part_error_.resize(plan_.parts().size());
  // The masses' factors, and the free velocities in the variables w = L^T v.
  const DynamicsForm& dynamics = problem.dynamics;
  factor_masses(dynamics, roots_);
  free_velocity_.assign(dynamics.body_count() + part_error_.size(), {});
  for (int b = 0; b < dynamics.body_count(); ++b) {
    double* w = free_velocity_[b].w;
    std::copy_n(dynamics.v_free.data() + dynamics.dof_begin[b], dynamics.body_dofs(b), w);
    roots_[b].multiply_upper(dynamics.mass.data() + dynamics.mass_begin[b], w);
  }
  velocity_ = free_velocity_;
  records_.assign(order.size(), {});
  impulses_.resize(order.size());
  turn_.resize(order.size());
  lambda_max_.resize(order.size());
  plan_.for_parts_in_phases([&](const SweepPlan::Part& part, int number) {
    for (int i = part.begin; i < part.end; ++i)
      prepare_record(problem, i, dynamics.body_count() + number);
  });
}

/// Makes rows and bias of one contact, then turns them into principal coordinates.
void ScalarSweep::prepare_record(const FrictionProblem& problem, int place, int nowhere) {
  const int c = plan_.contacts()[place];
  Record& k = records_[place];
  k.row_count = problem.contact_rows(c);
  const auto scale = k.row_count == 3 ? scale_rows<3> : scale_rows<1>;
  scale(problem.dynamics, roots_, c, nowhere, k);
  std::copy_n(problem.dynamics.bias.data() + problem.row_begin[c], k.row_count, k.bias);
  lambda_max_[place] = to_principal(k, problem.friction[c], turn_[place]);
}

void ScalarSweep::load(const FrictionProblem& problem, const Impulses& r) {
  // The bodies start with their free velocities, and every impulse pushes them once.
  velocity_ = free_velocity_;
  for (int c = 0; c < problem.contact_count(); ++c) {
    const Record& k = records_[place_[c]];
    const double* given = r.data() + problem.row_begin[c];
    double normal = given[0], t1 = 0.0, t2 = 0.0;
    if (k.row_count == 3) {
      t1 = given[1];
      t2 = given[2];
      turn_[place_[c]].to_principal(t1, t2);
    }
    // A sweep could keep the given impulse of a contact that nothing moves along its normal.
    if (!(k.local.inverse_normal > 0.0)) normal = t1 = t2 = 0.0;
    // PrincipalContact's y = r_N + c . r_T stands in place of r_N.
    const double y[3] = {normal + k.local.c1 * t1 + k.local.c2 * t2, t1, t2};
    impulses_[place_[c]] = {{y[0], y[1], y[2]}, 0.0};
    push_bodies(k, y, velocity_.data());
  }
}

void ScalarSweep::store(const FrictionProblem& problem, Impulses& r) const {
  for (int c = 0; c < problem.contact_count(); ++c) {
    const Record& k = records_[place_[c]];
    const double* y = impulses_[place_[c]].y;
    double t1 = y[1], t2 = y[2];
    double* to = r.data() + problem.row_begin[c];
    to[0] = y[0] - k.local.c1 * t1 - k.local.c2 * t2;
    if (k.row_count == 1) continue;
    turn_[place_[c]].from_principal(t1, t2);
    to[1] = t1;
    to[2] = t2;
  }
}

void ScalarSweep::sweep() {
  plan_.for_parts_in_phases([this](const SweepPlan::Part& part, int) {
    sweep_records(records_.data() + part.begin, impulses_.data() + part.begin,
                  part.friction_end - part.begin, part.end - part.begin, velocity_.data());
  });
}

void ScalarSweep::start_search() {
  impulses_before_ = impulses_;
  impulse_direction_.assign(impulses_.size(), {});
  velocity_before_ = velocity_;
  velocity_direction_.assign(velocity_.size(), {});
  part_square_.resize(part_error_.size());
}

double ScalarSweep::sweep_along(SearchStep step) {
  move_bodies(step, velocity_.data(), velocity_before_.data(), velocity_direction_.data(),
              static_cast<int>(velocity_.size()));
  plan_.for_parts_in_phases([&](const SweepPlan::Part& part, int number) {
    part_square_[number] = sweep_records_along(
        step, records_.data() + part.begin, impulses_.data() + part.begin,
        impulses_before_.data() + part.begin, impulse_direction_.data() + part.begin,
        part.friction_end - part.begin, part.end - part.begin, velocity_.data());
  });
  return std::accumulate(part_square_.begin(), part_square_.end(), 0.0);
}

double ScalarSweep::error() {
  plan_.for_parts_in_phases([this](const SweepPlan::Part& part, int number) {
    RootMeanSquare mean;
    // Leave out contacts that nothing moves, as the judge does.
    for (int k = part.begin; k < part.end; ++k)
      if (lambda_max_[k] > 0.0)
        mean.add(natural_map(records_[k], impulses_[k], lambda_max_[k], velocity_.data()));
    part_error_[number] = mean;
  });
  // Add the parts' sums in a fixed order, whichever threads made them.
  RootMeanSquare mean;
  for (const RootMeanSquare& part : part_error_) mean.add(part);
  return mean.value();
}

}  // namespace ballast

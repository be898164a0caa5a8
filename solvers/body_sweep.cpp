#include "solvers/body_sweep.hpp"

#include <algorithm>
#include <cmath>

#include "problems/contact_error.hpp"
#include "problems/delassus.hpp"

// Vectors never cross a call boundary that the linker sees, so GCC's note about their calling convention does not
// apply.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace ballast {
namespace {

// GCC's vector extensions: the same element-wise operations in the same order on every instruction set, hence the same
// bits
// (-ffp-contract=off keeps multiplications and additions apart).
using Vector8 = double __attribute__((vector_size(64)));
using Vector4 = double __attribute__((vector_size(32)));

#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__clang__)
#define BALLAST_FOR_EACH_CPU __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define BALLAST_FOR_EACH_CPU
#endif

#define BALLAST_INLINE inline __attribute__((always_inline))

BALLAST_INLINE Vector8 load8(const double* x) { return *reinterpret_cast<const Vector8*>(x); }
BALLAST_INLINE void store8(double* x, Vector8 value) { *reinterpret_cast<Vector8*>(x) = value; }

BALLAST_INLINE Vector4 halves(Vector8 x) {
  return __builtin_shufflevector(x, x, 0, 1, 2, 3) + __builtin_shufflevector(x, x, 4, 5, 6, 7);
}

/// The three sums of a contact's rows times its bodies' velocities.
BALLAST_INLINE Vector4 relative_velocity(const FrictionRecord& k, Vector8 wa, Vector8 wb) {
  const Vector4 p = halves(load8(k.rows[0][0]) * wa + load8(k.rows[1][0]) * wb);
  const Vector4 q = halves(load8(k.rows[0][1]) * wa + load8(k.rows[1][1]) * wb);
  const Vector4 s = halves(load8(k.rows[0][2]) * wa + load8(k.rows[1][2]) * wb);
  const Vector4 pq = __builtin_shufflevector(p, q, 0, 4, 2, 6) + __builtin_shufflevector(p, q, 1, 5, 3, 7);
  const Vector4 ss = __builtin_shufflevector(s, s, 0, 0, 2, 2) + __builtin_shufflevector(s, s, 1, 1, 3, 3);
  return __builtin_shufflevector(pq, ss, 0, 1, 4, 5) + __builtin_shufflevector(pq, ss, 2, 3, 6, 7);
}

BALLAST_FOR_EACH_CPU
void sweep_friction(FrictionRecord* records, int count, BodyVelocity* velocity) {
  for (int c = 0; c < count; ++c) {
    FrictionRecord& k = records[c];
    double* va = velocity[k.body[0]].w;
    double* vb = velocity[k.body[1]].w;
    const Vector8 wa = load8(va), wb = load8(vb);
    const Vector4 u = relative_velocity(k, wa, wb);
    double y = k.y[0] - (u[0] + k.bias[0]) * k.local.inverse_normal;
    double t1 = k.y[1] - (u[1] + k.bias[1]) * k.local.inverse_s1;
    double t2 = k.y[2] - (u[2] + k.bias[2]) * k.local.inverse_s2;
    apply_coulomb(k.local, y, t1, t2, k.slip);
    const double dy = y - k.y[0], d1 = t1 - k.y[1], d2 = t2 - k.y[2];
    k.y[0] = y;
    k.y[1] = t1;
    k.y[2] = t2;
    store8(va, wa + (load8(k.rows[0][0]) * dy + load8(k.rows[0][1]) * d1 + load8(k.rows[0][2]) * d2));
    store8(vb, wb + (load8(k.rows[1][0]) * dy + load8(k.rows[1][1]) * d1 + load8(k.rows[1][2]) * d2));
  }
}

BALLAST_FOR_EACH_CPU
void sweep_one_row(OneRowRecord* records, int count, BodyVelocity* velocity) {
  for (int c = 0; c < count; ++c) {
    OneRowRecord& k = records[c];
    double* va = velocity[k.body[0]].w;
    double* vb = velocity[k.body[1]].w;
    const Vector8 wa = load8(va), wb = load8(vb);
    const Vector4 p = halves(load8(k.rows[0]) * wa + load8(k.rows[1]) * wb);
    const double candidate = k.y - ((p[0] + p[1]) + (p[2] + p[3]) + k.bias) * k.inverse_normal;
    const double y = candidate <= 0.0 ? 0.0 : candidate;
    const double dy = y - k.y;
    k.y = y;
    store8(va, wa + load8(k.rows[0]) * dy);
    store8(vb, wb + load8(k.rows[1]) * dy);
  }
}

/// w += G^T (y, r_T) for impulses that start a solve. An impulse that moves nothing along the normal is dropped.
void load_friction(FrictionRecord& k, const TangentTurn& turn, const double* r, BodyVelocity* velocity) {
  const double weight = k.local.inverse_normal > 0.0 ? 1.0 : 0.0;
  double t1 = weight * r[1], t2 = weight * r[2];
  turn.to_principal(t1, t2);
  k.y[0] = weight * r[0] + k.local.c1 * t1 + k.local.c2 * t2;
  k.y[1] = t1;
  k.y[2] = t2;
  for (int s = 0; s < 2; ++s) {
    double* w = velocity[k.body[s]].w;
    const auto& rows = k.rows[s];
    for (int i = 0; i < body_width; ++i) w[i] += rows[0][i] * k.y[0] + rows[1][i] * k.y[1] + rows[2][i] * k.y[2];
  }
}

void load_one_row(OneRowRecord& k, double r, BodyVelocity* velocity) {
  k.y = k.inverse_normal > 0.0 ? r : 0.0;
  for (int s = 0; s < 2; ++s)
    for (int i = 0; i < body_width; ++i) velocity[k.body[s]].w[i] += k.rows[s][i] * k.y;
}

double friction_error(const FrictionRecord& k, double lambda_max, const BodyVelocity* velocity) {
  const Vector4 moved = relative_velocity(k, load8(velocity[k.body[0]].w), load8(velocity[k.body[1]].w));
  const double un = moved[0] + k.bias[0];
  const Eigen::Vector3d u(un, moved[1] + k.bias[1] + k.local.c1 * un, moved[2] + k.bias[2] + k.local.c2 * un);
  const Eigen::Vector3d r(k.y[0] - k.local.c1 * k.y[1] - k.local.c2 * k.y[2], k.y[1], k.y[2]);
  return ContactJudge::scaled_natural_map(r, u, k.local.mu, lambda_max);
}

double one_row_error(const OneRowRecord& k, double lambda_max, const BodyVelocity* velocity) {
  double u = k.bias;
  for (int s = 0; s < 2; ++s)
    for (int i = 0; i < body_width; ++i) u += k.rows[s][i] * velocity[k.body[s]].w[i];
  return ContactJudge::scaled_natural_map({k.y, 0.0, 0.0}, {u, 0.0, 0.0}, 0.0, lambda_max);
}

}  // namespace

void FrictionRecord::impulse(const TangentTurn& turn, double* r) const {
  double t1 = y[1], t2 = y[2];
  r[0] = y[0] - local.c1 * t1 - local.c2 * t2;
  turn.from_principal(t1, t2);
  r[1] = t1;
  r[2] = t2;
}

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
  int next[2] = {0, 0};  // record of each kind
  for (int c = 0; c < contacts; ++c) {
    const bool short_one = problem.contact_rows(c) == 1;
    if (runs_.empty() || runs_.back().one_row != short_one) runs_.push_back({short_one, c, next[short_one], 0});
    ++runs_.back().count;
    const int record = next[short_one]++;
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

/// One side's rows of G = H L^-T, padded with zeros. Returns the next block of H.
template <int Rows>
static const double* scale_side(const double* block, const MassRoot& root, double (*rows)[body_width]) {
  for (int i = 0; i < Rows; ++i) {
    for (int k = 0; k < body_width; ++k) rows[i][k] = k < root.dofs ? block[k * Rows + i] : 0.0;
    root.solve_lower(rows[i]);
  }
  return block + Rows * root.dofs;
}

/// Both sides; a side that does not move gets zero rows and the velocity that stays zero.
template <int Rows>
static void scale_rows(const DynamicsForm& dynamics, const std::vector<MassRoot>& roots, int c,
                       double (*rows)[Rows][body_width], int* body) {
  const double* block = dynamics.h.data() + dynamics.h_begin[c];
  const int bodies[2] = {dynamics.body_a[c], dynamics.body_b[c]};
  for (int s = 0; s < 2; ++s) {
    body[s] = bodies[s] < 0 ? dynamics.body_count() : bodies[s];
    if (bodies[s] < 0)
      std::fill(rows[s][0], rows[s][0] + Rows * body_width, 0.0);
    else
      block = scale_side<Rows>(block, roots[bodies[s]], rows[s]);
  }
}

static double dot(const double* a, const double* b) {
  double sum = 0.0;
  for (int k = 0; k < body_width; ++k) sum += a[k] * b[k];
  return sum;
}

void BodySweep::prepare_friction(const FrictionProblem& problem, int c, int record) {
  FrictionRecord& k = friction_[record];
  scale_rows<3>(problem.dynamics, roots_, c, k.rows, k.body);
  Eigen::Matrix3d w;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) w(i, j) = w(j, i) = dot(k.rows[0][i], k.rows[0][j]) + dot(k.rows[1][i], k.rows[1][j]);
  make_principal(w, problem.friction[c], k.local, turn_[record]);
  lambda_max_[record] = largest_eigenvalue(w);
  k.slip = 0.0;

  std::copy_n(problem.dynamics.bias.data() + problem.row_begin[c], 3, k.bias);
  turn_[record].to_principal(k.bias[1], k.bias[2]);
  k.bias[1] -= k.local.c1 * k.bias[0];
  k.bias[2] -= k.local.c2 * k.bias[0];
  const double cosine = turn_[record].cosine, sine = turn_[record].sine;
  for (auto& rows : k.rows)
    for (int i = 0; i < body_width; ++i) {
      const double n = rows[0][i], t1 = rows[1][i], t2 = rows[2][i];
      rows[1][i] = cosine * t1 + sine * t2 - k.local.c1 * n;
      rows[2][i] = cosine * t2 - sine * t1 - k.local.c2 * n;
    }
}

void BodySweep::prepare_one_row(const FrictionProblem& problem, int c, int record) {
  OneRowRecord& k = one_row_[record];
  double rows[2][1][body_width];
  scale_rows<1>(problem.dynamics, roots_, c, rows, k.body);
  for (int s = 0; s < 2; ++s) std::copy_n(rows[s][0], body_width, k.rows[s]);
  const double w = dot(k.rows[0], k.rows[0]) + dot(k.rows[1], k.rows[1]);
  k.inverse_normal = w > 0.0 ? 1.0 / w : 0.0;
  one_row_lambda_max_[record] = w;
  k.bias = problem.dynamics.bias[problem.row_begin[c]];
}

void BodySweep::load(const FrictionProblem& problem, const Impulses& r) {
  velocity_ = free_velocity_;
  for (const Run& run : runs_)
    for (int i = 0; i < run.count; ++i) {
      const double* rc = r.data() + problem.row_begin[run.first_contact + i];
      if (run.one_row)
        load_one_row(one_row_[run.first_record + i], rc[0], velocity_.data());
      else
        load_friction(friction_[run.first_record + i], turn_[run.first_record + i], rc, velocity_.data());
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

double BodySweep::error() const {
  double sum = 0.0;
  int counted = 0;
  for (const Run& run : runs_)
    for (int record = run.first_record; record < run.first_record + run.count; ++record) {
      const double lambda_max = run.one_row ? one_row_lambda_max_[record] : lambda_max_[record];
      if (!(lambda_max > 0.0)) continue;
      const double value = run.one_row ? one_row_error(one_row_[record], lambda_max, velocity_.data())
                                       : friction_error(friction_[record], lambda_max, velocity_.data());
      sum += value * value;
      ++counted;
    }
  return counted > 0 ? std::sqrt(sum / counted) : 0.0;
}

}  // namespace ballast

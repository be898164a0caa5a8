// The vectorised kernels against slow scalar twins that say the same in plain loops.

#include "solvers/gauss_seidel/sweep_kernels.hpp"

#include <cmath>
#include <vector>

#include "tests/catch.hpp"
#include "tests/solvers/gauss_seidel/record_samples.hpp"

using namespace ballast;

namespace {

/// A chain of bodies, contact c between bodies c and c + 1, with and without friction.
struct Chain {
  static constexpr int contacts = 40;  // more than the kernels fetch ahead
  std::vector<FrictionRecord> friction;
  std::vector<FrictionImpulse> impulses;
  std::vector<OneRowRecord> one_row;
  std::vector<double> one_row_impulses;
  std::vector<double> lambda_max, one_row_lambda_max;
  std::vector<BodyVelocity> velocity;

  explicit Chain(std::uint64_t seed) {
    Random random(seed);
    for (int c = 0; c < contacts; ++c) {
      FrictionRecord k = samples::Given(random).record();
      k.body[0] = c;
      k.body[1] = c + 1;
      TangentTurn turn;
      lambda_max.push_back(0.0);
      make_principal(k, random.uniform(0.0, 1.0), turn, lambda_max.back());
      friction.push_back(k);
      impulses.push_back({{0.1, 0.0, 0.0}, 0.0});
      OneRowRecord one{};
      for (int s = 0; s < 2; ++s)
        for (double& x : one.rows[s]) x = random.uniform(-1.0, 1.0);
      one.bias = random.uniform(-1.0, 0.5);
      one.body[0] = c;
      one.body[1] = c + 1;
      one_row_lambda_max.push_back(0.0);
      make_principal(one, one_row_lambda_max.back());
      one_row.push_back(one);
      one_row_impulses.push_back(0.05);
    }
    velocity.resize(contacts + 1);
    for (BodyVelocity& v : velocity) {
      for (double& x : v.w) x = random.uniform(-1.0, 1.0);
      v.w[6] = v.w[7] = 0.0;
    }
  }
};

/// One contact in plain loops: what sweep_friction does, by its definition.
void relax_slowly(const FrictionRecord& k, FrictionImpulse& r, BodyVelocity* velocity) {
  double u[3] = {k.bias[0], k.bias[1], k.bias[2]};
  for (int s = 0; s < 2; ++s)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < row_width; ++j) u[i] += k.rows[s][i][j] * velocity[k.body[s]].w[j];
  const double before[3] = {r.y[0], r.y[1], r.y[2]};
  r.y[0] -= u[0] * k.local.inverse_normal;
  r.y[1] -= u[1] * k.local.inverse_s1;
  r.y[2] -= u[2] * k.local.inverse_s2;
  apply_coulomb(k.local, r.y[0], r.y[1], r.y[2], r.slip);
  for (int s = 0; s < 2; ++s)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < row_width; ++j)
        velocity[k.body[s]].w[j] += k.rows[s][i][j] * (r.y[i] - before[i]);
}

void relax_slowly(const OneRowRecord& k, double& r, BodyVelocity* velocity) {
  double u = k.bias;
  for (int s = 0; s < 2; ++s)
    for (int j = 0; j < row_width; ++j) u += k.rows[s][j] * velocity[k.body[s]].w[j];
  const double change = std::max(0.0, r - u * k.inverse_normal) - r;
  r += change;
  for (int s = 0; s < 2; ++s)
    for (int j = 0; j < row_width; ++j) velocity[k.body[s]].w[j] += k.rows[s][j] * change;
}

/// Largest difference of impulses and velocities.
double difference(const Chain& a, const Chain& b) {
  double most = 0.0;
  for (int c = 0; c < Chain::contacts; ++c) {
    for (int i = 0; i < 3; ++i)
      most = std::max(most, std::abs(a.impulses[c].y[i] - b.impulses[c].y[i]));
    most = std::max(most, std::abs(a.one_row_impulses[c] - b.one_row_impulses[c]));
  }
  for (std::size_t k = 0; k < a.velocity.size(); ++k)
    for (int j = 0; j < body_width; ++j)
      most = std::max(most, std::abs(a.velocity[k].w[j] - b.velocity[k].w[j]));
  return most;
}

void sweep_fast(Chain& chain) {
  sweep_friction(chain.friction.data(), chain.impulses.data(), Chain::contacts,
                 chain.velocity.data());
  sweep_one_row(chain.one_row.data(), chain.one_row_impulses.data(), Chain::contacts,
                chain.velocity.data());
}

void sweep_slowly(Chain& chain) {
  for (int c = 0; c < Chain::contacts; ++c)
    relax_slowly(chain.friction[c], chain.impulses[c], chain.velocity.data());
  for (int c = 0; c < Chain::contacts; ++c)
    relax_slowly(chain.one_row[c], chain.one_row_impulses[c], chain.velocity.data());
}

}  // namespace

TEST_CASE("kernels: a sweep is what its definition says, contact after contact") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Chain fast(seed), twin(seed);
    for (int k = 0; k < 5; ++k) {
      sweep_fast(fast);
      sweep_slowly(twin);
      CHECK(difference(fast, twin) <= 1e-12);
    }
    for (const BodyVelocity& v : fast.velocity) {
      CHECK(v.w[6] == 0.0);  // what follows a row never comes into a velocity
      CHECK(v.w[7] == 0.0);
    }
    int pushed = 0, sliding = 0;
    for (const FrictionImpulse& r : fast.impulses) {
      pushed += r.y[0] > 0.0;
      sliding += r.slip > 0.0;
    }
    CHECK(pushed > 3);  // all three cases of the law have come
    CHECK(pushed < Chain::contacts);
    CHECK(sliding > 3);
  }
}

TEST_CASE("kernels: along a search every impulse moves by the formula and is then swept") {
  Chain fast(5), twin(5);
  std::vector<ImpulseSearch> search(Chain::contacts);
  std::vector<OneRowSearch> one_row_search(Chain::contacts);
  std::vector<Eigen::Vector4d> before(Chain::contacts, Eigen::Vector4d::Zero()), p = before;
  for (const SearchStep step : {SearchStep{0.0, 1.0}, {0.6, 1.0}, {0.3, 0.5}, {0.5, 0.2, 0.4}}) {
    const double square =
        sweep_friction(fast.friction.data(), fast.impulses.data(), search.data(), step,
                       Chain::contacts, fast.velocity.data()) +
        sweep_one_row(fast.one_row.data(), fast.one_row_impulses.data(), one_row_search.data(),
                      step, Chain::contacts, fast.velocity.data());
    // The twin: x are the three impulses with friction and the one without.
    double twin_square = 0.0;
    std::vector<Eigen::Vector4d> moved(Chain::contacts);
    const auto state = [&](int c) {
      const double* y = twin.impulses[c].y;
      return Eigen::Vector4d(y[0], y[1], y[2], twin.one_row_impulses[c]);
    };
    for (int c = 0; c < Chain::contacts; ++c) {
      const Eigen::Vector4d x = state(c), along = step.beta * p[c] + step.ahead * (x - before[c]);
      p[c] = along + step.gain * (x - before[c]);
      before[c] = moved[c] = x + along;
      for (int i = 0; i < 3; ++i) twin.impulses[c].y[i] = moved[c][i];
      twin.one_row_impulses[c] = moved[c][3];
    }
    sweep_slowly(twin);
    for (int c = 0; c < Chain::contacts; ++c) twin_square += (state(c) - moved[c]).squaredNorm();
    CHECK(difference(fast, twin) <= 1e-12);
    CHECK(square == Approx(twin_square).epsilon(1e-11));
  }
}

TEST_CASE("kernels: the slow way with the plain variant is the plain sweep") {
  Chain fast(6), twin(6);
  sweep_fast(fast);
  for (int c = 0; c < Chain::contacts; ++c)
    resolve_by_variant({}, twin.friction[c], twin.impulses[c], twin.lambda_max[c],
                       twin.velocity.data());
  for (int c = 0; c < Chain::contacts; ++c)
    resolve_by_variant({}, twin.one_row[c], twin.one_row_impulses[c], twin.velocity.data());
  CHECK(difference(fast, twin) <= 1e-12);
}

TEST_CASE("kernels: over-relaxation of one row goes that much further, and never below zero") {
  Chain chain(7);
  const OneRowRecord& k = chain.one_row[0];
  double exact = 0.05, relaxed = 0.05;
  std::vector<BodyVelocity> copy = chain.velocity;
  resolve_by_variant({}, k, exact, copy.data());
  resolve_by_variant({.relaxation = 1.5}, k, relaxed, chain.velocity.data());
  CHECK(relaxed == Approx(std::max(0.0, 0.05 + 1.5 * (exact - 0.05))));
}

// Compiled with -fno-trapping-math (problems/CMakeLists.txt): both sides of every choice are
// computed, and the loops become vector instructions. No bit depends on it.

#include "problems/algebra/judge_block.hpp"

#include <cmath>

#include "platform/for_each_cpu.hpp"

namespace ballast {
namespace {

#define BALLAST_IN_LOOP [[gnu::always_inline]] inline

struct Rows {
  double n, t, s;
};
BALLAST_IN_LOOP double dot(const Rows& x, const Rows& y) {
  return x.n * y.n + x.t * y.t + x.s * y.s;
}
BALLAST_IN_LOOP double norm(const Rows& x) { return std::sqrt(dot(x, x)); }
BALLAST_IN_LOOP double tangential(const Rows& x) { return std::sqrt(x.t * x.t + x.s * x.s); }

/// x - P_K(y)
BALLAST_IN_LOOP Rows less_projected(const Rows& x, const Rows& y, double mu) {
  const double t = tangential(y);
  const bool polar = mu * t <= -y.n, inside = t <= mu * y.n;
  const double n = (mu * t + y.n) / (1.0 + mu * mu);
  const double scale = mu * n / t;
  const auto projected = [=](double own, double side) __attribute__((always_inline)) {
    return polar ? 0.0 : inside ? own : side;
  };
  return {x.n - projected(y.n, n), x.t - projected(y.t, scale * y.t),
          x.s - projected(y.s, scale * y.s)};
}

BALLAST_IN_LOOP Rows natural_map(const Rows& r, const Rows& modified, double mu, double rho) {
  const Rows x{r.n - rho * modified.n, r.t - rho * modified.t, r.s - rho * modified.s};
  return less_projected(r, x, mu);
}

BALLAST_IN_LOOP double eigenvalue(double nn, double tn, double sn, double tt, double st,
                                  double ss) {
  const double off = tn * tn + sn * sn + st * st;
  const double mean = (nn + (tt + ss)) * (1.0 / 3.0);
  const double x = nn - mean, y = tt - mean, z = ss - mean;
  const double square = (x * x + y * y + z * z + 2.0 * off) * (1.0 / 6.0);
  const double spread = std::sqrt(square);
  const double determinant =
      x * (y * z - st * st) - tn * (tn * z - st * sn) + sn * (tn * st - y * sn);
  const double cosine = 0.5 + 0.25 * determinant / (square * spread);
  const double not_below = cosine < 0.0 ? 0.0 : cosine;
  const double s = std::sqrt(not_below > 1.0 ? 1.0 : not_below);
  double w = 0.57729 + s * (-0.10927 + s * (0.04318 - 0.01123 * s));
  for (int step = 0; step < 2; ++step)
    w -= (w * w * (3.0 + 2.0 * s * w) - 1.0) / (6.0 * w * (1.0 + s * w));
  const double full = mean + spread * (1.0 + 2.0 * s * w);
  // A diagonal block: the fractions above are 0 / 0 where its entries are equal.
  const double two = nn < tt ? tt : nn, three = two < ss ? ss : two;
  return off == 0.0 ? three : full;
}

BALLAST_FOR_EACH_CPU void find_scales(JudgeBlock& b) {
  for (int k = 0; k < JudgeBlock::size; ++k)
    b.lambda[k] = eigenvalue(b.nn[k], b.tn[k], b.sn[k], b.tt[k], b.st[k], b.ss[k]);
}

BALLAST_FOR_EACH_CPU void find_measures(JudgeBlock& b) {
  for (int k = 0; k < JudgeBlock::size; ++k) {
    const Rows r{b.r[0][k], b.r[1][k], b.r[2][k]}, u{b.u[0][k], b.u[1][k], b.u[2][k]};
    const Rows q{b.q[0][k], b.q[1][k], b.q[2][k]};
    const double mu = b.mu[k], lambda = b.lambda[k];
    const double inverse = 1.0 / lambda, rho = lambda > 0.0 ? inverse : 0.0;
    const Rows modified{u.n + mu * tangential(u), u.t, u.s};
    const double impulse = norm(r), work = std::abs(dot(r, modified));
    // The natural map, scaled and not; the size of impulses.
    const Rows map = natural_map(r, modified, mu, 1.0);
    b.scaled_map[k] = norm(natural_map(r, modified, mu, inverse)) * lambda;
    b.map_square[k] = dot(map, map);
    b.impulse[k] = impulse;
    b.needed[k] = rho * norm(q);
    // The parts of the law.
    b.approach[k] = 0.0 < -u.n ? -u.n : 0.0;
    b.outside[k] = norm(less_projected(r, r, mu));
    b.work[k] = work;
    const double against = impulse + rho * norm(modified), ratio = work / against;
    b.unbalanced[k] = against > 0.0 ? ratio : 0.0;
  }
}

}  // namespace

void measure(JudgeBlock& block) {
  find_scales(block);
  find_measures(block);
}

double largest_eigenvalue(const Eigen::Matrix3d& w) {
  return eigenvalue(w(0, 0), w(1, 0), w(2, 0), w(1, 1), w(2, 1), w(2, 2));
}

}  // namespace ballast

// Sweeps in single precision, made good in double at every look at the error.
//
// At a look the impulses are taken to double and push the bodies in double; each contact's velocity
// that follows becomes its bias, and the bodies of the single state start at zero again. So where
// the single sweeps come to rest is the double problem's solution, and what they round is the
// change since the last look. What is left is the rounding of the impulses themselves.

#include <algorithm>
#include <cmath>

#include "solvers/gauss_seidel/wide_sweep.hpp"

namespace ballast {
namespace {

/// Rounding of single precision may be this share of the error.
constexpr double allowed_share = 1.0 / 30.0;

constexpr double single_rounding = 0x1p-24;

template <typename From, typename To, int Rows>
void cast_rows(const From (&from)[Rows][group_lanes], To (&to)[Rows][group_lanes]) {
  for (int i = 0; i < Rows; ++i)
    for (int lane = 0; lane < group_lanes; ++lane) to[i][lane] = static_cast<To>(from[i][lane]);
}

template <typename From, typename To>
void cast_lanes(const From (&from)[group_lanes], To (&to)[group_lanes]) {
  for (int lane = 0; lane < group_lanes; ++lane) to[lane] = static_cast<To>(from[lane]);
}

/// A body's row takes half as many bytes.
constexpr int halved(int offset) { return offset / 2; }

template <typename Double, typename Single>
void cast_group(const Double& k, Single& s) {
  cast_rows(k.bias, s.bias);
  cast_rows(k.inverse_mass, s.inverse_mass);
  for (int i = 0; i < Double::rows; ++i) {
    cast_rows(k.line[i], s.line[i]);
    for (int side = 0; side < 2; ++side) cast_rows(k.turn[side][i], s.turn[side][i]);
  }
  for (int side = 0; side < 2; ++side)
    for (int lane = 0; lane < group_lanes; ++lane) s.body[side][lane] = halved(k.body[side][lane]);
  if constexpr (requires { k.mu; }) {
    cast_lanes(k.s2, s.s2);
    cast_lanes(k.inverse_s2, s.inverse_s2);
    cast_lanes(k.c1, s.c1);
    cast_lanes(k.c2, s.c2);
    cast_lanes(k.mu, s.mu);
    cast_lanes(k.inverse_mu, s.inverse_mu);
  }
  if constexpr (requires { k.wall; }) {
    cast_lanes(k.wall, s.wall);
    s.wall_body = halved(k.wall_body);
  }
}

}  // namespace

/// Records are cast once for each prepare(), impulses now; what follows from them is that of the
/// rounded impulses.
void WideSweep::enter_single() {
  single_begins_ = false;
  in_single_ = true;
  const auto enter = [this](const auto& exact, auto& single) {
    single.impulses.resize(exact.groups.size());
    if (!single_made_) {
      single.groups.resize(exact.groups.size());
      for (size_t g = 0; g < exact.groups.size(); ++g)
        cast_group(exact.groups[g], single.groups[g]);
    }
    for (size_t g = 0; g < exact.groups.size(); ++g) {
      cast_rows(exact.impulses[g].y, single.impulses[g].y);
      cast_lanes(exact.impulses[g].miss, single.impulses[g].miss);
    }
  };
  enter(exact_.friction, single_.friction);
  enter(exact_.one_row, single_.one_row);
  enter(exact_.wall, single_.wall);
  single_made_ = true;
  single_.bodies.assign(exact_.bodies.size(), {});
  start_search();
  refresh();
  error_in_double();  // for the biases
}

/// The iterate in double. Returns the rms distance over bodies between the velocities that the
/// single sweeps had and those that their impulses give [m/s].
double WideSweep::refresh() {
  const auto widen = [](const auto& single, auto& exact) {
    for (size_t g = 0; g < single.impulses.size(); ++g) {
      cast_rows(single.impulses[g].y, exact.impulses[g].y);
      cast_lanes(single.impulses[g].miss, exact.impulses[g].miss);
    }
  };
  widen(single_.friction, exact_.friction);
  widen(single_.one_row, exact_.one_row);
  widen(single_.wall, exact_.wall);
  const std::vector<BodyRow<double>>& last = last_bodies_;
  last_bodies_.swap(exact_.bodies);
  push_all();
  // How far the single sweeps were off; their bodies start at zero, and the last change stays.
  double square = 0.0;
  for (size_t b = 0; b < last.size(); ++b) {
    for (int i = 0; i < 3; ++i) {
      const double off = exact_.bodies[b].w[i] - last[b].w[i] - single_.bodies[b].w[i];
      square += off * off;
    }
    for (int i = 0; i < 8; ++i) single_.before[b].w[i] -= single_.bodies[b].w[i];
    single_.bodies[b] = {};
  }
  return std::sqrt(square / static_cast<double>(last.size()));
}

/// The rounding of an impulse, as a velocity of its contact, is no smaller than 2^-24 n y'.
bool WideSweep::single_suffices(double error, double drift) const {
  double square = 0.0;
  exact_.for_kinds([&square](const auto& kind) {
    for (size_t g = 0; g < kind.groups.size(); ++g)
      for (int lane = 0; lane < group_lanes; ++lane) {
        const double y = kind.frames[g].normal[lane] * kind.impulses[g].y[0][lane];
        square += y * y;
      }
  });
  const double rounding = single_rounding * std::sqrt(square / std::max(1, contacts_));

  return rounding + drift <= allowed_share * error;
}

void WideSweep::leave_single() {
  in_single_ = false;
  start_search();
}

bool WideSweep::finish_in_double() {
  single_begins_ = false;
  if (!in_single_) return false;
  // One more sweep in double: every contact then obeys its law as if all sweeps had been.
  refresh();
  leave_single();
  sweep();
  start_search();
  return true;
}

}  // namespace ballast

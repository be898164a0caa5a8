// Sweeps in single precision, made good in double at every look at the error.
//
// At a look the impulses are taken to double and push the bodies in double; each contact's velocity
// that follows becomes its bias, and the bodies of the single state start at zero again. So where
// the single sweeps come to rest is the double problem's solution, and what they round is the
// change since the last look. What is left is the rounding of the impulses themselves.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "solvers/gauss_seidel/wide_sweep.hpp"

namespace ballast {
namespace {

/// Rounding of single precision may be this share of the error.
constexpr double allowed_share = 1.0 / 30.0;

constexpr double single_rounding = 0x1p-24;

/// A contact rests that opens this many times as fast as the error: on the box as many sweeps are
/// then taken as without rests; a few more with 4 and less.
constexpr double rests_from = 16.0;

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
  const auto make_room = [](const auto& exact, auto& single) {
    single.impulses.resize(exact.groups.size());
    single.groups.resize(exact.groups.size());
    single.awake.resize(exact.groups.size());
  };
  make_room(exact_.friction, single_.friction);
  make_room(exact_.one_row, single_.one_row);
  make_room(exact_.wall, single_.wall);
  for_parts(exact_, [this](const Part& part) {
    const auto enter = [this](const auto& exact, auto& single, Range range) {
      for (int g = range.begin; g < range.begin + range.count; ++g) {
        if (!single_made_) cast_group(exact.groups[g], single.groups[g]);
        cast_rows(exact.impulses[g].y, single.impulses[g].y);
        cast_lanes(exact.impulses[g].miss, single.impulses[g].miss);
      }
    };
    enter(exact_.friction, single_.friction, part.friction);
    enter(exact_.one_row, single_.one_row, part.one_row);
    enter(exact_.wall, single_.wall, part.wall);
  });
  single_made_ = true;
  single_.bodies.assign(exact_.bodies.size(), {});
  last_bodies_ = exact_.bodies;
  start_search();
  refresh();
  choose_awake(error_in_double());  // which makes the biases, too
}

/// The iterate in double, and how large its impulses are.
void WideSweep::refresh() {
  last_bodies_.swap(exact_.bodies);
  for_parts(exact_, [this](Part& part) {
    double squares[group_lanes] = {};
    const auto widen = [&squares](const auto& single, auto& exact, Range range) {
      for (int g = range.begin; g < range.begin + range.count; ++g) {
        cast_rows(single.impulses[g].y, exact.impulses[g].y);
        cast_lanes(single.impulses[g].miss, exact.impulses[g].miss);
        for (int lane = 0; lane < group_lanes; ++lane) {
          const double y = exact.frames[g].normal[lane] * exact.impulses[g].y[0][lane];
          squares[lane] += y * y;
        }
      }
    };
    widen(single_.friction, exact_.friction, part.friction);
    widen(single_.one_row, exact_.one_row, part.one_row);
    widen(single_.wall, exact_.wall, part.wall);
    part.impulse_square = std::accumulate(squares, squares + group_lanes, 0.0);
    push_part(part);
  });
}

/// How far the single sweeps were off, over a slab's bodies: between the velocities that they had
/// and those that their impulses give. The single bodies start at zero, and the last change stays.
void WideSweep::settle(Part& part) {
  part.drift_square = 0.0;
  for (int b = part.bodies.begin; b < part.bodies.begin + part.bodies.count; ++b) {
    for (int i = 0; i < 3; ++i) {
      const double off = exact_.bodies[b].w[i] - last_bodies_[b].w[i] - single_.bodies[b].w[i];
      part.drift_square += off * off;
    }
    for (int i = 0; i < 8; ++i) single_.before[b].w[i] -= single_.bodies[b].w[i];
    single_.bodies[b] = {};
  }
}

/// The rounding of an impulse, as a velocity of its contact, is no smaller than 2^-24 n y'. Beside
/// it stands the rms drift of the bodies' velocities.
bool WideSweep::single_suffices(double error) const {
  double impulses = 0.0, drift = 0.0, bodies = 0.0;
  for (const std::vector<Part>* parts : {&interiors_, &interfaces_})
    for (const Part& part : *parts) {
      impulses += part.impulse_square;
      drift += part.drift_square;
      bodies += part.bodies.count;
    }
  const double rounding = single_rounding * std::sqrt(impulses / std::max(1, contacts_));
  return rounding + std::sqrt(drift / bodies) <= allowed_share * error;
}

/// A group rests whose contacts have no impulse and open by far: the sweep would leave them so. One
/// that closes in between is seen by the next look.
void WideSweep::choose_awake(double error) {
  const double least =
      may_rest_ ? rests_from * error : std::numeric_limits<double>::infinity();  // [m/s]
  const auto rests = [least](const auto& kind, const GroupFrame& frame, int g) {
    const auto& y = kind.impulses[g].y;
    for (int lane = 0; lane < group_lanes; ++lane) {
      if (frame.contact[lane] < 0) continue;
      if (!(frame.normal[lane] * kind.groups[g].bias[0][lane] > least)) return false;
      for (size_t i = 0; i < std::size(y); ++i)
        if (y[i][lane] != 0 || (!kind.search.empty() && (kind.search[g].direction[i][lane] != 0 ||
                                                         kind.search[g].change[i][lane] != 0)))
          return false;
    }
    return true;
  };
  for_parts(exact_, [&](Part& part) {
    const auto choose = [&](const auto& exact, auto& single, Range& range) {
      range.awake = 0;
      for (int g = 0; g < range.count; ++g)
        if (!rests(single, exact.frames[range.begin + g], range.begin + g))
          single.awake[range.begin + range.awake++] = g;
    };
    choose(exact_.friction, single_.friction, part.friction);
    choose(exact_.one_row, single_.one_row, part.one_row);
    choose(exact_.wall, single_.wall, part.wall);
  });
}

int WideSweep::resting_groups() const {
  int resting = 0;
  for (const std::vector<Part>* parts : {&interiors_, &interfaces_})
    for (const Part& part : *parts)
      for (const Range& range : {part.friction, part.one_row, part.wall})
        resting += in_single_ ? range.count - range.awake : 0;
  return resting;
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

#include "solvers/gauss_seidel/wide_sweep.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>

namespace ballast {
namespace {

/// The rounding of single precision may be up to this share of the error.
constexpr double allowed_share = 1.0 / 30.0;

constexpr double single_rounding = 0x1p-24;

/// A contact may rest if it opens faster than this many times the error. On the box the number of
/// sweeps is then the same as without rests; with 4 and less it is slightly larger.
constexpr double rests_from = 16.0;

/// Records with more bytes than this do not stay in a core's cache from sweep to sweep.
constexpr size_t far_bytes = 4 << 20;

template <typename From, typename To, int Rows>
void cast_rows(const From (&from)[Rows][group_lanes], To (&to)[Rows][group_lanes]) {
  for (int i = 0; i < Rows; ++i)
    for (int lane = 0; lane < group_lanes; ++lane) to[i][lane] = static_cast<To>(from[i][lane]);
}

template <typename From, typename To>
void cast_lanes(const From (&from)[group_lanes], To (&to)[group_lanes]) {
  for (int lane = 0; lane < group_lanes; ++lane) to[lane] = static_cast<To>(from[lane]);
}

/// Byte offsets of body rows are half as large in single precision.
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

void WideSweep::load(const FrictionProblem& problem, const Impulses& r) {
  for_parts_in_phases(exact_, [&](const Part& part) {
    for_each_kind(
        [&](auto& kind, const Range& range) {
          for (int g = range.begin; g < range.begin + range.count; ++g) {
            kind.impulses[g] = {};
            const GroupFrame& f = kind.frames[g];
            auto& y = kind.impulses[g].y;
            for (int i = 0; i < group_lanes; ++i) {
              if (f.contact[i] < 0) continue;
              const double* rc = r.data() + problem.row_begin[f.contact[i]];
              // The y' of group_kernels.hpp: n r_N + c' . (t r_T), with r_T turned to the principal
              // tangents.
              y[0][i] = f.normal[i] * rc[0];
              if constexpr (requires { kind.groups[g].mu; }) {
                const auto& k = kind.groups[g];
                y[1][i] = f.tangent[i] * (f.cosine[i] * rc[1] + f.sine[i] * rc[2]);
                y[2][i] = f.tangent[i] * (f.cosine[i] * rc[2] - f.sine[i] * rc[1]);
                y[0][i] += k.c1[i] * y[1][i] + k.c2[i] * y[2][i];
              }
            }
          }
        },
        exact_, part);
    push_part(part);
  });
  in_single_ = false;
  single_begins_ = single_allowed_;
}

/// Gives a slab's bodies their free velocities; then every impulse of the part pushes once.
void WideSweep::push_part(const Part& part) {
  std::copy_n(free_.begin() + part.bodies.begin, part.bodies.count,
              exact_.bodies.begin() + part.bodies.begin);
  for_each_kind(
      [this](const auto& kind, const auto& loops, const Range& range) {
        loops.push(kind.groups.data() + range.begin, kind.impulses.data() + range.begin,
                   range.count, exact_.bodies.data());
      },
      exact_, kernels_->exact, part);
}

/// Prefetches all body rows that another core may have written last. Fetched one by one, as the
/// groups of an interface need them, each would take a hundred nanoseconds and more.
template <typename Number>
void WideSweep::prefetch_shared(const State<Number>& state, const Part& interface) const {
  constexpr int line = 64;  // bytes
  const Part* lower = &interface - plan_.slabs();
  for (const Part* slab : {lower, lower + 1}) {
    const char* row = reinterpret_cast<const char*>(state.bodies.data() + slab->bodies.begin);
    for (const char* end = row + slab->shared * sizeof(BodyRow<Number>); row < end; row += line)
      __builtin_prefetch(row, 1);
  }
}

void WideSweep::store(const FrictionProblem& problem, Impulses& r) const {
  // Contacts between two bodies that never move belong to no group.
  r.setZero(problem.row_count());
  for_parts_by_slab([&](int part) {
    for_each_kind(
        [&](const auto& kind, const Range& range) {
          for (int g = range.begin; g < range.begin + range.count; ++g) {
            const GroupFrame& f = kind.frames[g];
            const auto& y = kind.impulses[g].y;
            for (int i = 0; i < group_lanes; ++i) {
              if (f.contact[i] < 0) continue;
              double* rc = r.data() + problem.row_begin[f.contact[i]];
              rc[0] = f.inverse_normal[i] * y[0][i];
              if constexpr (requires { kind.groups[g].mu; }) {
                const auto& k = kind.groups[g];
                rc[0] = f.inverse_normal[i] * (y[0][i] - k.c1[i] * y[1][i] - k.c2[i] * y[2][i]);
                const double t1 = f.inverse_tangent[i] * y[1][i],
                             t2 = f.inverse_tangent[i] * y[2][i];
                rc[1] = f.cosine[i] * t1 - f.sine[i] * t2;
                rc[2] = f.sine[i] * t1 + f.cosine[i] * t2;
              }
            }
          }
        },
        exact_, parts_[part]);
  });
}

/// Sweeps one part, or two parts without a common body: first the contacts with friction of both,
/// then the one-row contacts, then those on driven walls.
template <typename Number, typename Kernels>
void WideSweep::sweep_parts(State<Number>& state, const Kernels& kernels, const SearchStep* step,
                            std::span<Part> parts) {
  for (Part& part : parts) part.change_square = 0.0;
  const auto sweep_kind = [&](auto& kind, const auto& loops, Range Part::*range) {
    using Run = typename std::decay_t<decltype(kind)>::Loops::Run;
    Run runs[2] = {};
    for (size_t k = 0; k < parts.size(); ++k) {
      const Range at = parts[k].*range;
      constexpr bool all = std::is_same_v<Number, double>;
      runs[k] = {kind.groups.data() + at.begin,
                 kind.impulses.data() + at.begin,
                 kind.search.empty() ? nullptr : kind.search.data() + at.begin,
                 all ? nullptr : kind.awake.data() + at.begin,
                 all ? at.count : at.awake,
                 kind.groups.size() * sizeof kind.groups[0] > far_bytes};
    }
    double squares[2] = {};
    loops.sweep(runs, step, state.bodies.data(), squares);
    for (size_t k = 0; k < parts.size(); ++k) parts[k].change_square += squares[k];
  };
  sweep_kind(state.friction, kernels.friction, &Part::friction);
  sweep_kind(state.one_row, kernels.one_row, &Part::one_row);
  sweep_kind(state.wall, kernels.wall, &Part::wall);
}

/// Sweeps the interiors, after their bodies' step along a search, then the interfaces.
template <typename Number, typename Kernels>
double WideSweep::sweep_in(State<Number>& state, const Kernels& kernels, const SearchStep* step) {
  for_pairs(std::span(parts_).first(plan_.slabs()), [&](std::span<Part> parts) {
    for (const Part& part : parts)
      if (step)
        kernels.move_bodies(part.bodies.count, *step, state.bodies.data() + part.bodies.begin,
                            state.before.data() + part.bodies.begin,
                            state.direction.data() + part.bodies.begin);
    sweep_parts(state, kernels, step, parts);
  });
  for_pairs(std::span(parts_).subspan(plan_.slabs()), [&](std::span<Part> parts) {
    for (const Part& part : parts) prefetch_shared(state, part);
    sweep_parts(state, kernels, step, parts);
  });
  double square = 0.0;
  for (const Part& part : parts_) square += part.change_square;
  return square;
}

double WideSweep::sweep_in_precision(const SearchStep* step) {
  if (single_begins_) error();
  if (step && !in_single_ && search_begins_) start_search_in(exact_);
  ++unseen_;
  return in_single_ ? sweep_in(single_, kernels_->single, step)
                    : sweep_in(exact_, kernels_->exact, step);
}

template <typename Number>
void WideSweep::start_search_in(State<Number>& state) {
  search_begins_ = false;
  for_each_kind([](auto& kind) { kind.search.assign(kind.groups.size(), {}); }, state);
  state.before = state.bodies;
  state.direction.assign(state.bodies.size(), {});
}

/// In double the search starts only with the first sweep_along(), which most solves never call.
void WideSweep::start_search() {
  search_begins_ = !in_single_;
  if (in_single_) start_search_in(single_);
}

double WideSweep::error() {
  if (!single_begins_ && !in_single_) return error_in(exact_, kernels_->exact);
  const bool begins = single_begins_;
  begins ? enter_single() : refresh();
  seen_error_ = error_in(exact_, kernels_->exact);
  for_parts_in_phases(exact_, [this](Part& part) { settle(part); });
  unseen_ = 0;
  begins || single_suffices(seen_error_) ? choose_awake(seen_error_) : leave_single();
  return seen_error_;
}

/// Calls error() before rounding could show in the rough error, and after many sweeps without it.
double WideSweep::rough_error() {
  constexpr int most_unseen = 64;
  constexpr double least_share = 1.0 / 32.0;
  if (!in_single_ || unseen_ >= most_unseen) return error();
  const double rough = error_in(single_, kernels_->single);
  if (!(rough > least_share * seen_error_)) return error();
  choose_awake(rough);
  return rough;
}

template <typename Number, typename Kernels>
double WideSweep::error_in(const State<Number>& state, const Kernels& kernels) {
  for_parts_in_phases(state, [&](Part& part) {
    part.error_square = 0.0;
    for_each_kind(
        [&](const auto& kind, const auto& exact, auto& single, const auto& loops, Range range) {
          part.error_square +=
              loops.error(kind.groups.data() + range.begin, kind.impulses.data() + range.begin,
                          exact.frames.data() + range.begin, range.count, state.bodies.data(),
                          in_single_ ? single.seen.data() + range.begin : nullptr);
        },
        state, exact_, single_, kernels, part);
  });
  double sum = 0.0;
  for (const Part& part : parts_) sum += part.error_square;
  return contacts_ > 0 ? std::sqrt(sum / contacts_) : 0.0;
}

// Sweeps in single precision, corrected in double by every error().
//
// error() casts the impulses to double and lets them push the bodies in double. Each contact's
// resulting velocity becomes its bias, and the bodies of the single state start at zero again. The
// fixed point of the single sweeps is therefore the solution of the double problem, and they round
// only the change since that error(). The rounding of the impulses themselves remains.

/// Casts the impulses, and the records once for each prepare().
void WideSweep::enter_single() {
  single_begins_ = false;
  in_single_ = true;
  for_each_kind(
      [](const auto& exact, auto& single) {
        single.impulses.resize(exact.groups.size());
        single.groups.resize(exact.groups.size());
        single.seen.resize(exact.groups.size());
        single.awake.resize(exact.groups.size());
      },
      exact_, single_);
  for_parts_in_phases(exact_, [this](const Part& part) {
    for_each_kind(
        [this](const auto& exact, auto& single, const Range& range) {
          for (int g = range.begin; g < range.begin + range.count; ++g) {
            if (!single_made_) cast_group(exact.groups[g], single.groups[g]);
            cast_rows(exact.impulses[g].y, single.impulses[g].y);
            cast_lanes(exact.impulses[g].miss, single.impulses[g].miss);
          }
        },
        exact_, single_, part);
  });
  single_made_ = true;
  single_.bodies.assign(exact_.bodies.size(), {});
  last_bodies_ = exact_.bodies;
  start_search();
}

/// Casts the iterate to double and sums the squares of its normal impulses, as velocities n y'.
void WideSweep::refresh() {
  last_bodies_.swap(exact_.bodies);
  for_parts_in_phases(exact_, [this](Part& part) {
    double squares[group_lanes] = {};
    for_each_kind(
        [&squares](const auto& single, auto& exact, const Range& range) {
          for (int g = range.begin; g < range.begin + range.count; ++g) {
            cast_rows(single.impulses[g].y, exact.impulses[g].y);
            cast_lanes(single.impulses[g].miss, exact.impulses[g].miss);
            for (int lane = 0; lane < group_lanes; ++lane) {
              const double y = exact.frames[g].normal[lane] * exact.impulses[g].y[0][lane];
              squares[lane] += y * y;
            }
          }
        },
        single_, exact_, part);
    part.impulse_square = std::accumulate(squares, squares + group_lanes, 0.0);
    push_part(part);
  });
}

/// Sums the squared drift of a slab's bodies: the difference of the velocities that the impulses
/// give and those that the single sweeps had. Then the single bodies start at zero (with the last
/// change kept), and the contacts' velocities become their biases.
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
  for_each_kind(
      [](auto& single, const Range& range) {
        for (int g = range.begin; g < range.begin + range.count; ++g)
          cast_rows(single.seen[g].u, single.groups[g].bias);
      },
      single_, part);
}

/// Compares two estimates of rounding with the error: the rounding of impulses, as velocities of
/// their contacts no smaller than 2^-24 n y' (rms), and the rms drift of the bodies' velocities.
bool WideSweep::single_suffices(double error) const {
  double impulses = 0.0, drift = 0.0, bodies = 0.0;
  for (const Part& part : parts_) {
    impulses += part.impulse_square;
    drift += part.drift_square;
    bodies += part.bodies.count;
  }
  const double rounding = single_rounding * std::sqrt(impulses / std::max(1, contacts_));
  return rounding + std::sqrt(drift / bodies) <= allowed_share * error;
}

/// Lets a group rest if its contacts have no impulse and open fast: a sweep would leave them so.
/// The next error evaluation sees a contact that closes in between.
void WideSweep::choose_awake(double error) {
  const double least =
      may_rest_ ? rests_from * error : std::numeric_limits<double>::infinity();  // [m/s]
  const auto rests = [least](const auto& kind, const GroupFrame& frame, int g) {
    const auto& y = kind.impulses[g].y;
    for (int lane = 0; lane < group_lanes; ++lane) {
      if (frame.contact[lane] < 0) continue;
      if (!(frame.normal[lane] * kind.seen[g].u[0][lane] > least)) return false;
      for (size_t i = 0; i < std::size(y); ++i)
        if (y[i][lane] != 0 || (!kind.search.empty() && (kind.search[g].direction[i][lane] != 0 ||
                                                         kind.search[g].change[i][lane] != 0)))
          return false;
    }
    return true;
  };
  for_parts_in_phases(exact_, [&](Part& part) {
    for_each_kind(
        [&](const auto& exact, auto& single, Range& range) {
          range.awake = 0;
          for (int g = 0; g < range.count; ++g)
            if (!rests(single, exact.frames[range.begin + g], range.begin + g))
              single.awake[range.begin + range.awake++] = g;
        },
        exact_, single_, part);
  });
}

int WideSweep::resting_groups() const {
  int resting = 0;
  for (const Part& part : parts_)
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
  // After one more sweep in double every contact obeys its law as if all sweeps had been in double.
  refresh();
  leave_single();
  sweep();
  start_search();
  return true;
}

}  // namespace ballast

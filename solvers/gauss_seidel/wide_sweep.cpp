#include "solvers/gauss_seidel/wide_sweep.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>

namespace ballast {
namespace {

/// The rounding of single precision may be up to this share of the error.
constexpr double allowed_share = 1.0 / 30.0;

/// Of records and impulses in single precision: what they change in the error, over the impulses as
/// velocities n y' of their contacts, rms. On captured steps of the box at most a sixth of it.
constexpr double single_rounding = 0x1p-24;

/// A contact may rest if it opens faster than this many times the error. On the box the number of
/// sweeps is then the same as without rests; with 4 and less it is slightly larger.
constexpr double rests_from = 16.0;

/// Records with more bytes than this do not stay in a core's cache from sweep to sweep.
constexpr size_t far_bytes = 4 << 20;

/// Puts an impulse that is on its cone up to rounding there.
void put_on_cone(double mu, double* r) {
  r[0] = std::max(r[0], 0.0);
  const double most = mu * r[0], tangential = std::sqrt(r[1] * r[1] + r[2] * r[2]);
  if (!(tangential > most)) return;
  r[1] *= most / tangential;
  r[2] *= most / tangential;
}

}  // namespace

void WideSweep::load(const FrictionProblem& problem, const Impulses& r) {
  problem_ = &problem;
  start_ = r;
  at_start_ = true;
  in_single_ = single_begins_ = single_allowed_;
  start_search();
  in_single_ ? load_into(single_, r) : load_into(exact_, r);
}

template <typename Number>
void WideSweep::load_into(State<Number>& state, const Impulses& r) {
  if constexpr (std::is_same_v<Number, double>)
    need_exact();
  else
    state.bodies.assign(exact_.bodies.size(), {});
  for_parts_in_phases(exact_, [&](Part& part) {
    for_each_kind(
        [&](auto& kind, const auto& exact, const Range& range) {
          for (int g = range.begin; g < range.begin + range.count; ++g) {
            kind.impulses[g] = {};
            const GroupFrame& f = exact.frames[g];
            auto& y = kind.impulses[g].y;
            for (int i = 0; i < group_lanes; ++i) {
              if (f.contact[i] < 0) continue;
              const double* rc = r.data() + problem_->row_begin[f.contact[i]];
              // The y' of group_kernels.hpp: n r_N + c' . (t r_T), with r_T turned to the principal
              // tangents.
              double normal = f.normal[i] * rc[0];
              if constexpr (requires { kind.groups[g].mu; }) {
                const auto& k = kind.groups[g];
                const double t1 = f.tangent[i] * (f.cosine[i] * rc[1] + f.sine[i] * rc[2]),
                             t2 = f.tangent[i] * (f.cosine[i] * rc[2] - f.sine[i] * rc[1]);
                normal += k.c1[i] * t1 + k.c2[i] * t2;
                y[1][i] = static_cast<Number>(t1);
                y[2][i] = static_cast<Number>(t2);
              }
              y[0][i] = static_cast<Number>(normal);
            }
          }
        },
        state, exact_, part);
    push_part(state, part);
  });
  if (in_single_) last_bodies_ = exact_.bodies;
}

/// Gives a slab's bodies their free velocities; then every impulse of the part pushes once. In
/// single precision it also sums the squares of the normal impulses, as velocities n y'.
template <typename Number>
void WideSweep::push_part(const State<Number>& state, Part& part) {
  std::copy_n(free_.begin() + part.bodies.begin, part.bodies.count,
              exact_.bodies.begin() + part.bodies.begin);
  double squares[group_lanes] = {};
  for_each_kind(
      [&](const auto& kind, const auto& exact, const auto& loops, const Range& range) {
        loops.push(kind.groups.data() + range.begin, kind.impulses.data() + range.begin,
                   range.count, exact_.bodies.data());
        if constexpr (std::is_same_v<Number, float>)
          for (int g = range.begin; g < range.begin + range.count; ++g)
            for (int lane = 0; lane < group_lanes; ++lane) {
              const double y = exact.frames[g].normal[lane] * kind.impulses[g].y[0][lane];
              squares[lane] += y * y;
            }
      },
      state, exact_, kernels_of(state), part);
  part.impulse_square = std::accumulate(squares, squares + group_lanes, 0.0);
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
  in_single_ ? store_from(single_, r) : store_from(exact_, r);
}

/// Impulses in single precision are on their cone up to its rounding: they are put there. Impulses
/// that no sweep has changed are those that were loaded.
template <typename Number>
void WideSweep::store_from(const State<Number>& state, Impulses& r) const {
  for_parts_by_slab([&](int part) {
    for_each_kind(
        [&](const auto& kind, const auto& exact, const Range& range) {
          for (int g = range.begin; g < range.begin + range.count; ++g) {
            const GroupFrame& f = exact.frames[g];
            const auto& y = kind.impulses[g].y;
            constexpr int rows = std::extent_v<std::remove_reference_t<decltype(y)>>;
            for (int i = 0; i < group_lanes; ++i) {
              if (f.contact[i] < 0) continue;
              const int row = problem_->row_begin[f.contact[i]];
              double* rc = r.data() + row;
              if (at_start_) {
                std::copy_n(start_.data() + row, rows, rc);
                continue;
              }
              double normal = y[0][i];
              if constexpr (rows == 3) {
                const auto& k = kind.groups[g];
                const double y1 = y[1][i], y2 = y[2][i];
                const double t1 = f.inverse_tangent[i] * y1, t2 = f.inverse_tangent[i] * y2;
                normal -= k.c1[i] * y1 + k.c2[i] * y2;
                rc[1] = f.cosine[i] * t1 - f.sine[i] * t2;
                rc[2] = f.sine[i] * t1 + f.cosine[i] * t2;
              }
              rc[0] = f.inverse_normal[i] * normal;
              if constexpr (rows == 3 && std::is_same_v<Number, float>) put_on_cone(f.mu[i], rc);
            }
          }
        },
        state, exact_, parts_[part]);
  });
}

/// Sweeps one part, or two parts without a common body: first the contacts with friction of both,
/// then the one-row contacts, then those on driven walls.
template <typename Number>
void WideSweep::sweep_parts(State<Number>& state, const SearchStep* step, std::span<Part> parts) {
  for (Part& part : parts) part.change_square = 0.0;
  for_each_kind(
      [&](auto& kind, const auto& loops, const Range& first, const Range& last) {
        typename std::decay_t<decltype(kind)>::Loops::Run runs[2] = {};
        for (size_t k = 0; k < parts.size(); ++k) {
          const Range& at = k == 0 ? first : last;
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
      },
      state, kernels_of(state), parts.front(), parts.back());
}

/// Sweeps the interiors, after their bodies' step along a search, then the interfaces.
template <typename Number>
double WideSweep::sweep_in(State<Number>& state, const SearchStep* step) {
  for_pairs(std::span(parts_).first(plan_.slabs()), [&](std::span<Part> parts) {
    for (const Part& part : parts)
      if (step)
        kernels_of(state).move_bodies(
            part.bodies.count, *step, state.bodies.data() + part.bodies.begin,
            state.before.data() + part.bodies.begin, state.direction.data() + part.bodies.begin);
    sweep_parts(state, step, parts);
  });
  for_pairs(std::span(parts_).subspan(plan_.slabs()), [&](std::span<Part> parts) {
    for (const Part& part : parts) prefetch_shared(state, part);
    sweep_parts(state, step, parts);
  });
  return sum(&Part::change_square);
}

/// Adds a number of every part, in their order.
double WideSweep::sum(double Part::*number) const {
  double total = 0.0;
  for (const Part& part : parts_) total += part.*number;
  return total;
}

double WideSweep::sweep_in_precision(const SearchStep* step) {
  if (single_begins_) error();
  if (step && std::exchange(search_begins_, false))
    in_single_ ? start_search_in(single_) : start_search_in(exact_);
  at_start_ = false;
  ++unseen_;
  return in_single_ ? sweep_in(single_, step) : sweep_in(exact_, step);
}

template <typename Number>
void WideSweep::start_search_in(State<Number>& state) {
  for_each_kind([](auto& kind) { kind.search.assign(kind.groups.size(), {}); }, state);
  state.before = state.bodies;
  state.direction.assign(state.bodies.size(), {});
}

/// The search starts only with the first sweep_along(), which most solves in double never call.
void WideSweep::start_search() {
  search_begins_ = true;
  for_each_kind([](auto& single) { single.search.clear(); }, single_);
}

double WideSweep::error() {
  if (!in_single_) return error_in(exact_, exact_);
  if (!at_start_) {
    last_bodies_.swap(exact_.bodies);
    for_parts_in_phases(exact_, [this](Part& part) { push_part(single_, part); });
  }
  seen_error_ = error_in(single_, exact_);
  for_parts_in_phases(exact_, [this](Part& part) { settle(part); });
  unseen_ = 0;
  single_begins_ = false;
  // How much the rounding of impulses and records may change the error: a multiple of the impulses'
  // own rounding as velocities of their contacts. Like the drift of the bodies it is an rms.
  const double rounding =
      single_rounding * std::sqrt(sum(&Part::impulse_square) / std::max(1, contacts_));
  const double drift =
      std::sqrt(sum(&Part::drift_square) / static_cast<double>(row_of_body_.size()));
  if (!(rounding + drift <= allowed_share * seen_error_)) {
    leave_single();
    return error_in(exact_, exact_);
  }
  choose_awake(seen_error_);
  return seen_error_ + rounding;
}

/// Calls error() before rounding could show in the rough error, and after many sweeps without it.
double WideSweep::rough_error() {
  constexpr int most_unseen = 64;
  constexpr double least_share = 1.0 / 32.0;
  if (!in_single_ || single_begins_ || unseen_ >= most_unseen) return error();
  const double rough = error_in(single_, single_);
  if (!(rough > least_share * seen_error_)) return error();
  choose_awake(rough);
  return rough;
}

/// The error of the state's impulses when its bodies move as in `moved`: in double, or the rough
/// one in single precision.
template <typename Number, typename BodyNumber>
double WideSweep::error_in(const State<Number>& state, const State<BodyNumber>& moved) {
  for_parts_in_phases(moved, [&](Part& part) {
    part.error_square = 0.0;
    for_each_kind(
        [&](const auto& kind, const auto& exact, auto& single, const auto& loops, Range range) {
          const auto evaluate = [&](auto loop) {
            part.error_square +=
                loop(kind.groups.data() + range.begin, kind.impulses.data() + range.begin,
                     exact.frames.data() + range.begin, range.count, moved.bodies.data(),
                     in_single_ ? single.seen.data() + range.begin : nullptr);
          };
          if constexpr (std::is_same_v<BodyNumber, float>)
            evaluate(loops.rough_error);
          else
            evaluate(loops.error);
        },
        state, exact_, single_, kernels_of(state), part);
  });
  return contacts_ > 0 ? std::sqrt(sum(&Part::error_square) / contacts_) : 0.0;
}

// Sweeps in single precision, corrected in double by every error().
//
// Records and impulses are singles. error() lets the impulses push the bodies in double. Each
// contact's resulting velocity becomes its bias, and the bodies of the single state start at zero
// again. So the sweeps round only the change since that error(), and what remains is the rounding
// of the impulses and records themselves. Where that may show in the error, records are made in
// double, and the sweeps go on with them.

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
    if (!search_begins_)
      for (int i = 0; i < 8; ++i) single_.before[b].w[i] -= single_.bodies[b].w[i];
    single_.bodies[b] = {};
  }
  for_each_kind(
      [](auto& single, const Range& range) {
        for (int g = range.begin; g < range.begin + range.count; ++g)
          std::memcpy(single.groups[g].bias, single.seen[g].u, sizeof single.seen[g].u);
      },
      single_, part);
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

/// Goes on in double from the impulses that were loaded, or that the sweeps have made.
void WideSweep::leave_single() {
  in_single_ = false;
  start_search();
  if (at_start_) return load_into(exact_, start_);
  need_exact();
  for_parts_in_phases(exact_, [this](Part& part) {
    for_each_kind(
        [](auto& exact, const auto& single, const Range& range) {
          for (int g = range.begin; g < range.begin + range.count; ++g) {
            const auto& from = single.impulses[g];
            auto& to = exact.impulses[g];
            for (size_t i = 0; i < std::size(from.y); ++i) std::ranges::copy(from.y[i], to.y[i]);
            std::ranges::copy(from.miss, to.miss);
          }
        },
        exact_, single_, part);
    push_part(exact_, part);
  });
}

}  // namespace ballast

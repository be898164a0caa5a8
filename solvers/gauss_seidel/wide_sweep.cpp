#include "solvers/gauss_seidel/wide_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace ballast {

void WideSweep::load(const FrictionProblem& problem, const Impulses& r) {
  // To the groups' coordinates.
  exact_.for_kinds([&](auto& kind) {
    for (size_t g = 0; g < kind.groups.size(); ++g) {
      kind.impulses[g] = {};
      const GroupFrame& f = kind.frames[g];
      auto& y = kind.impulses[g].y;
      for (int i = 0; i < group_lanes; ++i) {
        if (f.contact[i] < 0) continue;
        const double* rc = r.data() + problem.row_begin[f.contact[i]];
        // The y' of group_record.hpp: n r_N + c' . (t r_T), with r_T
        // turned to the principal tangents.
        y[0][i] = f.normal[i] * rc[0];
        if constexpr (requires { kind.groups[g].mu; }) {
          const auto& k = kind.groups[g];
          y[1][i] = f.tangent[i] * (f.cosine[i] * rc[1] + f.sine[i] * rc[2]);
          y[2][i] = f.tangent[i] * (f.cosine[i] * rc[2] - f.sine[i] * rc[1]);
          y[0][i] += k.c1[i] * y[1][i] + k.c2[i] * y[2][i];
        }
      }
    }
  });
  for_parts(exact_, [this](const Part& part) { push_part(part); });
  in_single_ = false;
  single_begins_ = single_allowed_;
}

/// A slab's bodies start free, and every impulse pushes them once.
void WideSweep::push_part(const Part& part) {
  std::copy_n(free_.begin() + part.bodies.begin, part.bodies.count,
              exact_.bodies.begin() + part.bodies.begin);
  const auto push = [this](const auto& kind, const auto& loops, Range range) {
    loops.push(kind.groups.data() + range.begin, kind.impulses.data() + range.begin, range.count,
               exact_.bodies.data());
  };
  push(exact_.friction, kernels_->exact.friction, part.friction);
  push(exact_.one_row, kernels_->exact.one_row, part.one_row);
  push(exact_.wall, kernels_->exact.wall, part.wall);
}

/// The rows that another core wrote last, all at the same time: one by one, as the groups of an
/// interface name them, each would take a hundred nanoseconds and more.
template <typename Number>
void WideSweep::fetch_shared(const State<Number>& state, const Part& interface) const {
  const auto k = static_cast<size_t>(&interface - interfaces_.data());
  constexpr int line = 64;  // bytes
  for (const Part* slab : {&interiors_[k], &interiors_[k + 1]}) {
    const char* row = reinterpret_cast<const char*>(state.bodies.data() + slab->bodies.begin);
    for (const char* end = row + slab->shared * sizeof(BodyRow<Number>); row < end; row += line)
      __builtin_prefetch(row, 1);
  }
}

void WideSweep::store(const FrictionProblem& problem, Impulses& r) const {
  // What nothing moves is in no group.
  r.setZero(problem.row_count());
  exact_.for_kinds([&](const auto& kind) {
    for (size_t g = 0; g < kind.groups.size(); ++g) {
      const GroupFrame& f = kind.frames[g];
      const auto& y = kind.impulses[g].y;
      for (int i = 0; i < group_lanes; ++i) {
        if (f.contact[i] < 0) continue;
        double* rc = r.data() + problem.row_begin[f.contact[i]];
        rc[0] = f.inverse_normal[i] * y[0][i];
        if constexpr (requires { kind.groups[g].mu; }) {
          const auto& k = kind.groups[g];
          rc[0] = f.inverse_normal[i] * (y[0][i] - k.c1[i] * y[1][i] - k.c2[i] * y[2][i]);
          const double t1 = f.inverse_tangent[i] * y[1][i], t2 = f.inverse_tangent[i] * y[2][i];
          rc[1] = f.cosine[i] * t1 - f.sine[i] * t2;
          rc[2] = f.sine[i] * t1 + f.cosine[i] * t2;
        }
      }
    }
  });
}

/// Two parts without a common body, or one: of both first the contacts with friction, then those of
/// one row, then the driven walls'. Calls sweep(loops, runs) for each kind.
template <typename Number, typename Kernels, typename Sweep>
void WideSweep::sweep_parts(State<Number>& state, const Kernels& kernels,
                            std::span<const Part> parts, const Sweep& sweep) {
  const auto sweep_kind = [&](auto& kind, const auto& loops, Range Part::*range) {
    using Run = typename std::decay_t<decltype(kind)>::Loops::Run;
    Run runs[2] = {};
    for (size_t k = 0; k < parts.size(); ++k) {
      const Range at = parts[k].*range;
      constexpr bool all = std::is_same_v<Number, double>;
      runs[k] = {kind.groups.data() + at.begin, kind.impulses.data() + at.begin,
                 kind.search.empty() ? nullptr : kind.search.data() + at.begin,
                 all ? nullptr : kind.awake.data() + at.begin, all ? at.count : at.awake};
    }
    sweep(loops, runs);
  };
  sweep_kind(state.friction, kernels.friction, &Part::friction);
  sweep_kind(state.one_row, kernels.one_row, &Part::one_row);
  sweep_kind(state.wall, kernels.wall, &Part::wall);
}

template <typename Number, typename Kernels>
void WideSweep::sweep_in(State<Number>& state, const Kernels& kernels) {
  const auto sweep = [&](std::span<Part> parts) {
    sweep_parts(state, kernels, parts, [&state](const auto& loops, const auto& runs) {
      loops.sweep(runs, state.bodies.data());
    });
  };
  for_pairs(interiors_, sweep);
  for_pairs(interfaces_, [&](std::span<Part> parts) {
    for (const Part& part : parts) fetch_shared(state, part);
    sweep(parts);
  });
}

void WideSweep::sweep() {
  if (single_begins_) enter_single();
  in_single_ ? sweep_in(single_, kernels_->single) : sweep_in(exact_, kernels_->exact);
}

template <typename Number>
void WideSweep::start_search_in(State<Number>& state) {
  state.for_kinds([](auto& kind) { kind.search.assign(kind.groups.size(), {}); });
  state.before = state.bodies;
  state.direction.assign(state.bodies.size(), {});
}

void WideSweep::start_search() { in_single_ ? start_search_in(single_) : start_search_in(exact_); }

template <typename Number, typename Kernels>
double WideSweep::sweep_in(State<Number>& state, const Kernels& kernels, SearchStep step) {
  const auto search = [&](std::span<Part> parts) {
    for (Part& part : parts) part.change_square = 0.0;
    sweep_parts(state, kernels, parts, [&](const auto& loops, const auto& runs) {
      double squares[2];
      loops.search(runs, step, state.bodies.data(), squares);
      for (size_t k = 0; k < parts.size(); ++k) parts[k].change_square += squares[k];
    });
  };
  // Interiors first, with the bodies that are theirs; then the interfaces between slabs.
  for_pairs(interiors_, [&](std::span<Part> parts) {
    for (const Part& part : parts)
      kernels.move_bodies(part.bodies.count, step, state.bodies.data() + part.bodies.begin,
                          state.before.data() + part.bodies.begin,
                          state.direction.data() + part.bodies.begin);
    search(parts);
  });
  for_pairs(interfaces_, [&](std::span<Part> parts) {
    for (const Part& part : parts) fetch_shared(state, part);
    search(parts);
  });
  // Added up in the order of the parts: the same bits whatever the number of threads.
  double square = 0.0;
  for (const std::vector<Part>* parts : {&interiors_, &interfaces_})
    for (const Part& part : *parts) square += part.change_square;
  return square;
}

double WideSweep::sweep(SearchStep step) {
  if (single_begins_) enter_single();
  return in_single_ ? sweep_in(single_, kernels_->single, step)
                    : sweep_in(exact_, kernels_->exact, step);
}

double WideSweep::error() {
  if (!in_single_) return error_in_double();
  refresh();
  const double error = error_in_double();
  single_suffices(error) ? choose_awake(error) : leave_single();
  return error;
}

/// In single precision, the contacts' velocities become its biases.
double WideSweep::error_in_double() {
  for_parts(exact_, [this](Part& part) {
    if (in_single_) settle(part);
    const auto error = [this](const auto& kind, auto& single, const auto& loops, Range range) {
      return loops.error(kind.groups.data() + range.begin, kind.impulses.data() + range.begin,
                         kind.frames.data() + range.begin, range.count, exact_.bodies.data(),
                         in_single_ ? single.groups.data() + range.begin : nullptr);
    };
    part.error_square =
        error(exact_.friction, single_.friction, kernels_->exact.friction, part.friction) +
        error(exact_.one_row, single_.one_row, kernels_->exact.one_row, part.one_row) +
        error(exact_.wall, single_.wall, kernels_->exact.wall, part.wall);
  });
  // The parts' sums, always in the same order.
  double sum = 0.0;
  for (const std::vector<Part>* parts : {&interiors_, &interfaces_})
    for (const Part& part : *parts) sum += part.error_square;
  return contacts_ > 0 ? std::sqrt(sum / contacts_) : 0.0;
}

void WideSweep::save(Eigen::VectorXd& state) const {
  // Impulses kind by kind, then velocities: restore() reads the same order.
  Eigen::Index size = 0;
  exact_.for_kinds([&](const auto& kind) {
    for (const auto& k : kind.impulses) size += sizeof k.y / sizeof(double);
  });
  state.resize(size + 8 * static_cast<Eigen::Index>(exact_.bodies.size()));
  double* x = state.data();
  exact_.for_kinds([&](const auto& kind) {
    for (const auto& k : kind.impulses) x = std::copy_n(k.y[0], sizeof k.y / sizeof(double), x);
  });
  for (const BodyRow<double>& body : exact_.bodies) x = std::copy_n(body.w, 8, x);
}

void WideSweep::restore(const Eigen::VectorXd& state) {
  const double* x = state.data();
  exact_.for_kinds([&](auto& kind) {
    for (auto& k : kind.impulses) {
      std::copy_n(x, sizeof k.y / sizeof(double), k.y[0]);
      x += sizeof k.y / sizeof(double);
    }
  });
  for (BodyRow<double>& body : exact_.bodies) {
    std::copy_n(x, 8, body.w);
    x += 8;
  }
}

/// In the groups' coordinates W's diagonal is (1, 1, s2).
void WideSweep::impulse_weights(Eigen::VectorXd& weights) const {
  std::vector<double> roots;
  exact_.for_kinds([&](const auto& kind) {
    for (const auto& k : kind.groups) {
      roots.insert(roots.end(), std::min(k.rows, 2) * group_lanes, 1.0);
      if constexpr (requires { k.s2; })
        for (const double s2 : k.s2) roots.push_back(std::sqrt(s2));
    }
  });
  weights = Eigen::VectorXd::Map(roots.data(), static_cast<Eigen::Index>(roots.size()));
}

}  // namespace ballast

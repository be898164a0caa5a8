#include "experiments/bench/sweep_floor.hpp"

#include <algorithm>

#include "solvers/gauss_seidel/group_kernels.hpp"

namespace ballast {
namespace {

/// Of velocity() and push() in solvers/gauss_seidel/group_loops.hpp: the difference of the bodies'
/// velocities; a row's three products of three numbers and its bias; the linear part summed once
/// for both bodies, the angular parts for each.
double rows_flops(int rows) {
  const double products = 3 + rows * (3 * 5 + 3);
  const double pushes = 3 * (2 * rows - 1) + 3 * 4 + 2 * 3 * 2 * rows;
  return products + pushes;
}

// With friction: candidate (4), impulse changes (3); Coulomb's test: mu (y - c1 t1 - c2 t2), t1 t1
// + t2 t2, its square (9).
constexpr double friction_own = 4 + 3 + 9;
// One row: candidate, change.
constexpr double one_row_own = 2;

/// Of one lane.
template <typename Group>
SweepCost lane_cost(double flops) {
  using Impulses = typename GroupLoops<Group>::Impulses;
  constexpr double lanes = group_lanes;
  return {sizeof(Group) / lanes, 2.0 * sizeof(Impulses) / lanes, flops};
}

}  // namespace

SweepCost friction_cost() { return lane_cost<FrictionGroup<double>>(rows_flops(3) + friction_own); }

SweepCost one_row_cost() { return lane_cost<OneRowGroup<double>>(rows_flops(1) + one_row_own); }

SweepCost mean_sweep_cost(const FrictionProblem& problem) {
  const int contacts = problem.contact_count();
  SweepCost mean;
  for (int c = 0; c < contacts; ++c) {
    const SweepCost cost = problem.contact_rows(c) == 1 ? one_row_cost() : friction_cost();
    mean.record_bytes += cost.record_bytes / contacts;
    mean.impulse_bytes += cost.impulse_bytes / contacts;
    mean.flops += cost.flops / contacts;
  }
  return mean;
}

double sweep_working_set(const FrictionProblem& problem) {
  const SweepCost cost = mean_sweep_cost(problem);
  return problem.contact_count() * (cost.record_bytes + 0.5 * cost.impulse_bytes) +
         problem.dynamics.body_count() * static_cast<double>(sizeof(BodyRow<double>));
}

std::vector<Measurement> floor_measurements(const FrictionProblem& problem,
                                            const MachineFacts& facts) {
  const SweepCost cost = mean_sweep_cost(problem);
  const double size = sweep_working_set(problem);
  const double near = read_bandwidth(static_cast<std::size_t>(size));
  const auto one = [](const char* name, const char* unit, double value) {
    return measurement_of("floor", name, unit, {value});
  };
  // ns a contact: bytes over GB/s, or flops over Gflop/s, whichever lasts longer
  // This is the roofline of Williams, Waterman and Patterson (2009).
  const auto least_ns = [&](double GB_s) {
    return std::max(cost.streamed_bytes() / GB_s, cost.flops / facts.gflops);
  };
  return {one("sweep bytes streamed", "B/contact", cost.streamed_bytes()),
          one("sweep flops needed", "flops/contact", cost.flops),
          one("sweep working set", "kB", size / 1024.0),
          one("read bandwidth at that size", "GB/s", near),
          one("read bandwidth streaming", "GB/s", facts.read_GB_s),
          one("flop rate", "Gflop/s", facts.gflops),
          one("sweep floor in cache", "ns/contact", least_ns(near)),
          one("sweep floor streaming", "ns/contact", least_ns(facts.read_GB_s))};
}

}  // namespace ballast

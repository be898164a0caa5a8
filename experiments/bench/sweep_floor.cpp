#include "experiments/bench/sweep_floor.hpp"

#include <algorithm>

#include "solvers/gauss_seidel/sweep_kernels.hpp"

namespace ballast {
namespace {

/// Of relax() in solvers/sweep_kernels.cpp, for rows `width` wide: `rows` scalar products over both
/// bodies, the contact's own arithmetic, `rows` multiples added to both bodies.
double relax_flops(int rows, int width, double own) {
  const double products = rows * (2.0 * width + (2.0 * width - 1.0));
  const double updates = 2.0 * width * 2.0 * rows;
  return products + own + updates;
}

// With friction: bias (3), candidate (2 x 3), impulse changes (3); Coulomb's test: mu (y - c1 t1 -
// c2 t2), t1 t1 + t2 t2, its square (9).
constexpr double friction_own = 3 + 6 + 3 + 9;
// One row: bias, candidate (2), change.
constexpr double one_row_own = 4;

}  // namespace

SweepCost friction_cost() {
  return {sizeof(FrictionRecord), 2.0 * sizeof(FrictionImpulse), 4.0 * sizeof(BodyVelocity),
          relax_flops(3, row_width, friction_own), relax_flops(3, body_width, friction_own)};
}

SweepCost one_row_cost() {
  return {sizeof(OneRowRecord), 2.0 * sizeof(double), 4.0 * sizeof(BodyVelocity),
          relax_flops(1, row_width, one_row_own), relax_flops(1, body_width, one_row_own)};
}

SweepFloor sweep_floor(const FrictionProblem& problem) {
  SweepFloor floor;
  const double contacts = problem.contact_count();
  if (contacts == 0) return floor;
  double one_row = 0.0;
  for (int c = 0; c < problem.contact_count(); ++c) one_row += problem.contact_rows(c) == 1;
  const double share = one_row / contacts;
  const SweepCost f = friction_cost(), o = one_row_cost();
  const auto mean = [&](double SweepCost::*part) {
    return (1.0 - share) * f.*part + share * o.*part;
  };
  floor.bytes = mean(&SweepCost::record_bytes) + mean(&SweepCost::impulse_bytes);
  floor.flops = mean(&SweepCost::flops);
  floor.executed_flops = mean(&SweepCost::executed_flops);
  floor.working_set =
      contacts * (mean(&SweepCost::record_bytes) + 0.5 * mean(&SweepCost::impulse_bytes)) +
      problem.dynamics.body_count() * static_cast<double>(sizeof(BodyVelocity));
  return floor;
}

std::vector<Measurement> floor_measurements(const FrictionProblem& problem,
                                            const MachineFacts& facts) {
  const SweepFloor floor = sweep_floor(problem);
  const double near = read_bandwidth(static_cast<std::size_t>(floor.working_set));
  const auto one = [](const char* name, const char* unit, double value) {
    return measurement_of("floor", name, unit, {value});
  };
  return {one("sweep bytes streamed", "B/contact", floor.bytes),
          one("sweep flops needed", "flops/contact", floor.flops),
          one("sweep flops on eight lanes", "flops/contact", floor.executed_flops),
          one("sweep working set", "kB", floor.working_set / 1024.0),
          one("read bandwidth at that size", "GB/s", near),
          one("read bandwidth streaming", "GB/s", facts.read_GB_s),
          one("flop rate", "Gflop/s", facts.gflops),
          one("sweep floor in cache", "ns/contact",
              std::max(floor.bandwidth_ns(near), floor.flops_ns(facts.gflops))),
          one("sweep floor streaming", "ns/contact",
              std::max(floor.bandwidth_ns(facts.read_GB_s), floor.flops_ns(facts.gflops)))};
}

}  // namespace ballast

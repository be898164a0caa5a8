#include "experiments/bench/sweep_floor.hpp"

#include <algorithm>

#include "solvers/gauss_seidel/sweep_kernels.hpp"

namespace ballast {
namespace {

/// Of relax() in solvers/gauss_seidel/sweep_kernels.cpp, for rows `width` wide: `rows` scalar
/// products over both bodies, the contact's own arithmetic, `rows` multiples added to both bodies.
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
  return {sizeof(FrictionRecord), 2.0 * sizeof(FrictionImpulse),
          relax_flops(3, row_width, friction_own), relax_flops(3, body_width, friction_own)};
}

SweepCost one_row_cost() {
  return {sizeof(OneRowRecord), 2.0 * sizeof(double), relax_flops(1, row_width, one_row_own),
          relax_flops(1, body_width, one_row_own)};
}

SweepCost mean_sweep_cost(const FrictionProblem& problem) {
  const int contacts = problem.contact_count();
  SweepCost mean;
  for (int c = 0; c < contacts; ++c) {
    const SweepCost cost = problem.contact_rows(c) == 1 ? one_row_cost() : friction_cost();
    mean.record_bytes += cost.record_bytes / contacts;
    mean.impulse_bytes += cost.impulse_bytes / contacts;
    mean.flops += cost.flops / contacts;
    mean.executed_flops += cost.executed_flops / contacts;
  }
  return mean;
}

double sweep_working_set(const FrictionProblem& problem) {
  const SweepCost cost = mean_sweep_cost(problem);
  return problem.contact_count() * (cost.record_bytes + 0.5 * cost.impulse_bytes) +
         problem.dynamics.body_count() * static_cast<double>(sizeof(BodyVelocity));
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
  const auto least_ns = [&](double GB_s) {
    return std::max(cost.streamed_bytes() / GB_s, cost.executed_flops / facts.gflops);
  };
  return {one("sweep bytes streamed", "B/contact", cost.streamed_bytes()),
          one("sweep flops needed", "flops/contact", cost.flops),
          one("sweep flops on eight lanes", "flops/contact", cost.executed_flops),
          one("sweep working set", "kB", size / 1024.0),
          one("read bandwidth at that size", "GB/s", near),
          one("read bandwidth streaming", "GB/s", facts.read_GB_s),
          one("flop rate", "Gflop/s", facts.gflops),
          one("sweep floor in cache", "ns/contact", least_ns(near)),
          one("sweep floor streaming", "ns/contact", least_ns(facts.read_GB_s))};
}

}  // namespace ballast

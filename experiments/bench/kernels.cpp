#include "experiments/bench/kernels.hpp"

#include <benchmark/benchmark.h>

#include <map>
#include <sstream>
#include <stdexcept>

#include "experiments/bench/sweep_floor.hpp"

namespace ballast {
namespace {

/// Collects CPU ns per item of every repetition.
class SampleReporter : public benchmark::BenchmarkReporter {
 public:
  explicit SampleReporter(const std::map<std::string, double>& items) : items_(items) {}
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
      const std::string& name = run.run_name.function_name;
      samples[name].push_back(1e9 * run.cpu_accumulated_time / static_cast<double>(run.iterations) /
                              items_.at(name));
    }
  }
  std::map<std::string, std::vector<double>> samples;

 private:
  const std::map<std::string, double>& items_;
};

/// Copies of the problem that make its records larger than any cache.
int streaming_copies(const KernelProblem& problem, const KernelBenchOptions& options,
                     const MachineFacts& facts) {
  const double last = facts.caches.empty() ? 32e6 : 1024.0 * facts.caches.back().kilobytes;
  const double wanted = options.streaming_MB > 0.0 ? 1e6 * options.streaming_MB : 2.0 * last;
  return 1 + static_cast<int>(wanted / std::max(1.0, sweep_working_set(problem.problem)));
}

}  // namespace

std::vector<Measurement> run_kernels(const KernelProblem& problem,
                                     const KernelBenchOptions& options, const MachineFacts& facts) {
  std::vector<Kernel> kernels;
  add_detection_kernels(kernels);
  add_problem_kernels(problem, kernels);
  add_sweep_kernels(problem, streaming_copies(problem, options, facts), kernels);
  add_one_contact_kernels(kernels);
  add_factor_kernels(problem, kernels);

  std::map<std::string, double> items;
  benchmark::ClearRegisteredBenchmarks();
  for (const Kernel& kernel : kernels) {
    const std::string name = kernel.group + "/" + kernel.name;
    items[name] = kernel.items;
    benchmark::RegisterBenchmark(
        name.c_str(),
        [&kernel](benchmark::State& state) {
          kernel.call();  // what is made at the first call is not part of the next
          for (auto _ : state) kernel.call();
        })
        ->MinTime(options.min_time)
        ->Repetitions(options.repeats);
  }
  SampleReporter reporter(items);
  std::ostringstream unsaid;  // the library's own complaint about a filter: ours is an exception
  reporter.SetErrorStream(&unsaid);
  benchmark::RunSpecifiedBenchmarks(&reporter, options.filter.empty() ? "." : options.filter);
  benchmark::ClearRegisteredBenchmarks();

  std::vector<Measurement> measurements;
  for (const Kernel& kernel : kernels) {
    const auto found = reporter.samples.find(kernel.group + "/" + kernel.name);
    if (found != reporter.samples.end())
      measurements.push_back(measurement_of(kernel.group, kernel.name, kernel.unit, found->second));
  }
  if (measurements.empty())
    throw std::invalid_argument("no kernel is called like '" + options.filter + "'");
  for (Measurement& m : floor_measurements(problem.problem, facts))
    measurements.push_back(std::move(m));
  return measurements;
}

}  // namespace ballast

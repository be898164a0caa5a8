#include "experiments/bench/kernels.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "experiments/step/time_step.hpp"
#include "platform/clock.hpp"
#include "problems/algebra/contact_error.hpp"
#include "solvers/gauss_seidel/any_sweep.hpp"

namespace ballast {
namespace {

/// A step of the driven box, with the problem that it solved.
struct StepWork {
  const double h;
  BenchStart start;
  TimeStepper stepper;
  ProblemAssembler assembler;
  ContactJudge judge;
  Eigen::VectorXd v_free;
  FrictionProblem problem;
  Impulses warm;

  StepWork(const DepositedBox& box, int steps)
      : h(box.scene.step),
        start(driven_start(box)),
        stepper(start.system, box.scene, start.system.first_driven_wall()),
        assembler(start.system) {
    for (int k = 0; k < steps; ++k) stepper.step(start.state, start.memory);
    stepper.warm_start(warm);
    assembler.pack(start.state, v_free);
    assemble();
  }
  void assemble() {
    const double end = start.state.time + h;
    assembler.assemble({start.state, stepper.contacts(), v_free, h, end}, problem);
  }
};

struct DetectionWork {
  ContactDetector detector;
  std::vector<Pose> poses;
  std::vector<double> reach;
  std::vector<ContactPoint> contacts;

  DetectionWork(const BenchStart& start, DetectionSettings settings, bool use_cache)
      : detector(contact_shapes(start.system), (settings.use_cache = use_cache, settings)),
        poses(start.state.pose),
        reach(poses.size(), 0.0) {}
  void all() { detector.detect(poses, reach, contacts); }
};

struct SweepWork {
  const FrictionProblem problem;
  AnySweep sweep;

  SweepWork(const StepWork& step, bool in_single) : problem(step.stepper.problem()) {
    sweep.prepare(problem);
    sweep->allow_single(in_single);
    sweep->load(problem, step.warm);
    sweep->start_search();
  }
};

/// CPU ns per item of each repetition. The first call is not timed: it makes what others find.
std::vector<double> samples_of(const Kernel& kernel, const KernelBenchOptions& options) {
  kernel.call();
  std::vector<double> samples;
  for (long calls = 1; samples.size() < static_cast<size_t>(options.repeats);) {
    const double begin = processor_seconds();
    for (long k = 0; k < calls; ++k) kernel.call();
    const double seconds = processor_seconds() - begin;
    if (seconds < options.min_time)
      calls *= 2;
    else
      samples.push_back(1e9 * seconds / (static_cast<double>(calls) * kernel.items));
  }
  return samples;
}

}  // namespace

std::vector<Kernel> step_kernels(const DepositedBox& box, int steps) {
  const auto step = std::make_shared<StepWork>(box, steps);
  std::vector<Kernel> kernels;
  for (const bool use_cache : {false, true}) {
    const auto work = std::make_shared<DetectionWork>(step->start, box.scene.detection, use_cache);
    work->all();
    const double pairs = static_cast<double>(work->detector.counters().candidate_pairs);
    kernels.push_back({"detection", use_cache ? "axes kept" : "from scratch", "ns/pair",
                       std::max(1.0, pairs), [work] { work->all(); }});
  }
  const double contacts = std::max(1, step->problem.contact_count());
  const auto add = [&](const char* group, const std::string& name, std::function<void()> call) {
    kernels.push_back({group, name, "ns/contact", contacts, std::move(call)});
  };
  add("problem", "assembly", [step] { step->assemble(); });
  add("problem", "judge", [step] { step->judge.judge(step->problem, step->stepper.impulses()); });
  for (const bool in_single : {false, true}) {
    const auto work = std::make_shared<SweepWork>(*step, in_single);
    const std::string how = in_single ? " in float lanes" : "";
    add("sweep", "sweep" + how, [work] { work->sweep->sweep(); });
    // What an iteration of nncg does between two looks at the error.
    add("sweep", "sweep along a search" + how, [work] { work->sweep->sweep_along({0.1, 1.0}); });
    add("sweep", "error" + how, [work] { work->sweep->error(); });
  }
  return kernels;
}

std::vector<Measurement> run_kernels(const std::vector<Kernel>& kernels,
                                     const KernelBenchOptions& options) {
  std::vector<Measurement> measurements;
  for (const Kernel& kernel : kernels)
    if ((kernel.group + "/" + kernel.name).find(options.filter) != std::string::npos)
      measurements.push_back(
          measurement_of(kernel.group, kernel.name, kernel.unit, samples_of(kernel, options)));
  if (measurements.empty())
    throw std::invalid_argument("no kernel is called like '" + options.filter + "'");
  return measurements;
}

}  // namespace ballast

#include "experiments/measure/run_trust.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "platform/text.hpp"

namespace ballast {
namespace {

double smallest_radius_of(const Scene& scene) {
  double least = std::numeric_limits<double>::infinity();
  for (const BodySpec& body : scene.bodies)
    if (body.shape) least = std::min(least, body.shape->circumradius());
  if (scene.grains)
    for (const SizeClass& part : scene.grains->distribution)
      least = std::min(least, scene.grains->size_convention == SizeConvention::diameter
                                  ? 0.5 * part.size
                                  : part.size);
  return std::isfinite(least) ? least : not_known;
}

std::string length_text(double metres) {
  const bool is_small = metres < 1e-3;
  const double value = (is_small ? 1e6 : 1e3) * metres;
  // from 100 on %g would write a power of ten
  return printed(value >= 99.5 ? "%.0f %s" : "%.2g %s", value, is_small ? "µm" : "mm");
}

std::string steps_words(const RunTrust& trust) {
  std::string text = printed(
      "%ld of %ld steps did not reach the tolerance of %.3g %s: their error is %.2g %s in "
      "the mean of all steps, %.2g in the worst.",
      trust.missed, trust.steps, trust.tolerance, trust.error_unit.c_str(), trust.error_mean,
      trust.error_unit.c_str(), trust.error_worst);
  text += printed(" More accurate and slower: --set solver.max_iterations=%d",
                  5 * std::max(1, trust.max_iterations));
  if (trust.solver != "auto") text += ", or --set solver.name=auto";
  return text + ".";
}

std::string overlap_words(const RunTrust& trust) {
  return "The deepest overlap is " + length_text(trust.deepest) +
         printed(" at t = %.3g s, %.2g %% of the smallest body's radius. ", trust.deepest_time,
                 100.0 * trust.deepest / trust.smallest_radius) +
         (trust.misses() ? "A smaller error of the steps mends it, or a smaller scene.step."
                         : "A smaller scene.step mends it.");
}

std::string energy_words(const RunTrust& trust) {
  return printed(
             "Energy +%.3g J: contacts gave it to the bodies, which no law of contact does "
             "(%.2g %% of the energy that moved). ",
             trust.gained, 100.0 * trust.gained / trust.moved) +
         (trust.solver != "auto" ? "--set solver.name=auto mends it, or more iterations."
                                 : "More solver.max_iterations mend it.");
}

}  // namespace

RunTrust trust_of(const RunData& data) {
  RunTrust trust;
  const RunFacts facts = complete_facts(data.facts, data.steps);
  const double scale = std::isfinite(facts.velocity_scale) ? facts.velocity_scale : 1.0;
  trust.error_unit = scale == 1.0 ? "m/s" : "g h";
  if (data.scene) {
    trust.tolerance = data.scene->solver.tolerance;
    trust.solver = data.scene->solver.name;
    trust.max_iterations = data.scene->solver.max_iterations;
    trust.smallest_radius = smallest_radius_of(*data.scene);
  }
  // The rows together. A record without the column `solved` has the error alone to judge by.
  trust.steps = static_cast<long>(data.steps.size());
  long judged = 0;
  double error = 0.0, works = 0.0, kinetic = 0.0;
  for (const StepRecord& step : data.steps) {
    const bool by_error = !(step.error_rms <= trust.tolerance * scale);
    if (trust.tolerance > 0.0 && (std::isnan(step.solved) ? by_error : step.solved == 0.0))
      ++trust.missed;
    if (std::isfinite(step.error_rms)) {
      error += step.error_rms / scale;
      ++judged;
    }
    trust.error_worst = std::fmax(trust.error_worst, step.error_rms / scale);
    if (!(step.penetration_max <= trust.deepest)) {
      trust.deepest = step.penetration_max;
      trust.deepest_time = step.time;
    }
    // What the energy gained is compared with: all works, and the largest kinetic energy.
    works += std::abs(step.work_load + step.work_gravity + step.work_prescribed);
    kinetic = std::fmax(kinetic, step.kinetic_energy);
  }
  if (judged > 0) trust.error_mean = error / static_cast<double>(judged);
  trust.moved = works + kinetic;
  trust.gained = 0.0;
  for (const StepRecord& step : data.steps) trust.gained += step.energy_gained;
  return trust;
}

std::vector<std::string> trust_words(const RunTrust& trust) {
  std::vector<std::string> words;
  if (trust.misses()) words.push_back(steps_words(trust));
  if (trust.overlaps()) words.push_back(overlap_words(trust));
  if (trust.gains()) words.push_back(energy_words(trust));
  if (words.empty() && trust.tolerance > 0.0)
    words.push_back(printed("Every step reached the tolerance of %.3g %s; the deepest overlap is ",
                            trust.tolerance, trust.error_unit.c_str()) +
                    length_text(trust.deepest) + ".");
  return words;
}

}  // namespace ballast

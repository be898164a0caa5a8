#include "experiments/measure/run_trust.hpp"

#include <algorithm>
#include <cmath>

#include "platform/text.hpp"

namespace ballast {
namespace {

bool overlaps(const RunSummary& run) {
  return run.penetration_max > visible_overlap * run.facts.smallest_size;
}

bool gains(const RunSummary& run) { return run.energy.gained > visible_gain * run.energy.moved; }

/// Errors are told in g h, or in m/s without gravity.
const char* error_unit(const RunSummary& run) {
  const double scale = run.facts.velocity_scale;
  return std::isfinite(scale) && scale != 1.0 ? "g h" : "m/s";
}

std::string length_text(double metres) {
  const bool is_small = metres < 1e-3;
  const double value = (is_small ? 1e6 : 1e3) * metres;
  // from 100 on %g would write a power of ten
  return printed(value >= 99.5 ? "%.0f %s" : "%.2g %s", value, is_small ? "µm" : "mm");
}

std::string steps_words(const RunSummary& run) {
  const double scale = std::isfinite(run.facts.velocity_scale) ? run.facts.velocity_scale : 1.0;
  const char* unit = error_unit(run);
  std::string text = printed(
      "%ld of %ld steps did not reach the tolerance of %.3g %s: their error is %.2g %s in "
      "the mean of all steps, %.2g in the worst.",
      run.missed, run.steps, run.facts.tolerance, unit, run.error_rms.mean / scale, unit,
      run.error_rms.max / scale);
  text += printed(" More accurate and slower: --set solver.max_iterations=%d",
                  5 * std::max(1, static_cast<int>(run.facts.iterations_most)));
  if (run.facts.solver != "auto") text += ", or --set solver.name=auto";
  return text + ".";
}

std::string overlap_words(const RunSummary& run) {
  return "The deepest overlap is " + length_text(run.penetration_max) +
         printed(" at t = %.3g s, %.2g %% of the smallest body's radius. ",
                 run.penetration_max_time, 100.0 * run.penetration_max / run.facts.smallest_size) +
         (run.missed > 0 ? "A smaller error of the steps mends it, or a smaller scene.step."
                         : "A smaller scene.step mends it.");
}

std::string energy_words(const RunSummary& run) {
  return printed(
             "Energy +%.3g J: contacts gave it to the bodies, which no law of contact does "
             "(%.2g %% of the energy that moved). ",
             run.energy.gained, 100.0 * run.energy.gained / run.energy.moved) +
         (run.facts.solver != "auto" ? "--set solver.name=auto mends it, or more iterations."
                                     : "More solver.max_iterations mend it.");
}

}  // namespace

bool is_clean(const RunSummary& run) { return run.missed == 0 && !overlaps(run) && !gains(run); }

std::vector<std::string> trust_words(const RunSummary& run) {
  std::vector<std::string> words;
  if (run.missed > 0) words.push_back(steps_words(run));
  if (overlaps(run)) words.push_back(overlap_words(run));
  if (gains(run)) words.push_back(energy_words(run));
  if (words.empty() && run.facts.tolerance > 0.0)
    words.push_back(printed("Every step reached the tolerance of %.3g %s; the deepest overlap is ",
                            run.facts.tolerance, error_unit(run)) +
                    length_text(run.penetration_max) + ".");
  return words;
}

}  // namespace ballast

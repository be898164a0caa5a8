#pragma once
// Records made up from formulas: a vibrated box whose wall follows Eq. 2 with a force-displacement
// law like that in the paper's Fig. 4, so that its fits, phases and gains are known. They are no
// results.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "experiments/measure/run_summary.hpp"
#include "experiments/step/step_record.hpp"
#include "platform/random.hpp"
#include "platform/row_log.hpp"

namespace ballast {

struct SyntheticBox {
  double h = 2e-4, duration = 1.0, frequency = 5.0;
  double grain_mass = 214.0, wall_mass = 214.0, f_max = 6300.0;
  double gravity = 9.81;
  double active_force = 500.0, active_rate = 100.0;    ///< f_g = 500 N exp(xi 100/m)
  double passive_force = 1500.0, passive_slope = 6e5;  ///< f_g = 1500 N - 6e5 N/m xi
  double first_contraction = 6e-3;                     ///< [m]
  double ratchet = 0.05e-3;                            ///< contraction per period [m]
  double solid_initial = 0.501, solid_jump = 0.018, solid_gain = 0.0012;
  double noise = 1.0;      ///< of f_g, iterations and times; 0 gives the bare formulas
  double jam_slip = 2e-6;  ///< |v| while jammed [m/s]
};

namespace synthetic {

/// The wall alone: semi-implicit Euler on m_w dv/dt = f_g - f between jams at x_jam.
class Wall {
 public:
  Wall(const SyntheticBox& box) : box_(box) {}

  void advance(double t, double f) {
    if (t < first_end()) return contract(t, f);
    const double h = box_.h;
    if (jammed_) {
      if (f > box_.active_force) {
        force = f;
        v = 0.0;
        return;
      }
      jammed_ = false;
      x_from_ = x;
      x_back_ = x - box_.ratchet;
    }
    v += h * (law() - f) / box_.wall_mass;
    x += h * v;
    force = law();                  // at the position that is recorded with it
    if (v < 0.0 && x <= x_back_) {  // stopped within one step: the impulse shows as a peak of f_g,
                                    // cut to something drawable
      x = x_back_;
      force = 1.6 * f;
      v = 0.0;
      jammed_ = true;
    }
  }
  double x = 0.0, v = 0.0, force = 0.0;

 private:
  double first_end() const { return 0.15; }
  double law() const {
    return v >= 0.0 ? box_.active_force * std::exp(box_.active_rate * (x - x_from_))
                    : box_.passive_force - box_.passive_slope * (x - x_back_);
  }
  void contract(double t, double f) {
    const double s = std::min(1.0, t / first_end()), w = std::numbers::pi / first_end();
    x = -box_.first_contraction * 0.5 * (1.0 - std::cos(std::numbers::pi * s));
    v = s < 1.0 ? -box_.first_contraction * 0.5 * w * std::sin(w * t) : 0.0;
    force = f;
  }
  SyntheticBox box_;
  bool jammed_ = true;
  double x_from_ = 0.0, x_back_ = 0.0;
};

}  // namespace synthetic

inline std::vector<StepRecord> synthetic_box(const SyntheticBox& box = {}) {
  Random random(7);
  const auto jitter = [&](double size) { return box.noise * size * random.uniform(-1.0, 1.0); };
  const double omega = 2.0 * std::numbers::pi * box.frequency;
  synthetic::Wall wall(box);
  std::vector<StepRecord> steps;
  double kinetic = 0.0;
  const long count = std::lround(box.duration / box.h);
  for (long k = 0; k < count; ++k) {
    StepRecord s;
    const double mid = (static_cast<double>(k) + 0.5) * box.h;
    s.time = static_cast<double>(k + 1) * box.h;
    s.solved = 1.0;
    s.load = 0.5 * box.f_max * (1.0 - std::sin(omega * mid));
    wall.advance(s.time, s.load);
    s.wall_x = wall.x;
    s.wall_v = wall.v != 0.0 ? wall.v : box.jam_slip * std::sin(1e3 * s.time);
    const bool moves = wall.v != 0.0;
    s.wall_force = wall.force * (1.0 + jitter(moves ? 0.25 : 2e-4));
    const double settled = std::min(1.0, s.time / 0.15);
    s.solid_fraction = box.solid_initial + box.solid_jump * settled +
                       box.solid_gain * box.frequency * std::max(0.0, s.time - 0.2) -
                       0.4 * (wall.x + box.first_contraction * settled);
    s.contacts = 6300.0 + 400.0 * settled + std::round(jitter(60.0));
    s.active_contacts = 4100.0 + 700.0 * settled + std::round(jitter(60.0));
    s.iterations = std::round((moves ? 90.0 : 35.0) * (1.0 + jitter(0.2)));
    s.error_rms = 1.962e-3 * (moves ? 9e-4 : 4e-4) * std::exp(jitter(0.3));
    s.error_max = 30.0 * s.error_rms * std::exp(jitter(0.5));
    s.penetration_max =
        (20e-6 + 150e-6 * std::exp(-s.time / 0.1) * settled) * std::exp(jitter(0.3));
    s.penetration_mean = (1.1e-6 + 3e-6 * std::exp(-s.time / 0.1)) * std::exp(jitter(0.1));
    const double kinetic_new = 0.5 * (box.wall_mass + 0.3 * box.grain_mass) * wall.v * wall.v;
    s.work_load = -s.load * wall.v * box.h;
    s.work_gravity = 2e-4 * std::max(0.0, s.work_load);
    s.energy_residual = 1e-9 * (1.0 + jitter(1.0));
    s.dissipated = s.work_load + s.work_gravity + s.energy_residual - (kinetic_new - kinetic);
    s.kinetic_energy = kinetic = kinetic_new;
    s.work_correction = 1e-6;
    s.seconds_detect = 3e-3 * (1.0 + jitter(0.1));
    s.seconds_assemble = 0.5e-3 * (1.0 + jitter(0.1));
    s.seconds_solve = 0.2e-3 * s.iterations;
    s.seconds_judge = 0.4e-3 * (1.0 + jitter(0.1));
    s.seconds_correct = 0.8e-3 * (1.0 + jitter(0.1));
    s.seconds_other = 1.2e-3 * (1.0 + jitter(0.1));
    steps.push_back(s);
  }
  return steps;
}

/// The facts of such a box, which its record does not contain.
inline RunFacts facts_of(const SyntheticBox& box) {
  RunFacts facts;
  facts.step = box.h;
  facts.velocity_scale = box.gravity * box.h;
  facts.has_wall = facts.has_packing = true;
  facts.gravity = box.gravity;
  facts.frequency = box.frequency;
  facts.f_max = box.f_max;
  facts.f_min = 0.0;
  facts.grain_mass = box.grain_mass;
  facts.wall_mass = box.wall_mass;
  facts.solid_fraction_initial = box.solid_initial;
  return facts;
}

/// A cube of 1 kg that slides down an incline and comes to rest: no wall, no packing.
inline std::vector<StepRecord> synthetic_slide() {
  std::vector<StepRecord> steps;
  double v = 2.0;
  const double h = 1e-3, a = 0.4 * 9.81;
  for (int k = 0; k < 800; ++k) {
    StepRecord s;
    const double before = v;
    v = std::max(0.0, v - h * a);
    s.time = (k + 1) * h;
    s.contacts = s.active_contacts = 4;
    s.solved = 1.0;
    s.iterations = 3;
    s.error_rms = s.error_max = 1e-12;
    s.kinetic_energy = 0.5 * v * v;
    s.dissipated = 0.5 * (before * before - v * v);
    s.seconds_solve = 1e-5;
    steps.push_back(s);
  }
  return steps;
}

/// Writes the log of an unfinished run. Columns named in `without` are unknown in every row.
inline void write_rows(const std::filesystem::path& folder, const std::vector<StepRecord>& steps,
                       const std::vector<std::string>& without = {}) {
  std::filesystem::create_directories(folder / "log");
  RowWriter log(folder / "log" / "steps.bin", {"", 0, step_columns().size()});
  for (const StepRecord& step : steps) {
    std::vector<double> row;
    for (const StepColumn& column : step_columns())
      row.push_back(std::ranges::count(without, column.name) ? not_known : step.*column.value);
    log.append(row);
  }
  log.flush();
}

}  // namespace ballast

#include "experiments/paper/wall_model.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/paper/sections.hpp"
#include "experiments/run_page/figures.hpp"

namespace ballast {
namespace {

/// The phases of the wall's cycle:
/// jammed_before -> out -> turning -> in -> jammed_after; a turning wall may also go out again.
enum class ModelPhase { jammed_before, out, turning, in, jammed_after };

struct Moving {
  double x = 0.0, v = 0.0;
};

double packing_force(const WallModel& model, ModelPhase phase, double x) {
  return phase == ModelPhase::out ? model.active.at(x) : model.passive.at(x + model.contraction);
}

/// One step of Heun's rule (second order) with the force law of a phase.
Moving advanced(const WallModel& model, ModelPhase phase, const Moving& from, double t, double dt) {
  // m_w dv/dt = f_g(x) - f(t), outwards positive.
  const auto acceleration = [&](double x, double time) {
    return (packing_force(model, phase, x) - model.load.at(time)) / model.wall_mass;
  };
  const double a = acceleration(from.x, t);
  const Moving guess{from.x + dt * from.v, from.v + dt * a};
  const double b = acceleration(guess.x, t + dt);
  return {from.x + 0.5 * dt * (from.v + guess.v), from.v + 0.5 * dt * (a + b)};
}

/// The next phase of a wall at rest: it goes out when the load lets it, or is pushed in.
ModelPhase released(const WallModel& model, ModelPhase phase, double x, double load) {
  // The packing bears the load at rest between active(x), below which it pushes the wall out, and
  // passive(x), above which it gives way inwards.
  const bool can_go_out = load < model.active.at(x);
  if (phase == ModelPhase::jammed_before) return can_go_out ? ModelPhase::out : phase;
  if (phase == ModelPhase::jammed_after) return phase;
  if (load > model.passive.at(x + model.contraction)) return ModelPhase::in;
  return can_go_out ? ModelPhase::out : ModelPhase::turning;
}

/// The last period of the simulation and the model: x from the jamming position against time, and
/// f_g smoothed against v. Axes in s, mm, mm/s, kN or N.
Figure draw(const MeasuredRun& run, const ModelMotion& model) {
  const ForceUnit unit = force_unit(run.summary.facts.f_max);
  const WallPeriod& period = run.summary.wall.periods.back();
  std::vector<double> time, x;
  Curve loop{.title = "simulation"}, model_loop{.title = "model", .ink = Ink::black, .dash = 1};
  for (size_t k = period.first; k < period.last; ++k) {
    time.push_back(run.data.steps[k].time - period.begin);
    x.push_back(1e3 * (run.data.steps[k].wall_x - period.x_before));
    loop.add(1e3 * run.summary.wall.velocity[k], unit.factor * run.summary.wall.force[k]);
  }
  // every twentieth of the model's many steps suffices for the same line
  for (size_t k = 0; k < model.v.size(); k += 20)
    model_loop.add(1e3 * model.v[k], unit.factor * model.force[k]);
  Curve motion = line_of(model.time, values_of(model.x, [](double at) { return 1e3 * at; }),
                         "model", Ink::black, 2.0);
  motion.dash = 1;
  return {.height = 760,
          .panels = {{.x_label = page::marked("*t* in the period  (s)"),
                      .y_label = page::marked("*x* − *x*~jam~  (mm)"),
                      .curves = {line_of(time, x, "simulation", Ink::blue, 2.0), motion}},
                     {.x_label = page::marked("*v*  (mm/s)"),
                      .y_label = page::marked("*f*~g~  (") + unit.name + ")",
                      .curves = {loop, model_loop}}}};
}

}  // namespace

ModelMotion integrate(const WallModel& model, int parts) {
  const double dt = 1.0 / (model.load.frequency * parts);
  ModelMotion motion;
  ModelPhase phase = ModelPhase::jammed_before;
  Moving wall;
  for (int k = 0; k <= parts; ++k) {
    const double t = k * dt, load = model.load.at(t);
    // at rest the load decides whether the wall leaves, and which way
    const bool rests = phase != ModelPhase::out && phase != ModelPhase::in;
    if (rests) phase = released(model, phase, wall.x, load);
    const bool moves = phase == ModelPhase::out || phase == ModelPhase::in;
    motion.time.push_back(t);
    motion.x.push_back(wall.x);
    motion.v.push_back(wall.v);
    motion.force.push_back(moves ? packing_force(model, phase, wall.x) : load);
    motion.rise = std::max(motion.rise, wall.x);
    motion.speed_in = std::max(motion.speed_in, -wall.v);
    if (!moves) continue;
    // one step on: the wall stops where its velocity changes sign, and stays where it comes back to
    // its jamming position
    wall = advanced(model, phase, wall, t, dt);
    if ((phase == ModelPhase::out && wall.v <= 0.0) || (phase == ModelPhase::in && wall.v >= 0.0)) {
      phase = ModelPhase::turning;
      wall.v = 0.0;
    }
    if (phase == ModelPhase::in && wall.x <= -model.contraction) {
      wall = {-model.contraction, 0.0};
      phase = ModelPhase::jammed_after;
    }
  }
  return motion;
}

void fill_model(PaperData& data, PaperSection& section) {
  const std::vector<MeasuredRun> runs = data.records("motion");
  page::Table table = page::words_table("fig5.table");
  std::vector<double> rises, speeds;
  Figure drawn;
  for (size_t k = 0; k < runs.size(); ++k) {
    const RunSummary& s = runs[k].summary;
    if (s.wall.periods.empty() || !std::isfinite(s.law.active.rate) ||
        !std::isfinite(s.law.passive.slope) || !std::isfinite(s.facts.wall_mass))
      continue;  // a run too short for the fits
    const ModelMotion model =
        integrate({.active = s.law.active,
                   .passive = s.law.passive,
                   .contraction = std::max(0.0, -s.net.mean),
                   .wall_mass = s.facts.wall_mass,
                   .load = {s.facts.f_min, s.facts.f_max, s.facts.frequency}});
    rises.push_back(model.rise / s.rise.mean - 1.0);
    speeds.push_back(model.speed_in / s.speed_in.mean - 1.0);
    table.rows.push_back({std::to_string(k + 1), page::number(1e3 * s.rise.mean),
                          page::number(1e3 * model.rise), page::percent(rises.back()),
                          page::number(1e3 * s.speed_in.mean), page::number(1e3 * model.speed_in),
                          page::percent(speeds.back())});
    if (drawn.panels.empty()) drawn = draw(runs[k], model);
  }
  if (rises.empty()) return;
  const SampleMean rise = sample_mean(rises), speed = sample_mean(speeds);
  const page::Values words{{"sample", table.rows.front().front()},
                           {"rise", page::percent(rise.mean)},
                           {"speed", page::percent(speed.mean)}};
  section.draw("fig5", drawn, words);
  section.add(table);
  section.claim("fig5.rise", words, PaperRange::about(0.0, 0.15), found(rise));
  section.claim("fig5.speed", words, PaperRange::at_most(0.0), found(speed));
}

}  // namespace ballast

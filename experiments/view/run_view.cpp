#include "experiments/view/run_view.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "experiments/record/recorder.hpp"
#include "experiments/run/prepared_run.hpp"
#include "platform/atomic_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

constexpr size_t most_rows = 6000;  // of the curves: more than a screen has columns

/// The record does not say which wall is driven: the scene does.
int driven_wall_of(const RunData& run, const MechanicalSystem& system) {
  if (!run.scene) return -1;
  std::string name = run.scene->grains ? "x_max" : "";
  for (const WallSpec& wall : run.scene->walls)
    if (wall.motion == WallMotion::driven) name = wall.name;
  for (size_t b = static_cast<size_t>(system.grain_count); b < system.bodies.size(); ++b)
    if (system.bodies[b].name == name) return static_cast<int>(b);
  return -1;
}

/// Every stride-th row as a curve, in the reader's unit.
void add_series(const RunData& run, size_t stride, double StepRecord::*value, double factor,
                const ViewSeries& series, ViewData& view) {
  view.series.push_back(series);
  for (size_t k = 0; k < run.steps.size(); k += stride)
    view.series.back().values.push_back(factor * (run.steps[k].*value));
}

void add_wall_curves(const RunData& run, size_t stride, ViewData& view) {
  double largest = 0.0;
  for (const StepRecord& step : run.steps) largest = std::max(largest, std::abs(step.load));
  const bool in_kilo = largest >= 1000.0;
  const double factor = in_kilo ? 1e-3 : 1.0;
  const std::string unit = in_kilo ? "kN" : "N";
  add_series(run, stride, &StepRecord::wall_x, 1e3,
             {"x", "x", "displacement of the wall, outward", "mm", "blue", {}}, view);
  add_series(run, stride, &StepRecord::wall_force, factor,
             {"fg", "f_g", "force of the grains on the wall", unit, "grey", {}}, view);
  add_series(run, stride, &StepRecord::load, factor,
             {"f", "f", "load on the wall, inward", unit, "vermilion", {}}, view);
  view.plots.push_back({"x(t)", "", {"x"}});
  view.plots.push_back({"f(t)", "", {"fg", "f"}});
  view.plots.push_back({"f_g(x)", "x", {"fg"}});
}

void add_curves(const RunData& run, ViewData& view) {
  const size_t stride = (run.steps.size() + most_rows - 1) / most_rows;
  for (size_t k = 0; k < run.steps.size(); k += stride)
    view.series_time.push_back(run.steps[k].time);
  if (view.driven_wall >= 0) add_wall_curves(run, stride, view);
  if (run.scene && run.scene->grains) {
    add_series(run, stride, &StepRecord::solid_fraction, 1.0,
               {"rho", "ρ", "solid fraction", "", "green", {}}, view);
    view.plots.push_back({"ρ(t)", "", {"rho"}});
  } else {
    add_series(run, stride, &StepRecord::kinetic_energy, 1.0,
               {"energy", "E", "kinetic energy", "J", "purple", {}}, view);
    add_series(run, stride, &StepRecord::active_contacts, 1.0,
               {"contacts", "n", "contact points with a force", "", "green", {}}, view);
    view.plots.push_back({"E(t)", "", {"energy"}});
    view.plots.push_back({"n(t)", "", {"contacts"}});
  }
}

}  // namespace

std::optional<ViewData> view_of_run(const RunData& run) {
  const fs::path record = run.folder / "record.h5";
  if (!is_there(record) && !is_there(run.folder / "log" / "poses.bin")) return std::nullopt;
  ViewData view;
  view.frames = read_poses(run.folder);
  if (view.frames.empty()) return std::nullopt;
  for (PoseFrame& frame : view.frames) frame.spin = std::vector<Vec3>();  // nobody sees it
  MotionState state;
  view.system = recorded_system(run.folder, state);
  if (view.frames.front().pose.size() != view.system.bodies.size()) return std::nullopt;
  if (is_there(record)) {
    const auto forces = std::make_shared<RecordForces>(record);
    if (forces->frame_count() > 0)
      view.contacts = [forces](size_t frame) { return forces->of_frame(frame); };
  }
  if (run.scene) view.title = run.scene->title;
  view.friction = view.system.friction;
  view.driven_wall = driven_wall_of(run, view.system);
  add_curves(run, view);
  return view;
}

}  // namespace ballast

#include "experiments/view/view_data.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "experiments/box/packing.hpp"
#include "experiments/record/recorder.hpp"
#include "experiments/run/prepared_run.hpp"
#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/mesh_file.hpp"
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

void add_curves(const RunData& run, ViewData& view) {
  const size_t stride = (run.steps.size() + most_rows - 1) / most_rows;
  // every stride-th row, in the reader's unit
  const auto add = [&](const ViewSeries& series, double StepRecord::*value, double factor = 1.0) {
    view.series.push_back(series);
    for (size_t k = 0; k < run.steps.size(); k += stride)
      view.series.back().values.push_back(factor * (run.steps[k].*value));
  };
  for (size_t k = 0; k < run.steps.size(); k += stride)
    view.series_time.push_back(run.steps[k].time);
  if (view.driven_wall >= 0) {
    double largest = 0.0;
    for (const StepRecord& step : run.steps) largest = std::max(largest, std::abs(step.load));
    const double factor = largest >= 1000.0 ? 1e-3 : 1.0;
    const std::string unit = largest >= 1000.0 ? "kN" : "N";
    add({"x", "x", "mm", "blue", {}}, &StepRecord::wall_x, 1e3);
    add({"fg", "f_g", unit, "grey", {}}, &StepRecord::wall_force, factor);
    add({"f", "f", unit, "vermilion", {}}, &StepRecord::load, factor);
    view.plots = {{"", {"x"}}, {"", {"fg", "f"}}, {"x", {"fg"}}};
  }
  if (run.scene && run.scene->grains) {
    add({"rho", "ρ", "", "green", {}}, &StepRecord::solid_fraction);
    view.plots.push_back({"", {"rho"}});
  } else {
    add({"energy", "E", "J", "purple", {}}, &StepRecord::kinetic_energy);
    add({"contacts", "n", "", "green", {}}, &StepRecord::active_contacts);
    view.plots.insert(view.plots.end(), {{"", {"energy"}}, {"", {"contacts"}}});
  }
}

ViewData view_of_state(MechanicalSystem system, const MotionState& state, std::string title) {
  ViewData view;
  view.title = std::move(title);
  view.friction = system.friction;
  view.driven_wall = system.first_driven_wall();
  view.system = std::move(system);
  view.frames = {{state.time, state.step, state.pose, state.velocity, state.spin}};
  return view;
}

}  // namespace

std::optional<ViewData> view_of_run(const RunData& run) {
  const fs::path record = run.folder / "record.h5";
  if (!is_there(record) && !is_there(run.folder / "log" / "poses.bin")) return std::nullopt;
  ViewData view;
  view.frames = read_poses(run.folder);
  if (view.frames.empty()) return std::nullopt;
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

ViewData view_of_scene(const Scene& scene, const fs::path& packing_cache) {
  MotionState state;
  const std::string title = scene.title.empty() ? scene.name : scene.title;
  if (!scene.grains) {
    MechanicalSystem system = make_system(scene, state);
    return view_of_state(std::move(system), state, title);
  }
  const Rain rain = make_rain(scene);
  const std::string key = packing_key(scene);
  Packing packing;
  const bool is_packed = read_packing(packing_file(packing_cache, key), key, packing);
  MechanicalSystem system = is_packed
                                ? drive_system(scene, rain, packing, state)
                                : box_system(scene, rain, BoxStage::rain, rain.height, &state);
  return view_of_state(std::move(system), state,
                       title + (is_packed ? ": the packing" : ": the rain before the deposit"));
}

ViewData view_of_mesh(const fs::path& file) {
  constexpr double stone = 2700.0;  // density of a mesh that says none [kg/m^3]
  const PrincipalShape grain = to_principal_frame(read_mesh(file));
  Scene scene;
  BodySpec body;
  body.name = file.stem().string();
  body.shape = std::make_shared<const Polyhedron>(grain.shape);
  body.mass = stone * grain.volume;
  body.inertia = stone * grain.inertia;
  scene.bodies = {body};
  MotionState state;
  MechanicalSystem system = make_system(scene, state);
  return view_of_state(std::move(system), state, file.filename().string());
}

}  // namespace ballast

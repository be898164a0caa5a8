#include "experiments/view/still_scene.hpp"

#include "experiments/box/packing_cache.hpp"
#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/mesh_file.hpp"

namespace ballast {
namespace {

constexpr double stone = 2700.0;  // density of a mesh that says none [kg/m^3]

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

ViewData view_of_scene(const Scene& scene, const std::filesystem::path& packing_cache) {
  MotionState state;
  const std::string title = scene.title.empty() ? scene.name : scene.title;
  if (!scene.grains) {
    MechanicalSystem system = make_system(scene, state);
    return view_of_state(std::move(system), state, title);
  }
  const Rain rain = make_rain(scene);
  const std::string key = packing_key(scene);
  Packing packing;
  if (read_packing(packing_file(packing_cache, key), key, packing)) {
    MechanicalSystem system = drive_system(scene, rain, packing, state);
    return view_of_state(std::move(system), state, title + ": the packing");
  }
  MechanicalSystem system = box_system(scene, rain, BoxStage::rain, rain.height, &state);
  return view_of_state(std::move(system), state, title + ": the rain before the deposit");
}

ViewData view_of_mesh(const std::filesystem::path& file) {
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

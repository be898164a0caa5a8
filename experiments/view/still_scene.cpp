#include "experiments/view/still_scene.hpp"

#include "experiments/box/packing_cache.hpp"
#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/mesh_file.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

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

bool is_packing_file(const fs::path& file) {
  return file.extension() == ".bin" && file.filename().string().starts_with("packing-");
}

ViewData view_of_packing(const fs::path& file, const std::vector<Scene>& scenes) {
  if (!is_there(file)) throw Error(file.string() + ": no such file");
  for (const Scene& scene : scenes) {
    if (!scene.grains) continue;
    const std::string key = packing_key(scene);
    if (packing_file("", key).filename() != file.filename()) continue;
    Packing packing;
    read_packing(file, key, packing);
    MotionState state;
    MechanicalSystem system = drive_system(scene, make_rain(scene), packing, state);
    ViewData view = view_of_state(std::move(system), state, file.filename().string());
    std::vector<FrameContact> contacts;
    const StepMemory& memory = packing.memory;
    for (size_t c = 0; c < memory.contacts.size(); ++c)
      if (const Vec3 force = memory.impulses[c] / scene.deposit.settle_step; !force.isZero())
        contacts.push_back({memory.contacts[c].body_a, memory.contacts[c].body_b,
                            memory.contacts[c].position.cast<float>(),
                            memory.contacts[c].normal.cast<float>(), force.cast<float>()});
    view.contacts = [contacts](size_t) { return contacts; };
    return view;
  }
  throw Error(file.string() +
              ": holds no shapes, and none of the scenes tried makes it: --scene FILE, with --set "
              "where the run had it");
}

std::vector<Scene> scenes_around(const fs::path& packing) {
  std::vector<fs::path> files;
  for (const auto& [name, title] : list_scenes()) files.push_back(find_scene(name));
  const fs::path results = fs::absolute(packing).parent_path().parent_path();
  for (const fs::path& folder : {results, results / "runs"}) {
    if (!is_folder(folder)) continue;
    for (const auto& entry : fs::directory_iterator(folder))
      if (is_there(entry.path() / "scene.toml")) files.push_back(entry.path() / "scene.toml");
  }
  std::vector<Scene> scenes;
  for (const fs::path& file : files) try {
      scenes.push_back(read_scene(file));
    } catch (const std::exception&) {
      // a damaged scene of some run is not what was asked for
    }
  return scenes;
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

// What is in a file, and whether it is sound: scene, mesh, stored problem, checkpoint.

#include <algorithm>
#include <iostream>
#include <memory>

#include "experiments/commands/command.hpp"
#include "experiments/record/checkpoint.hpp"
#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/mesh_file.hpp"
#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "problems/files/problem_file.hpp"
#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

struct CheckOptions {
  std::vector<std::string> files;
  std::vector<std::string> overrides;
  double scale = 1.0;
  bool hull = false;
};

std::string check_scene(const std::string& file, const CheckOptions& options) {
  const Scene scene = read_scene(file, options.overrides);
  make_solver(scene.solver.name);
  const std::string what =
      scene.grains
          ? printed("%d grains in a box of %g m x %g m, driven at %g Hz", scene.grains->count,
                    scene.box.length, scene.box.width, scene.drive.frequency)
          : printed("%zu bodies, %zu walls", scene.bodies.size(), scene.walls.size());
  return printed("scene %s: %s, %ld steps of %g s, solver %s", scene.name.c_str(), what.c_str(),
                 scene.step_count(), scene.step, scene.solver.name.c_str());
}

std::string check_mesh(const std::string& file, const CheckOptions& options) {
  const Polyhedron mesh =
      options.hull ? read_mesh_hull(file, options.scale) : read_mesh(file, options.scale);
  const PrincipalShape principal = to_principal_frame(mesh);
  const Vec3 centre = principal.pose.position, inertia = principal.inertia;
  return printed(
      "mesh: %d vertices, %d edges, %d faces, volume %g m^3, centre of mass (%g, %g, %g) m, "
      "circumradius %g m, inradius %g m, principal inertia per density (%g, %g, %g) m^5",
      mesh.vertex_count(), mesh.edge_count(), mesh.face_count(), principal.volume, centre.x(),
      centre.y(), centre.z(), principal.shape.circumradius(), principal.shape.inradius(),
      inertia.x(), inertia.y(), inertia.z());
}

std::string check_problem(const std::string& file) {
  const FrictionProblem problem = read_problem(file);
  problem.validate();
  std::string text =
      printed("problem: %d contacts, %d rows", problem.contact_count(), problem.row_count());
  if (problem.has_dynamics)
    text += printed(", M and H of %d bodies, %d unknowns", problem.dynamics.body_count(),
                    problem.dynamics.dof_count());
  if (problem.has_delassus)
    text += printed(", W with %ld entries", static_cast<long>(problem.delassus.w.nonZeros()));
  if (problem.contact_count() > 0) {
    const auto [low, high] = std::minmax_element(problem.friction.begin(), problem.friction.end());
    text += printed(", friction %g to %g", *low, *high);
  }
  return text;
}

std::string check_checkpoint(const std::string& file) {
  const Checkpoint checkpoint = read_checkpoint(file);
  return printed("checkpoint of scene %s: phase %s, step %ld, %g s, %zu bodies, %zu contacts",
                 checkpoint.key.c_str(), checkpoint.phase.c_str(), checkpoint.state.step,
                 checkpoint.state.time, checkpoint.state.pose.size(),
                 checkpoint.memory.contacts.size());
}

/// What is in the file, by its suffix.
std::string check(const std::string& file, const CheckOptions& options) {
  std::filesystem::path path = file;
  if (!path.has_filename()) path = path.parent_path();  // a folder, written with its slash
  std::string suffix = path.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix == ".toml") return check_scene(file, options);
  if (suffix == ".obj" || suffix == ".stl") return check_mesh(file, options);
  if (suffix == ".hdf5" || suffix == ".h5" || suffix == ".dat") return check_problem(file);
  if (suffix == ".bin" || suffix == ".part") return check_checkpoint(file);
  if (is_there(file) || !suffix.empty())
    throw UsageError(
        file + ": unknown kind of file, expected .toml, .obj, .stl, .hdf5, .h5, .dat or .bin");
  return check_scene(find_scene(file).string(), options);
}

}  // namespace

Command check_command() {
  const auto options = std::make_shared<CheckOptions>();
  return {
      "check",
      "Says what is in files, or what is wrong with the first bad one",
      {{"files", &options->files,
        "Scenes (.toml, or by name), meshes (.obj, .stl), problems (.hdf5, .dat), checkpoints "
        "(.bin)",
        required},
       {"--set KEY=VALUE", &options->overrides,
        "Overrides one value of the scenes: dotted.key=value"},
       {"--scale", &options->scale, "Metres per unit of the meshes: 0.001 for millimetres", shown,
        above(0)},
       {"--hull", &options->hull, "Meshes: the convex hull of the vertices, for scanned grains"}},
      [options] {
        for (const std::string& file : options->files)
          std::cout << file << ": " << check(file, *options) << '\n';
        return ExitCode::ok;
      }};
}

}  // namespace ballast

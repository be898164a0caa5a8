// What is in a file, and whether it is sound: scene, mesh, stored problem, checkpoint.

#include <algorithm>
#include <iostream>
#include <memory>

#include "experiments/commands/command.hpp"
#include "experiments/record/checkpoint.hpp"
#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/mesh_file.hpp"
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

void check_scene(const std::string& file, const CheckOptions& options) {
  const Scene scene = read_scene(file, options.overrides);
  make_solver(scene.solver.name);
  std::cout << file << ": scene " << scene.name << ": ";
  if (scene.grains)
    std::cout << scene.grains->count << " grains in a box of " << scene.box.length << " m x "
              << scene.box.width << " m, driven at " << scene.drive.frequency << " Hz";
  else
    std::cout << scene.bodies.size() << " bodies, " << scene.walls.size() << " walls";
  std::cout << ", " << scene.step_count() << " steps of " << scene.step << " s, solver "
            << scene.solver.name << '\n';
}

void check_mesh(const std::string& file, const CheckOptions& options) {
  const Polyhedron mesh =
      options.hull ? read_mesh_hull(file, options.scale) : read_mesh(file, options.scale);
  const PrincipalShape principal = to_principal_frame(mesh);
  std::cout << file << ": mesh: " << mesh.vertex_count() << " vertices, " << mesh.edge_count()
            << " edges, " << mesh.face_count() << " faces, volume " << principal.volume
            << " m^3, centre of mass (" << principal.pose.position.x() << ", "
            << principal.pose.position.y() << ", " << principal.pose.position.z()
            << ") m, circumradius " << principal.shape.circumradius() << " m, inradius "
            << principal.shape.inradius() << " m, principal inertia per density ("
            << principal.inertia.x() << ", " << principal.inertia.y() << ", "
            << principal.inertia.z() << ") m^5\n";
}

void check_problem(const std::string& file) {
  const FrictionProblem problem = read_problem(file);
  problem.validate();
  std::cout << file << ": problem: " << problem.contact_count() << " contacts, "
            << problem.row_count() << " rows";
  if (problem.has_dynamics)
    std::cout << ", M and H of " << problem.dynamics.body_count() << " bodies, "
              << problem.dynamics.dof_count() << " unknowns";
  if (problem.has_delassus) std::cout << ", W with " << problem.delassus.w.nonZeros() << " entries";
  if (problem.contact_count() > 0) {
    const auto [low, high] = std::minmax_element(problem.friction.begin(), problem.friction.end());
    std::cout << ", friction " << *low << " to " << *high;
  }
  std::cout << '\n';
}

void check_checkpoint(const std::string& file) {
  const Checkpoint checkpoint = read_checkpoint(file);
  std::cout << file << ": checkpoint of scene " << checkpoint.key << ": phase " << checkpoint.phase
            << ", step " << checkpoint.state.step << ", " << checkpoint.state.time << " s, "
            << checkpoint.state.pose.size() << " bodies, " << checkpoint.memory.contacts.size()
            << " contacts\n";
}

void check(const std::string& file, const CheckOptions& options) {
  std::filesystem::path path = file;
  if (!path.has_filename()) path = path.parent_path();  // a folder, written with its slash
  std::string suffix = path.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix == ".toml")
    check_scene(file, options);
  else if (suffix == ".obj" || suffix == ".stl")
    check_mesh(file, options);
  else if (suffix == ".hdf5" || suffix == ".h5" || suffix == ".dat")
    check_problem(file);
  else if (suffix == ".bin" || suffix == ".part")
    check_checkpoint(file);
  else if (std::filesystem::exists(file) || !suffix.empty())
    throw UsageError(
        file + ": unknown kind of file, expected .toml, .obj, .stl, .hdf5, .h5, .dat or .bin");
  else
    check_scene(find_scene(file).string(), options);
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
      "Examples:\n  ballast check mine.toml grain.stl problem.hdf5 results/mine/checkpoint.bin\n"
      "  ballast check scan.stl --hull --scale 0.001",
      [options] {
        for (const std::string& file : options->files) check(file, *options);
        return ExitCode::ok;
      }};
}

}  // namespace ballast

// The commands solvers and scenes (lists), check (the content of files and whether it is sound) and
// convert (stored problems from one format into another).

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>

#include "experiments/commands/command.hpp"
#include "experiments/record/checkpoint.hpp"
#include "experiments/run/run.hpp"
#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/mesh_file.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/hdf5_file.hpp"
#include "platform/text.hpp"
#include "problems/files/problem_file.hpp"
#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// Prints a scene as it stands in its file, or resolved; then without scene.name where that is only
/// the file's name: copied into a user's file, it would lead into the results of the printed scene.
void print_scene(const std::string& name, const std::vector<std::string>& overrides,
                 bool resolved) {
  const fs::path file = find_scene(name);
  std::string text = read_whole_file(file);
  if (resolved || !overrides.empty()) {
    text = resolve_scene(file, overrides).text;
    const std::string line = "\nname = \"" + file.stem().string() + "\"\n";
    if (const size_t at = text.find(line, text.find("[scene]")); at != std::string::npos)
      text.erase(at, line.size() - 1);
  }
  std::cout << text;
}

struct CheckOptions {
  std::vector<std::string> files;
  std::vector<std::string> overrides;
  double scale = 1.0;
  bool hull = false;
};

std::string check_scene(const std::string& file, const CheckOptions& options) {
  const Scene scene = resolve_run(file, options.overrides).scene;
  require_backends(scene);
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
    const auto [low, high] = std::ranges::minmax(problem.friction);
    text += printed(", friction %g to %g", low, high);
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

/// Describes the content of the file, by its suffix.
std::string check(const std::string& file, const CheckOptions& options) {
  fs::path path = file;
  if (!path.has_filename()) path = path.parent_path();  // a folder, written with its slash
  std::string suffix = path.extension().string();
  for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (suffix == ".toml") return check_scene(file, options);
  if (suffix == ".obj" || suffix == ".stl") return check_mesh(file, options);
  if (suffix == ".hdf5" || suffix == ".h5" || suffix == ".dat") return check_problem(file);
  if (suffix == ".bin" || suffix == ".part") return check_checkpoint(file);
  if (path_exists(file) || !suffix.empty())
    throw UsageError(
        file + ": unknown kind of file, expected .toml, .obj, .stl, .hdf5, .h5, .dat or .bin");
  return check_scene(file, options);
}

struct ConvertOptions {
  std::vector<std::string> problems;
  StoredForms forms = StoredForms::delassus;
  fs::path output;
};

/// Throws std::invalid_argument.
StoredForms forms_of(const std::string& name) {
  if (name == "local") return StoredForms::delassus;
  if (name == "global") return StoredForms::as_known;
  if (name == "both") return StoredForms::both;
  throw std::invalid_argument("'" + name + "': expected one of local, global, both");
}

/// Throws Error unless no file is there, or a problem of ours that holds nothing else.
void require_replaceable(const fs::path& target) {
  if (!is_file(target)) return;
  const Hdf5Reader file(target);
  const std::string root = file.has("/fclib_local") ? "/fclib_local" : "/fclib_global";
  constexpr const char* others[] = {"/ballast", "/ballast_request", "/ballast_answer", "/solution"};
  if (!file.has(root + "/info/title") || file.read_text(root + "/info/title") != "ballast" ||
      std::ranges::any_of(others, [&](const char* group) { return file.has(group); }))
    throw Error(target.string() + ": is no problem of convert: it would be written over");
}

/// Converts one problem into `target`, which holds no other problem.
void convert_one(const FoundProblem& found, StoredForms forms, const fs::path& target) {
  std::error_code error;
  if (fs::equivalent(target, found.file, error))
    throw Error(target.string() + ": would be written over what is read");
  require_replaceable(target);
  const FrictionProblem problem = read_problem(found.file);
  if (forms == StoredForms::as_known && !problem.has_dynamics)
    throw Error("only W is known: there are no bodies for the global form");
  if (target.has_parent_path()) create_folder(target.parent_path());
  write_problem(target, problem, forms);
  std::cout << printed("%-40s %7d contacts  ", found.name.c_str(), problem.contact_count())
            << target.string() << std::endl;
}

/// Returns whether --output is the file of one problem, and not a folder. Throws UsageError for
/// several problems, or a suffix that is not HDF5's.
bool names_a_file(const ConvertOptions& options, size_t problems) {
  if (!is_problem_file(options.output) || is_folder(options.output)) return false;
  const std::string named = "--output " + options.output.string();
  if (problems != 1)
    throw UsageError(named + ": one file for " + std::to_string(problems) +
                     " problems, expected a folder");
  if (options.output.extension() == ".dat")
    throw UsageError(named + ": only .hdf5 and .h5 are written");
  return true;
}

ExitCode convert(const ConvertOptions& options) {
  std::vector<FoundProblem> problems;
  for (const std::string& word : options.problems)
    for (FoundProblem& found : find_problems(word)) problems.push_back(std::move(found));
  const bool is_file = names_a_file(options, problems.size());
  std::vector<std::string> reasons;      // of the problems that are not converted
  std::map<fs::path, fs::path> written;  // the source of each target
  for (const FoundProblem& found : problems) {
    fs::path target = is_file ? options.output : options.output / found.name;
    if (!is_file) target.replace_extension(".hdf5");
    try {
      const auto [before, is_new] = written.try_emplace(target, found.file);
      if (!is_new) throw Error(target.string() + ": holds " + before->second.string() + " already");
      convert_one(found, options.forms, target);
    } catch (const std::exception& error) {
      // The other problems are still converted.
      std::string why = error.what();
      if (why.find(found.file.string()) == std::string::npos)
        why = found.file.string() + ": " + why;
      reasons.push_back(why);
    }
  }
  if (!reasons.empty())
    throw Error(printed("convert: %zu of %zu problems are not converted: ", reasons.size(),
                        problems.size()) +
                joined(reasons));
  return ExitCode::ok;
}

}  // namespace

Command solvers_command() {
  return {"solvers", "Lists the solvers: name, law, whether built, size limit, method", {}, [] {
            std::cout << printed("%-18s%-19s%-7s%-10s", "name", "law", "built", "largest")
                      << "what it is (largest: contacts that it takes)\n";
            for (const SolverEntry& entry : solver_list()) {
              const std::string largest =
                  entry.largest == 0 ? "any" : std::to_string(entry.largest);
              std::cout << printed("%-18s%-19s%-7s%-10s", entry.name, name_of(entry.law),
                                   entry.make ? "yes" : "no", largest.c_str())
                        << entry.description;
              if (!entry.make) std::cout << " [install " << entry.package << "]";
              std::cout << '\n';
            }
            return ExitCode::ok;
          }};
}

Command scenes_command() {
  struct Options {
    std::string name;
    std::vector<std::string> overrides;
    bool resolved = false;
  };
  const auto options = std::make_shared<Options>();
  return {"scenes",
          "Lists the scenes, or prints one",
          {{"name", &options->name, "The scene to print, as a start for your own"},
           {"--resolved", &options->resolved,
            "Prints it with every default filled in, as in a run's scene.toml", needs("name")},
           {"--set KEY=VALUE", &options->overrides,
            "Prints it resolved, with one value overridden: dotted.key=value", needs("name")}},
          [options] {
            if (!options->name.empty()) {
              print_scene(options->name, options->overrides, options->resolved);
              return ExitCode::ok;
            }
            std::cout << "in " << scene_folder().string() << ":\n";
            std::string unreadable;
            for (const auto& [name, title] : list_scenes(&unreadable))
              std::cout << printed("%-22s", name.c_str()) << title << '\n';
            if (!unreadable.empty()) throw Error(unreadable);
            return ExitCode::ok;
          }};
}

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
       {"--scale", &options->scale, "Metres per unit of the meshes: 0.001 for millimetres",
        above(0)},
       {"--hull", &options->hull, "Checks the convex hull of the mesh vertices (scanned grains)"}},
      [options] {
        for (const std::string& file : options->files) {
          const std::string what = check(file, *options);
          std::cout << file << ": " << what << '\n';
        }
        return ExitCode::ok;
      }};
}

Command convert_command() {
  const auto options = std::make_shared<ConvertOptions>();
  return {"convert",
          "Converts stored problems from one format into another, whole folders at once",
          {{"problems", &options->problems, "Files, folders, patterns: .hdf5, .h5, .dat", required},
           {"--to FORMAT", into(options->forms, forms_of, "local"),
            "local (FCLIB: W, q), global (FCLIB: M, H) or both"},
           {"--output PATH", &options->output,
            "Folder for converted problems; for a single one also a .hdf5 or .h5 file", required}},
          [options] { return convert(*options); }};
}

}  // namespace ballast

// What there is: solvers, scenes, version.

#include <fstream>
#include <iostream>
#include <memory>

#include "experiments/commands/command.hpp"
#include "experiments/run/build_info.hpp"
#include "experiments/run/manifest.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

void print_solvers() {
  std::cout << printed("%-18s%-19s%-7s%-10s", "name", "law", "built", "largest")
            << "what it is (largest: contacts with friction that it takes)\n";
  for (const SolverEntry& entry : solver_list()) {
    const std::string largest =
        entry.largest.none() ? "any" : std::to_string(entry.largest.with_friction);
    std::cout << printed("%-18s%-19s%-7s%-10s", entry.name, name_of(entry.law),
                         entry.make ? "yes" : "no", largest.c_str())
              << entry.description;
    if (!entry.make) std::cout << " [install " << entry.needs.package << "]";
    std::cout << '\n';
  }
}

void print_scenes() {
  std::cout << "in " << scene_folder().string() << ":\n";
  for (const auto& [name, title] : list_scenes())
    std::cout << printed("%-22s", name.c_str()) << title << '\n';
}

/// Without scene.name where it is only the file's: in a file of the user's own it would lead into
/// the results of the scene that was printed.
std::string without_name(std::string text, const std::string& name) {
  const std::string line = "\nname = \"" + name + "\"\n";
  const size_t at = text.find(line, text.find("[scene]"));
  return at == std::string::npos ? text : text.erase(at, line.size() - 1);
}

void print_scene(const std::string& name, const std::vector<std::string>& overrides,
                 bool resolved) {
  const std::filesystem::path file = find_scene(name);
  if (resolved || !overrides.empty()) {
    std::cout << without_name(resolved_scene_text(file, overrides), file.stem().string());
    return;
  }
  std::cout << std::ifstream(file).rdbuf();
}

void print_version() {
  const BuildInfo& info = build_info();
  std::cout << "ballast " << info.version << '\n'
            << "commit        " << info.commit << (info.modified ? "-dirty" : "") << '\n'
            << "compiler      " << info.compiler << '\n'
            << "build type    " << info.build_type << '\n'
            << "flags         " << info.flags << '\n';
  for (const auto& [name, version] : info.libraries)
    std::cout << printed("%-14s", name.c_str()) << version << '\n';
  std::cout << "processor     " << cpu_model() << '\n';
}

}  // namespace

Command solvers_command() {
  return {"solvers", "Lists the solvers: name, law, whether built, what it is", {}, [] {
            print_solvers();
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
          {{"name", &options->name, "The scene to print: a start for one of your own"},
           {"--resolved", &options->resolved, "With every default filled in, as runs keep it",
            needs("name")},
           {"--set KEY=VALUE", &options->overrides,
            "With this override, resolved: dotted.key=value", needs("name")}},
          [options] {
            if (options->name.empty())
              print_scenes();
            else
              print_scene(options->name, options->overrides, options->resolved);
            return ExitCode::ok;
          }};
}

Command version_command() {
  return {"version", "Version, commit, compiler, libraries, processor", {}, [] {
            print_version();
            return ExitCode::ok;
          }};
}

}  // namespace ballast

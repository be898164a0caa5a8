// Finds scenes by name, and reads single values of a scene without reading all of it.

#include <algorithm>
#include <cstdlib>

#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"
#include "problems/scene/toml_reader.hpp"

namespace ballast {
namespace fs = std::filesystem;

double scene_friction(const fs::path& file) {
  return load_toml(file)["contact"]["friction"].value_or(Scene{}.friction);
}

fs::path scene_folder() {
  if (const char* chosen = std::getenv("BALLAST_SCENES"); chosen && *chosen) return chosen;
  std::error_code unreadable;
  const fs::path program = fs::read_symlink("/proc/self/exe", unreadable);
  const fs::path installed = program.parent_path().parent_path() / "share/ballast/scenes";
  if (!unreadable && is_folder(installed)) return installed;
  return BALLAST_SCENE_FOLDER;  // of the source tree: problems/scenes
}

std::vector<std::pair<std::string, std::string>> list_scenes(std::string* unreadable) {
  std::vector<std::pair<std::string, std::string>> scenes;
  const fs::path folder = scene_folder();
  if (!is_folder(folder)) throw Error(folder.string() + ": no such folder of scenes");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    try {
      scenes.emplace_back(entry.path().stem().string(),
                          load_toml(entry.path())["scene"]["title"].value_or(std::string()));
    } catch (const Error& error) {
      if (unreadable) add_to_list(*unreadable, error.what());
    }
  }
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

fs::path find_scene(const std::string& name_or_path) {
  const fs::path path(name_or_path);
  if (is_file(path)) return path;
  const bool is_name =
      !name_or_path.empty() && !path.has_parent_path() && path.extension() != ".toml";
  if (path_exists(path) && !is_folder(path))
    throw Error(name_or_path + ": a pipe or a device, expected a scene file");
  if (!is_name) throw Error(name_or_path + ": no such scene file");
  const fs::path named = scene_folder() / (name_or_path + ".toml");
  if (is_file(named)) return named;
  std::vector<std::string> there;
  for (const auto& [name, title] : list_scenes()) there.push_back(name);
  throw Error(name_or_path + ": no scene of this name" + did_you_mean(name_or_path, there) +
              ", expected a file or one of " + joined(there));
}

}  // namespace ballast

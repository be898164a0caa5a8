#include "tests/house/source_tree.hpp"

#include <algorithm>
#include <fstream>
#include <functional>
#include <sstream>

namespace ballast::house {
namespace fs = std::filesystem;

fs::path root() { return BALLAST_SOURCE_FOLDER; }

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at)
    found.push_back((*at)[1]);
  return found;
}

SourceFile parse_source(const std::string& path, const std::string& text) {
  static const std::regex include(R"((?:^|\n)[ \t]*#include[ \t]+(["<][^">\n]+))");
  SourceFile file{path, text, {}};
  for (const std::string& header : matches(text, include))
    file.includes.push_back({header.substr(1), header[0] == '"'});
  return file;
}

std::vector<SourceFile> all_sources(bool with_tests) {
  std::vector<std::string> tops = {"platform", "geometry", "problems", "solvers", "experiments"};
  if (with_tests) tops.push_back("tests");
  std::vector<SourceFile> files;
  for (const std::string& top : tops)
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root() / top)) {
      const std::string suffix = entry.path().extension().string();
      if (suffix != ".cpp" && suffix != ".hpp") continue;
      files.push_back(
          parse_source(fs::relative(entry.path(), root()).string(), content(entry.path())));
    }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

std::string module_of(const std::string& path) { return path.substr(0, path.rfind('.')); }

std::string room_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

Arrows read_rooms(const std::string& text, const std::string& folder,
                  std::map<std::string, std::string>& folder_of) {
  Arrows arrows;
  constexpr std::string_view call = "ballast_room(";
  for (size_t at = text.find(call); at != std::string::npos; at = text.find(call, at + 1)) {
    const size_t begin = at + call.size();
    std::istringstream words(text.substr(begin, text.find(')', begin) - begin));
    std::string name, place, list;
    words >> name >> place;
    arrows[name];
    folder_of[name] = place == "." ? folder : folder + "/" + place;
    for (std::string word; words >> word;) {
      if (word == "DOORS" || word == "LIBRARIES" || word == "EXCEPT")
        list = word;
      else if (list == "DOORS")
        arrows[name].insert(word);
    }
  }
  return arrows;
}

Arrows doors() {
  std::map<std::string, std::string> folder_of;
  Arrows libraries;
  for (const char* top : {"platform", "geometry", "problems", "solvers", "experiments"}) {
    const Arrows found = read_rooms(content(root() / top / "CMakeLists.txt"), top, folder_of);
    libraries.insert(found.begin(), found.end());
  }
  Arrows rooms;
  for (const auto& [from, ignored] : libraries) {
    std::set<std::string> reached;
    const std::function<void(const std::string&)> follow = [&](const std::string& name) {
      if (reached.insert(name).second)
        for (const std::string& next : libraries[name]) follow(next);
    };
    follow(from);
    for (const std::string& to : reached) rooms[folder_of[from]].insert(folder_of[to]);
  }
  return rooms;
}

std::set<std::string> ring(Arrows arrows) {
  // Removes names that lead nowhere and the arrows to them; then names that nothing leads to.
  for (int way = 0; way < 2; ++way) {
    size_t before = 0;
    do {
      before = arrows.size();
      for (auto& [from, all] : arrows)
        std::erase_if(all, [&](const std::string& to) { return !arrows.contains(to); });
      std::erase_if(arrows, [](const auto& arrow) { return arrow.second.empty(); });
    } while (arrows.size() != before);
    Arrows turned;
    for (const auto& [from, all] : arrows)
      for (const std::string& to : all) turned[to].insert(from);
    arrows = std::move(turned);
  }
  std::set<std::string> names;
  for (const auto& [from, all] : arrows) names.insert(from);
  return names;
}

size_t columns(std::string_view line) {
  return static_cast<size_t>(std::count_if(line.begin(), line.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

}  // namespace ballast::house

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

SourceFile parse_source(const std::string& path, const std::string& text) {
  SourceFile file{path, text, {}};
  for (const std::string& line : lines_of(text)) {
    std::istringstream words(line);
    std::string word, header;
    if (!(words >> word >> header) || word != "#include") continue;
    const bool own = header[0] == '"';
    const size_t end = header.find(own ? '"' : '>', 1);
    if (end != std::string::npos) file.includes.push_back({header.substr(1, end - 1), own});
  }
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

std::vector<std::set<std::string>> rings(const Arrows& arrows) {
  struct Node {
    int index = -1, low = 0;
    bool on_stack = false;
  };
  std::map<std::string, Node> nodes;
  std::vector<std::string> stack;
  std::vector<std::set<std::string>> found;
  int next_index = 0;
  const std::function<void(const std::string&)> visit = [&](const std::string& name) {
    Node& node = nodes[name];
    node.index = node.low = next_index++;
    node.on_stack = true;
    stack.push_back(name);
    if (const auto out = arrows.find(name); out != arrows.end())
      for (const std::string& to : out->second) {
        if (nodes[to].index < 0) visit(to);
        if (nodes[to].on_stack) node.low = std::min(node.low, nodes[to].low);
      }
    if (node.low != node.index) return;
    std::set<std::string> ring;
    std::string top;
    do {
      top = stack.back();
      stack.pop_back();
      nodes[top].on_stack = false;
      ring.insert(top);
    } while (top != name);
    if (ring.size() > 1) found.push_back(ring);
  };
  for (const auto& [name, ignored] : arrows)
    if (nodes[name].index < 0) visit(name);
  return found;
}

size_t columns(std::string_view line) {
  return static_cast<size_t>(std::count_if(line.begin(), line.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

}  // namespace ballast::house

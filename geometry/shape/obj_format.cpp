#include "geometry/shape/obj_format.hpp"

#include <algorithm>
#include <array>

namespace ballast::raw_mesh {

namespace {

constexpr std::array<std::string_view, 15> kIgnored = {
    "vn", "vt",  "vp",     "o",      "g",      "s",      "mg",        "l",
    "p",  "lod", "usemtl", "mtllib", "usemap", "maplib", "shadow_obj"};

void read_vertex(std::string_view rest, const Place& place, RawMesh& mesh) {
  Vec3 p;
  for (double& x : p) x = parse_coordinate(next_word(rest), place);
  // a weight or a colour may follow: numbers too, but of no meaning here
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest))
    parse_coordinate(word, place);
  mesh.vertices.push_back(p);
  mesh.vertex_lines.push_back(place.line);
}

/// Corners are v, v/vt, v//vn or v/vt/vn; negative v count back from the last vertex so far.
void read_face(std::string_view rest, const Place& place, RawMesh& mesh) {
  std::vector<int> face;
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
    int index = 0;
    if (!parse(word.substr(0, word.find('/')), index) || index == 0)
      place.fail(quoted(word) + " is no vertex index (they count from 1, or from -1 backwards)");
    const int known = static_cast<int>(mesh.vertices.size());
    if (index < -known)
      place.fail("face names vertex " + std::to_string(index) + " of " + std::to_string(known));
    face.push_back(index > 0 ? index - 1 : known + index);
  }
  if (face.size() < 3)
    place.fail("face has " + std::to_string(face.size()) + " vertices: at least 3 are needed");
  mesh.faces.push_back(std::move(face));
  mesh.face_lines.push_back(place.line);
}

}  // namespace

RawMesh read_obj(const std::filesystem::path& file, std::string_view text) {
  RawMesh mesh;
  for (Place place{file, 1}; !text.empty(); ++place.line) {
    std::string_view line = next_line(text);
    line = line.substr(0, line.find('#'));
    const std::string_view keyword = next_word(line);
    if (keyword == "v") {
      read_vertex(line, place, mesh);
    } else if (keyword == "f") {
      read_face(line, place, mesh);
    } else if (!keyword.empty() &&
               std::find(kIgnored.begin(), kIgnored.end(), keyword) == kIgnored.end()) {
      place.fail("unknown OBJ statement " + quoted(keyword));
    }
  }
  // Indices are checked at the end: a face may name vertices that come after it.
  const int count = static_cast<int>(mesh.vertices.size());
  for (size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const int v : mesh.faces[f]) {
      if (v >= count)
        Place{file, mesh.face_lines[f]}.fail("face names vertex " + std::to_string(v + 1) + " of " +
                                             std::to_string(count));
    }
  }
  return mesh;
}

}  // namespace ballast::raw_mesh

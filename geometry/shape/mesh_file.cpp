#include "geometry/shape/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "geometry/shape/convex_hull.hpp"
#include "platform/atomic_file.hpp"
#include "platform/pack.hpp"
#include "platform/text.hpp"

namespace ballast {

namespace {

/// A mesh as it stands in the file: its vertex indices are in range, nothing else is checked. Lines
/// count from 1; in binary files they are 0.
struct RawMesh {
  std::vector<Vec3> vertices;
  std::vector<std::vector<int>> faces;
  std::vector<int> vertex_lines, face_lines;
  bool is_single = false;  ///< its numbers are single precision
};

/// A place in a file, for messages "file: line N: defect".
struct Place {
  const std::filesystem::path& file;
  int line = 0;

  [[noreturn]] void fail(const std::string& message) const {
    throw MeshFileError(file.string() + (line > 0 ? ": line " + std::to_string(line) : "") + ": " +
                        message);
  }
};

/// The next word of `text` (blanks separate), taken off its front; empty at the end.
std::string_view next_word(std::string_view& text) {
  constexpr std::string_view blanks = " \t\r\n\v\f";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(word.size());
  return word;
}

/// The next line of `text` without its end, taken off its front.
std::string_view next_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  return line;
}

/// Compares capital and small letters as equal; `keyword` is in small letters.
bool is_same_word(std::string_view word, std::string_view keyword) {
  return std::ranges::equal(word, keyword, [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b;
  });
}

/// At most 40 characters of a word, unprintable ones as '?', for quoting in a message.
std::string quoted(std::string_view word) {
  std::string result(1, '\'');
  result.append(word.substr(0, 40)).append(word.size() > 40 ? "...'" : "'");
  for (char& c : result)
    if (c < 32 || c > 126) c = '?';
  return result;
}

/// A whole word as a number, in the C locale whatever the program's locale is.
template <class Number>
std::optional<Number> number_of(std::string_view word) {
  return parsed<Number>(word.starts_with('+') ? word.substr(1) : word);
}

/// A coordinate: a finite number.
double parse_coordinate(std::string_view word, const Place& place) {
  if (word.empty()) place.fail("a coordinate is missing");
  const std::optional<double> value = number_of<double>(word);
  if (!value) place.fail(quoted(word) + " is no number in range");
  if (!std::isfinite(*value)) place.fail("coordinate " + quoted(word) + " is not finite");
  return *value;
}

// ---- OBJ

constexpr std::array<std::string_view, 15> ignored = {
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
    const int index = number_of<int>(word.substr(0, word.find('/'))).value_or(0);
    if (index == 0)
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

/// Wavefront OBJ: the statements v and f; texture, normals, groups and materials are passed over.
/// `file`: for messages only. Throws MeshFileError on unknown statements, bad numbers and faces
/// that name a vertex that is not there.
RawMesh read_obj(const std::filesystem::path& file, std::string_view text) {
  RawMesh mesh;
  for (Place place{file, 1}; !text.empty(); ++place.line) {
    std::string_view line = next_line(text);
    line = line.substr(0, line.find('#'));
    const std::string_view keyword = next_word(line);
    if (keyword == "v")
      read_vertex(line, place, mesh);
    else if (keyword == "f")
      read_face(line, place, mesh);
    else if (!keyword.empty() && std::ranges::find(ignored, keyword) == ignored.end())
      place.fail("unknown OBJ statement " + quoted(keyword));
  }
  // Indices are checked at the end: a face may name vertices that come after it.
  const int count = static_cast<int>(mesh.vertices.size());
  for (size_t f = 0; f < mesh.faces.size(); ++f)
    for (const int v : mesh.faces[f])
      if (v >= count)
        Place{file, mesh.face_lines[f]}.fail("face names vertex " + std::to_string(v + 1) + " of " +
                                             std::to_string(count));
  return mesh;
}

// ---- STL

/// Corners this close, relative to the largest extent, are one: binary files are single precision.
constexpr double same_corner = 1e-6;
constexpr size_t header_bytes = 84, record_bytes = 50;  // [bytes], the count included

std::uint32_t little_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (int k = 3; k >= 0; --k) value = value << 8 | static_cast<unsigned char>(bytes[k]);
  return value;
}

// A reader returns a soup of triangles: their corners, three by three, as vertices, and no faces.

RawMesh read_binary(const std::filesystem::path& file, std::string_view content) {
  const Place place{file};
  if (content.size() < header_bytes)
    place.fail("neither text STL (no 'solid') nor binary STL (" + std::to_string(content.size()) +
               " bytes are less than the header's 84)");
  const std::uint64_t count = little_endian(content.substr(80));
  if (content.size() != header_bytes + record_bytes * count)
    place.fail("truncated or no binary STL: " + std::to_string(count) + " triangles take " +
               std::to_string(header_bytes + record_bytes * count) + " bytes, the file has " +
               std::to_string(content.size()));
  RawMesh soup;
  // A record, all numbers little-endian floats; the normal is not read:
  //
  //     bytes   0         12         24         36         48      50
  //             | normal  | corner 0 | corner 1 | corner 2 | unused |
  for (std::uint64_t t = 0; t < count; ++t) {
    const std::string_view record = content.substr(header_bytes + record_bytes * t, record_bytes);
    for (int k = 0; k < 3; ++k) {
      Vec3 p;  // after the normal's 12 bytes
      for (int x = 0; x < 3; ++x)
        p[x] = std::bit_cast<float>(little_endian(record.substr(12 + 12 * k + 4 * x)));
      if (!p.allFinite())
        place.fail("triangle " + std::to_string(t) + " has a coordinate that is not finite");
      soup.vertices.push_back(p);
    }
    soup.face_lines.push_back(0);
  }
  return soup;
}

/// Reads a text STL word by word, with the line that each word stands on. Keywords may be in
/// capital or small letters, as files have both.
class TextReader {
 public:
  TextReader(const std::filesystem::path& file, std::string_view text)
      : place_{file, 0}, text_(text) {}

  std::string_view word() {
    std::string_view found;
    while ((found = next_word(line_)).empty() && !text_.empty()) {
      line_ = next_line(text_);
      ++place_.line;
    }
    return found;
  }
  void skip_line() { line_ = {}; }  // the name after solid and endsolid is free text
  void expect(std::string_view keyword) {
    const std::string_view found = word();
    if (found.empty())
      place_.fail("the file ends where '" + std::string(keyword) + "' should stand");
    if (!is_same_word(found, keyword))
      place_.fail("expected '" + std::string(keyword) + "', found " + quoted(found));
  }
  double coordinate() { return parse_coordinate(word(), place_); }
  const Place& place() const { return place_; }

 private:
  Place place_;
  std::string_view text_, line_;
};

/// Reads a facet after the word "facet". Its normal may be anything, even NaN, as some programs
/// write it for thin triangles.
void read_facet(TextReader& reader, RawMesh& soup) {
  soup.face_lines.push_back(reader.place().line);
  reader.expect("normal");
  for (int x = 0; x < 3; ++x) reader.word();
  reader.expect("outer");
  reader.expect("loop");
  for (int k = 0; k < 3; ++k) {
    reader.expect("vertex");
    Vec3 p;
    for (double& x : p) x = reader.coordinate();
    soup.vertices.push_back(p);
  }
  reader.expect("endloop");
  reader.expect("endfacet");
}

/// Reads solids, one after the other; line breaks matter only for the names:
///
///     solid NAME
///       facet normal x y z   outer loop   (vertex x y z) three times   endloop   endfacet
///     endsolid NAME
RawMesh read_text(const std::filesystem::path& file, std::string_view content) {
  RawMesh soup;
  TextReader reader(file, content);
  for (std::string_view word = reader.word(); !word.empty(); word = reader.word()) {
    if (!is_same_word(word, "solid"))
      reader.place().fail("expected 'solid', found " + quoted(word));
    reader.skip_line();
    for (word = reader.word(); is_same_word(word, "facet"); word = reader.word())
      read_facet(reader, soup);
    if (word.empty()) reader.place().fail("the file ends where 'facet' or 'endsolid' should stand");
    if (!is_same_word(word, "endsolid"))
      reader.place().fail("expected 'facet' or 'endsolid', found " + quoted(word));
    reader.skip_line();
  }
  return soup;
}

/// For each corner the first corner of the soup that it agrees with to same_corner of the size.
std::vector<int> first_equals(const std::vector<Vec3>& corners) {
  if (corners.empty()) return {};
  const double reach = same_corner * bounds_of(corners).largest_extent();
  std::vector<int> first = first_close(corners, reach);
  // Smaller indices are resolved already.
  for (size_t i = 0; i < first.size(); ++i) first[i] = first[first[i]];
  return first;
}

/// STL: a soup of triangles, as text or binary (80 bytes of header, count, 50 bytes per triangle,
/// little-endian), told apart by the content. Normals are passed over: the order of the corners
/// says which side is outside. Corners that agree to same_corner of the largest extent are welded
/// into one vertex. `file`: for messages only. Throws MeshFileError.
RawMesh read_stl(const std::filesystem::path& file, std::string_view content) {
  // a binary header may start with "solid" too; text holds no zero byte
  const bool has_zero = content.find('\0') != std::string_view::npos;
  std::string_view start = content;
  const bool is_text = !has_zero && is_same_word(next_word(start), "solid");
  const RawMesh soup = is_text ? read_text(file, content) : read_binary(file, content);

  // Every triangle brings its own corners: those that are the same become one vertex, numbered in
  // the order in which they first appear.
  RawMesh mesh;
  const std::vector<int> first = first_equals(soup.vertices);
  std::vector<int> index(soup.vertices.size(), -1);
  for (size_t t = 0; t < soup.face_lines.size(); ++t) {
    std::vector<int> face;
    for (size_t k = 3 * t; k < 3 * t + 3; ++k) {
      int& v = index[first[k]];
      if (v < 0) {
        v = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back(soup.vertices[k]);
        mesh.vertex_lines.push_back(soup.face_lines[t]);
      }
      face.push_back(v);
    }
    mesh.faces.push_back(std::move(face));
  }
  mesh.face_lines = soup.face_lines;
  mesh.is_single = !is_text;
  return mesh;
}

// ---- from a raw mesh to a solid

/// Dents and steps up to this part of the size count as rounding of the file's numbers: six digits
/// or, in single precision, 16 roundings if they are more, as for a solid far from the origin. If
/// it is so far that less than four digits are left, the mesh is broken.
double file_tolerance(const RawMesh& mesh) {
  constexpr double six_digits = 1e-6, single = 6e-8, most = 1e-4;
  if (!mesh.is_single) return six_digits;
  double reach = 0.0, size = 0.0;
  for (const Vec3& p : mesh.vertices) {
    reach = std::max(reach, p.norm());
    size = std::max(size, (p - mesh.vertices[0]).norm());
  }
  const double rounding = size > 0.0 ? single * reach / size : 0.0;
  return std::clamp(16.0 * rounding, six_digits, most);
}

RawMesh read_raw(const std::filesystem::path& file, double scale) {
  if (!(scale > 0.0 && std::isfinite(scale)))
    Place{file}.fail("the scale must be positive and finite");
  const std::string suffix = file.extension().string();
  const bool is_obj = is_same_word(suffix, ".obj");
  if (!is_mesh_file(file))
    Place{file}.fail("unknown suffix '" + suffix + "': .obj and .stl are read");
  std::string content;
  try {
    content = read_whole_file(file);
  } catch (const Error& error) {
    throw MeshFileError(error.what());
  }
  if (content.empty()) Place{file}.fail("the file is empty");
  RawMesh mesh = is_obj ? read_obj(file, content) : read_stl(file, content);
  if (mesh.vertices.empty()) Place{file}.fail("the file has no vertices");
  for (Vec3& p : mesh.vertices) p *= scale;
  return mesh;
}

/// Throws MeshFileError: the message of `error` with the line of the face or vertex it is about.
[[noreturn]] void fail_at(const std::filesystem::path& file, const RawMesh& mesh,
                          const InvalidPolyhedron& error) {
  const std::string what = error.what(), counting = " (faces and vertices count from 0)";
  if (error.face >= 0) Place{file, mesh.face_lines[error.face]}.fail(what + counting);
  if (error.vertex >= 0) Place{file, mesh.vertex_lines[error.vertex]}.fail(what + counting);
  Place{file}.fail(what);
}

/// Throws for meshes so large that comparing them with themselves would take minutes.
void require_few(const std::filesystem::path& file, size_t vertices) {
  if (vertices > most_mesh_vertices)
    Place{file}.fail("has " + std::to_string(vertices) + " vertices, at most " +
                     std::to_string(most_mesh_vertices) +
                     " are taken: thin it first (MeshLab: Quadric Edge Collapse Decimation)");
}

/// Whether two neighbouring faces lie in one plane to `reach` [m]: for contact patches they should
/// be one polygon.
bool has_coplanar_neighbours(const Polyhedron& polyhedron, double reach) {
  return std::ranges::any_of(polyhedron.edges(), [&](const Polyhedron::Edge& edge) {
    return std::ranges::all_of(polyhedron.face(edge.right), [&](int v) {
      const Vec3 arm = polyhedron.vertex(v) - polyhedron.vertex(edge.tail);
      return std::abs(polyhedron.normal(edge.left).dot(arm)) <= reach;
    });
  });
}

/// Throws InvalidPolyhedron where a vertex lies deeper than `most` [m] within the hull of all.
void require_near(const std::vector<Vec3>& vertices, const Polyhedron& hull, double most) {
  const double extent = bounds_of(vertices).largest_extent();
  for (size_t v = 0; v < vertices.size(); ++v) {
    double depth = std::numeric_limits<double>::infinity();
    for (int f = 0; f < hull.face_count() && depth > most; ++f)
      depth = std::min(depth, hull.offset(f) - hull.normal(f).dot(vertices[v]));
    if (depth > most)
      throw InvalidPolyhedron(printed("not convex: vertex %zu lies %g of the size within the hull "
                                      "of the others",
                                      v, depth / extent),
                              -1, static_cast<int>(v));
  }
}

/// Takes a convex mesh as it stands. If it has coplanar neighbouring faces or is convex only up to
/// rounding, polygons cut into pieces are joined, and faces in single precision are fitted anew.
Polyhedron solid_of_mesh(const RawMesh& mesh) {
  const double tolerance = file_tolerance(mesh);
  const double extent = bounds_of(mesh.vertices).largest_extent();
  try {
    Polyhedron solid(mesh.vertices, mesh.faces);
    const double flat = mesh.is_single ? tolerance * extent : 1e-9 * solid.circumradius();
    if (!has_coplanar_neighbours(solid, flat)) return solid;
    if (!mesh.is_single) return convex_hull(mesh.vertices);
  } catch (const InvalidPolyhedron&) {
    // The mesh is really broken if it is not convex to the tolerance either.
    const Polyhedron nearly(mesh.vertices, mesh.faces, tolerance, 0.5 * tolerance);
    require_near(mesh.vertices, convex_hull(mesh.vertices), tolerance * extent);
  }
  return rounded_hull(mesh.vertices, tolerance);
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& file) {
  const std::string suffix = file.extension().string();
  return is_same_word(suffix, ".obj") || is_same_word(suffix, ".stl");
}

Polyhedron read_mesh(const std::filesystem::path& file, double scale) {
  const RawMesh mesh = read_raw(file, scale);
  if (mesh.faces.empty()) Place{file}.fail("the file has no faces");
  require_few(file, mesh.vertices.size());
  try {
    return solid_of_mesh(mesh);
  } catch (const InvalidPolyhedron& error) {
    fail_at(file, mesh, error);
  }
}

Polyhedron read_mesh_hull(const std::filesystem::path& file, double scale) {
  const RawMesh mesh = read_raw(file, scale);
  try {
    Polyhedron hull = convex_hull(mesh.vertices);
    require_few(file, hull.vertices().size());
    return mesh.is_single ? rounded_hull(hull.vertices(), file_tolerance(mesh)) : hull;
  } catch (const InvalidPolyhedron& error) {
    Place{file}.fail(error.what());
  }
}

std::vector<std::vector<Vec3>> read_faces(const std::filesystem::path& file, double scale) {
  const RawMesh mesh = read_raw(file, scale);
  if (mesh.faces.empty()) Place{file}.fail("the file has no faces");
  require_few(file, mesh.vertices.size());
  std::vector<std::vector<Vec3>> faces;
  for (const std::vector<int>& face : mesh.faces) {
    std::vector<Vec3>& corners = faces.emplace_back();
    for (const int v : face) corners.push_back(mesh.vertices[v]);
  }
  return faces;
}

std::string mesh_key(const Polyhedron& mesh) {
  Packer packer;
  packer.list(mesh.vertices(), [&](const Vec3& vertex) { packer.fixed(vertex); });
  for (int f = 0; f < mesh.face_count(); ++f) packer.list(mesh.face(f));
  return content_key(packer.bytes());
}

}  // namespace ballast

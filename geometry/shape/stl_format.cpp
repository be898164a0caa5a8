#include "geometry/shape/stl_format.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

#include "geometry/shape/close_pairs.hpp"
#include "geometry/shape/point_sets.hpp"

namespace ballast::raw_mesh {

namespace {

/// Corners this close, relative to the largest extent, are one: binary files are single precision.
constexpr double kSameCorner = 1e-6;
constexpr size_t kHeader = 84, kRecord = 50;  // [bytes], the count included

/// Corners of the triangles, three by three, and each triangle's line (0 in binary files).
struct Soup {
  std::vector<Vec3> corners;
  std::vector<int> lines;
};

std::uint32_t little_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (int k = 3; k >= 0; --k) value = value << 8 | static_cast<unsigned char>(bytes[k]);
  return value;
}

Soup read_binary(const std::filesystem::path& file, std::string_view content) {
  const Place place{file};
  if (content.size() < kHeader)
    place.fail("neither text STL (no 'solid') nor binary STL (" + std::to_string(content.size()) +
               " bytes are less than the header's 84)");
  const std::uint64_t count = little_endian(content.substr(80));
  if (content.size() != kHeader + kRecord * count)
    place.fail("truncated or no binary STL: " + std::to_string(count) + " triangles take " +
               std::to_string(kHeader + kRecord * count) + " bytes, the file has " +
               std::to_string(content.size()));
  Soup soup;
  // A record, all numbers little-endian floats; the normal is not read:
  //
  //     bytes   0         12         24         36         48      50
  //             | normal  | corner 0 | corner 1 | corner 2 | unused |
  for (std::uint64_t t = 0; t < count; ++t) {
    const std::string_view record = content.substr(kHeader + kRecord * t, kRecord);
    for (int k = 0; k < 3; ++k) {
      Vec3 p;  // after the normal's 12 bytes
      for (int x = 0; x < 3; ++x)
        p[x] = std::bit_cast<float>(little_endian(record.substr(12 + 12 * k + 4 * x)));
      if (!p.allFinite())
        place.fail("triangle " + std::to_string(t) + " has a coordinate that is not finite");
      soup.corners.push_back(p);
    }
    soup.lines.push_back(0);
  }
  return soup;
}

/// Word after word of a text STL, with the line they stand on; keywords in either case, as found in
/// the wild.
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
    if (!same(found, keyword))
      place_.fail("expected '" + std::string(keyword) + "', found " + quoted(found));
  }
  double coordinate() { return parse_coordinate(word(), place_); }
  const Place& place() const { return place_; }

  static bool same(std::string_view word, std::string_view keyword) {
    return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(), [](char a, char b) {
      return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b;
    });
  }

 private:
  Place place_;
  std::string_view text_, line_;
};

/// After the word "facet". Normals may be anything, even NaN, as some writers have it for thin
/// triangles.
void read_facet(TextReader& reader, Soup& soup) {
  soup.lines.push_back(reader.place().line);
  reader.expect("normal");
  for (int x = 0; x < 3; ++x) reader.word();
  reader.expect("outer");
  reader.expect("loop");
  for (int k = 0; k < 3; ++k) {
    reader.expect("vertex");
    Vec3 p;
    for (double& x : p) x = reader.coordinate();
    soup.corners.push_back(p);
  }
  reader.expect("endloop");
  reader.expect("endfacet");
}

/// Solids, one after the other; line breaks mean nothing but for the names:
///
///     solid NAME
///       facet normal x y z   outer loop   (vertex x y z) three times   endloop   endfacet
///     endsolid NAME
Soup read_text(const std::filesystem::path& file, std::string_view content) {
  Soup soup;
  TextReader reader(file, content);
  for (std::string_view word = reader.word(); !word.empty(); word = reader.word()) {
    if (!TextReader::same(word, "solid"))
      reader.place().fail("expected 'solid', found " + quoted(word));
    reader.skip_line();
    for (word = reader.word(); TextReader::same(word, "facet"); word = reader.word())
      read_facet(reader, soup);
    if (word.empty()) reader.place().fail("the file ends where 'facet' or 'endsolid' should stand");
    if (!TextReader::same(word, "endsolid"))
      reader.place().fail("expected 'facet' or 'endsolid', found " + quoted(word));
    reader.skip_line();
  }
  return soup;
}

/// For each corner the first corner of the soup that it agrees with to kSameCorner of the size.
std::vector<int> first_equals(const std::vector<Vec3>& corners) {
  if (corners.empty()) return {};
  const double reach = kSameCorner * bounds_of(corners).largest_extent();
  std::vector<int> first = first_close(corners, reach);
  // Smaller indices are resolved already.
  for (size_t i = 0; i < first.size(); ++i) first[i] = first[first[i]];
  return first;
}

}  // namespace

RawMesh read_stl(const std::filesystem::path& file, std::string_view content) {
  // a binary header may start with "solid" too; text holds no zero byte
  const bool has_zero = content.find('\0') != std::string_view::npos;
  std::string_view start = content;
  const bool is_text = !has_zero && TextReader::same(next_word(start), "solid");
  const Soup soup = is_text ? read_text(file, content) : read_binary(file, content);

  // Every triangle brings its own corners: those that are the same become one vertex, numbered in
  // the order in which they first appear.
  RawMesh mesh;
  const std::vector<int> first = first_equals(soup.corners);
  std::vector<int> index(soup.corners.size(), -1);
  for (size_t t = 0; t < soup.lines.size(); ++t) {
    std::vector<int> face;
    for (size_t k = 3 * t; k < 3 * t + 3; ++k) {
      int& v = index[first[k]];
      if (v < 0) {
        v = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back(soup.corners[k]);
        mesh.vertex_lines.push_back(soup.lines[t]);
      }
      face.push_back(v);
    }
    mesh.faces.push_back(std::move(face));
  }
  mesh.face_lines = soup.lines;
  mesh.is_single = !is_text;
  return mesh;
}

}  // namespace ballast::raw_mesh

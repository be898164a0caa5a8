#pragma once
// Writes polyhedra as mesh files, for tests of mesh readers.

#include <charconv>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Appends the shortest decimal number that is read back as the same double.
inline void append_number(std::string& text, double value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// The text of an OBJ file. Its numbers are read back as the same bits.
inline std::string obj_text(const Polyhedron& polyhedron) {
  std::string text = "# convex polyhedron, faces counter-clockwise from outside, metres\n";
  for (const Vec3& p : polyhedron.vertices()) {
    text += "v";
    for (const double x : p) append_number(text += ' ', x);
    text += '\n';
  }
  for (int f = 0; f < polyhedron.face_count(); ++f) {
    text += "f";
    for (const int v : polyhedron.face(f)) text.append(1, ' ').append(std::to_string(v + 1));
    text += '\n';
  }
  return text;
}

/// The text of a text STL. Its numbers are read back as the same bits.
inline std::string stl_text(const Polyhedron& polyhedron) {
  std::string text = "solid ballast\n";
  const auto append = [&](const char* keyword, const Vec3& p) {
    text += keyword;
    for (const double x : p) append_number(text += ' ', x);
    text += '\n';
  };
  for (int f = 0; f < polyhedron.face_count(); ++f) {
    const std::span<const int> loop = polyhedron.face(f);
    for (size_t k = 2; k < loop.size(); ++k) {
      append("facet normal", polyhedron.normal(f));
      text += "outer loop\n";
      for (const int v : {loop[0], loop[k - 1], loop[k]}) append("vertex", polyhedron.vertex(v));
      text += "endloop\nendfacet\n";
    }
  }
  return text + "endsolid ballast\n";
}

/// Writes .obj with polygons as faces, any other suffix as text STL.
inline void write_mesh(const std::filesystem::path& file, const Polyhedron& polyhedron) {
  std::ofstream(file) << (file.extension() == ".obj" ? obj_text(polyhedron) : stl_text(polyhedron));
}

}  // namespace ballast

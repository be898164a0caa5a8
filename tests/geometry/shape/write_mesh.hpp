#pragma once
// Polyhedra written as OBJ or text STL, for tests that read them; the numbers read back as the same
// bits.

#include <charconv>
#include <filesystem>
#include <fstream>
#include <string>

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// `keyword` and the shortest decimal numbers that read back as the same doubles.
inline std::string mesh_line(const char* keyword, const Vec3& p) {
  std::string line = keyword;
  for (const double x : p) {
    char digits[32];
    line.append(1, ' ').append(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
  }
  return line + '\n';
}

inline std::string obj_text(const Polyhedron& polyhedron) {
  std::string text = "# convex polyhedron, faces counter-clockwise from outside, metres\n";
  for (const Vec3& p : polyhedron.vertices()) text += mesh_line("v", p);
  for (int f = 0; f < polyhedron.face_count(); ++f) {
    text += "f";
    for (const int v : polyhedron.face(f)) text.append(1, ' ').append(std::to_string(v + 1));
    text += '\n';
  }
  return text;
}

inline std::string stl_text(const Polyhedron& polyhedron) {
  std::string text = "solid ballast\n";
  for (int f = 0; f < polyhedron.face_count(); ++f) {
    const std::span<const int> loop = polyhedron.face(f);
    for (size_t k = 2; k < loop.size(); ++k) {
      text += mesh_line("facet normal", polyhedron.normal(f)) + "outer loop\n";
      for (const int v : {loop[0], loop[k - 1], loop[k]})
        text += mesh_line("vertex", polyhedron.vertex(v));
      text += "endloop\nendfacet\n";
    }
  }
  return text + "endsolid ballast\n";
}

inline void write_mesh(const std::filesystem::path& file, const Polyhedron& polyhedron) {
  std::ofstream(file) << (file.extension() == ".obj" ? obj_text(polyhedron) : stl_text(polyhedron));
}

}  // namespace ballast

#pragma once
// Mesh files for the tests of mesh_file and of the formats: written, mutilated and read.

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "geometry/shape/mesh_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {

inline void save(const std::filesystem::path& file, const std::string& content) {
  std::ofstream out(file, std::ios::binary);
  out << content;
  REQUIRE(out.flush());
}

inline std::string load(const std::filesystem::path& file) {
  std::ostringstream all;
  all << std::ifstream(file, std::ios::binary).rdbuf();
  return all.str();
}

template <class Action>
std::string complaint(Action action) {
  try {
    action();
    return "";
  } catch (const MeshFileError& error) {
    return error.what();
  }
}

template <class Number>
void append_bytes(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

/// Single precision, normals zero, as many writers leave them.
inline std::string binary_stl(const Polyhedron& p, const std::string& header = "binary") {
  std::string triangles;
  std::uint32_t count = 0;
  for (int f = 0; f < p.face_count(); ++f) {
    const auto loop = p.face(f);
    for (size_t k = 2; k < loop.size(); ++k, ++count) {
      triangles.append(12, '\0');
      for (const int v : {loop[0], loop[k - 1], loop[k]})
        for (const double x : p.vertex(v)) append_bytes(triangles, static_cast<float>(x));
      triangles.append(2, '\0');
    }
  }
  std::string bytes = header + std::string(80 - header.size(), '\0');
  append_bytes(bytes, count);
  return bytes + triangles;
}

inline const std::string cube_obj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7\n";

/// `text` with the first `from` replaced.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace ballast

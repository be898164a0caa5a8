// OBJ and STL: the first byte selects the format of the rest ('o': OBJ). An accepted mesh is
// written and must be accepted again.

#include "geometry/shape/mesh_file.hpp"
#include "tests/fuzz/fuzz_file.hpp"
#include "tests/support/mesh_writer.hpp"

using namespace ballast;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const char* suffix = data[0] == 'o' ? ".obj" : ".stl";
  const auto file =
      fuzz::input_folder().write(std::string("mesh") + suffix, fuzz::text_of(data + 1, size - 1));
  fuzz::refused_or(file, [&] {
    const Polyhedron mesh = read_mesh(file);
    const auto copy = fuzz::input_folder().path() / "copy.obj";
    write_mesh(copy, mesh);
    if (read_mesh(copy).vertex_count() != mesh.vertex_count())
      fuzz::finding("written with other vertices");
  });
  fuzz::refused_or(file, [&] { read_mesh_hull(file); });
  return 0;
}

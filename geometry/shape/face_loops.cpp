#include "geometry/shape/face_loops.hpp"

#include <algorithm>

#include "geometry/shape/area_vector.hpp"

namespace ballast {

void make_canonical(Loops& loops, std::span<const Vec3> points) {
  Vec3 inside = Vec3::Zero();
  double count = 0.0;
  for (const auto& loop : loops) {
    for (const int v : loop) inside += points[v];
    count += static_cast<double>(loop.size());
  }
  inside /= count;
  for (auto& loop : loops) {
    if (area_vector(loop, points).dot(points[loop[0]] - inside) < 0.0)
      std::reverse(loop.begin(), loop.end());
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  }
  std::sort(loops.begin(), loops.end());
}

Polyhedron solid_of(std::span<const Vec3> points, Loops loops) {
  std::vector<int> index(points.size(), -1);
  for (const auto& loop : loops)
    for (const int v : loop) index[v] = 0;
  std::vector<Vec3> vertices;
  for (size_t i = 0; i < points.size(); ++i) {
    if (index[i] < 0) continue;
    index[i] = static_cast<int>(vertices.size());
    vertices.push_back(points[i]);
  }
  for (auto& loop : loops)
    for (int& v : loop) v = index[v];
  return Polyhedron(std::move(vertices), loops);
}

}  // namespace ballast

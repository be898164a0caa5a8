#include "geometry/shape/coplanar_faces.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "geometry/shape/area_vector.hpp"
#include "geometry/shape/sorted_by_key.hpp"

namespace ballast {
namespace {

/// A step along the rim of a group.
struct Step {
  int from, to;
};

/// The rims of all groups, group after group: those steps of faces that lead along another group.
std::vector<Step> rims(const Polyhedron& hull, std::span<const int> group,
                       std::vector<int>& group_of_step) {
  std::vector<Step> steps;
  for (int f = 0; f < hull.face_count(); ++f) {
    const std::span<const int> loop = hull.face(f), across = hull.face_neighbours(f);
    for (size_t k = 0; k < loop.size(); ++k) {
      if (group[static_cast<size_t>(across[k])] == group[static_cast<size_t>(f)]) continue;
      steps.push_back({loop[k], loop[k + 1 < loop.size() ? k + 1 : 0]});
      group_of_step.push_back(group[static_cast<size_t>(f)]);
    }
  }
  return steps;
}

double distance_to_line(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = (b - a).normalized();
  return (p - a - along * along.dot(p - a)).norm();
}

/// Whether what lies on the rim between two corners lies on the line through them. `rim` begins at
/// a corner.
bool is_straight_between(std::span<const int> rim, const std::vector<int>& groups_at,
                         std::span<const Vec3> vertices, double straight) {
  for (size_t begin = 0; begin < rim.size();) {
    size_t end = begin + 1;
    while (end < rim.size() && groups_at[static_cast<size_t>(rim[end])] < 3) ++end;
    const Vec3 &a = vertices[static_cast<size_t>(rim[begin])],
               &b = vertices[static_cast<size_t>(rim[end < rim.size() ? end : 0])];
    for (size_t k = begin + 1; k < end; ++k)
      if (!(distance_to_line(vertices[static_cast<size_t>(rim[k])], a, b) <= straight))
        return false;
    begin = end;
  }
  return true;
}

}  // namespace

FaceGroups coplanar_groups(const Polyhedron& hull, double reach) {
  std::vector<double> area;
  for (int f = 0; f < hull.face_count(); ++f)
    area.push_back(area_vector(hull.face(f), hull.vertices()).norm());
  std::vector<int> order(area.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return area[static_cast<size_t>(a)] > area[static_cast<size_t>(b)];
  });
  FaceGroups groups{std::vector<int>(area.size(), -1), 0};
  std::vector<int>& group = groups.of_face;
  // A group grows across shared edges while all corners of the next face lie in the plane of
  // the seed. All are measured by that one plane, so that a group cannot creep around a
  // curved surface by small angles.
  for (const int seed : order) {
    if (group[static_cast<size_t>(seed)] >= 0) continue;
    const Vec3& normal = hull.normal(seed);
    const double offset = normal.dot(hull.vertex(hull.face(seed)[0]));
    const auto lies_in_it = [&](int f) {
      const std::span<const int> loop = hull.face(f);
      return std::all_of(loop.begin(), loop.end(), [&](int v) {
        return std::abs(normal.dot(hull.vertex(v)) - offset) <= reach;
      });
    };
    std::vector<int> reached{seed};
    group[static_cast<size_t>(seed)] = groups.count;
    for (size_t i = 0; i < reached.size(); ++i)
      for (const int next : hull.face_neighbours(reached[i]))
        if (group[static_cast<size_t>(next)] < 0 && lies_in_it(next)) {
          group[static_cast<size_t>(next)] = groups.count;
          reached.push_back(next);
        }
    ++groups.count;
  }
  return groups;
}

std::optional<Loops> joined_faces(const Polyhedron& hull, const FaceGroups& groups,
                                  double straight) {
  std::vector<int> group_of_step;
  const std::vector<Step> steps = rims(hull, groups.of_face, group_of_step);
  // Where a rim passes through a vertex, it leaves it once.
  std::vector<int> groups_at(static_cast<size_t>(hull.vertex_count()), 0);
  for (const Step& step : steps) ++groups_at[static_cast<size_t>(step.from)];
  const SortedByKey by_group = sorted_by_key(group_of_step, groups.count);
  Loops loops;
  std::vector<int> next(groups_at.size(), -1), rim, corners;
  for (int g = 0; g < groups.count; ++g) {
    const std::span<const int> own = by_group.of(g);
    int start = -1;
    for (const int s : own) {
      const auto [from, to] = steps[static_cast<size_t>(s)];
      if (next[static_cast<size_t>(from)] >= 0) return {};  // the rim touches itself
      next[static_cast<size_t>(from)] = to;
      if (groups_at[static_cast<size_t>(from)] >= 3) start = from;
    }
    if (start < 0) return {};
    rim.clear();
    corners.clear();
    for (int at = start; at >= 0; at = std::exchange(next[static_cast<size_t>(at)], -1)) {
      if (at == start && !rim.empty()) break;
      rim.push_back(at);
      if (groups_at[static_cast<size_t>(at)] >= 3) corners.push_back(at);
    }
    // A rim in several parts has a hole.
    if (rim.size() != own.size() || corners.size() < 3 ||
        !is_straight_between(rim, groups_at, hull.vertices(), straight))
      return {};
    loops.push_back(corners);
  }
  return loops;
}

}  // namespace ballast

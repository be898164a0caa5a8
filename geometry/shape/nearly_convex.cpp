#include "geometry/shape/nearly_convex.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/filled_dents.hpp"
#include "geometry/shape/front_search.hpp"
#include "geometry/shape/mesh_checks.hpp"
#include "geometry/shape/point_sets.hpp"

namespace ballast {
namespace {

/// How deep points lie within a convex solid.
class Depths {
 public:
  explicit Depths(const Polyhedron& solid)
      : solid_(solid), centre_(mean(solid.vertices())), poles_(make_poles()), search_(poles_) {}

  /// Of a point within, to the nearest plane of a face, where it is at most `most`; else more [m].
  double up_to(double most, const Vec3& point) const {
    // Face f with the normal n and at the height h over the centre has the pole n / h, and leaves a
    // point p the depth h (1 - pole.p). So a depth below the least that is known, somewhere, needs
    // a pole that is higher along p than what follows from that depth at the lowest face.
    const Vec3 p = point - centre_;
    double least = std::numeric_limits<double>::infinity();
    search_.visit_higher(p, 1.0 - most / lowest_, [&](int f) {
      least = std::min(least, height(f) - solid_.normal(f).dot(p));
      return 1.0 - std::min(least, most) / lowest_;
    });
    return least;
  }

 private:
  double height(int f) const {
    return solid_.normal(f).dot(solid_.vertex(solid_.face(f)[0]) - centre_);
  }
  std::vector<Vec3> make_poles() {
    std::vector<Vec3> poles;
    for (int f = 0; f < solid_.face_count(); ++f) {
      lowest_ = std::min(lowest_, height(f));
      poles.push_back(solid_.normal(f) / height(f));
    }
    return poles;
  }

  const Polyhedron& solid_;
  Vec3 centre_;
  double lowest_ = std::numeric_limits<double>::infinity();  ///< height of a face [m]
  std::vector<Vec3> poles_;
  FrontSearch search_;
};

/// What a hull leaves out of a mesh.
struct LeftOut {
  int first_deep = -1;    ///< vertex that lies deeper in it than `most`
  double depth = 0.0;     ///< of that vertex [m]
  bool is_within = true;  ///< all of it lies in the hull
};

LeftOut left_out(const Polyhedron& mesh, const Polyhedron& hull, double most, double extent) {
  LeftOut result;
  if (hull.vertex_count() == mesh.vertex_count()) return result;
  const Depths depths(hull);
  // The hull's vertices are some of the mesh's, in the same order.
  for (int v = 0, kept = 0; v < mesh.vertex_count(); ++v) {
    const Vec3& p = mesh.vertex(v);
    if (kept < hull.vertex_count() && p == hull.vertex(kept)) {
      ++kept;
      continue;
    }
    const double depth = depths.up_to(most, p);
    result.is_within &= depth >= -1e-12 * extent;
    if (depth <= most || result.first_deep >= 0) continue;
    result.first_deep = v;
    result.depth = depths.up_to(extent, p);
  }
  return result;
}

void refuse_deep(const LeftOut& left, double extent) {
  if (left.first_deep < 0) return;
  mesh_checks::invalid({.vertex = left.first_deep}, "not convex: vertex ", left.first_deep,
                       " lies ", left.depth / extent, " of the size within the hull of the others");
}

/// The hull by filling dents; nothing where that does not find it.
std::optional<Polyhedron> filled(const Polyhedron& mesh) {
  std::optional<Loops> loops = filled_dents(mesh);
  if (!loops) return {};
  try {
    return solid_of(mesh.vertices(), std::move(*loops));
  } catch (const InvalidPolyhedron&) {
    return {};  // needles, or more than one layer
  }
}

}  // namespace

Polyhedron hull_of_nearly_convex(const Polyhedron& mesh, double tolerance) {
  const double extent = bounds_of(mesh.vertices()).largest_extent(), most = tolerance * extent;
  if (mesh.vertices().size() >= many_vertices)
    if (std::optional<Polyhedron> hull = filled(mesh)) {
      const LeftOut left = left_out(mesh, *hull, most, extent);
      if (left.is_within) {
        refuse_deep(left, extent);
        return std::move(*hull);
      }
    }
  Polyhedron hull = convex_hull(mesh.vertices());
  refuse_deep(left_out(mesh, hull, most, extent), extent);
  return hull;
}

}  // namespace ballast

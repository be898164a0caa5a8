#pragma once
// The collision tables of a set of bodies: bodies of one shape share one.

#include <algorithm>
#include <span>
#include <vector>

#include "geometry/contact/collision_shape.hpp"
#include "geometry/contact/contact_point.hpp"

namespace ballast {

/// One table per distinct polyhedron, in the order of first use; `index[i]`: that of body i, -1 for
/// planes.
struct ShapeTables {
  explicit ShapeTables(std::span<const ContactShape> bodies) {
    std::vector<const Polyhedron*> polyhedra;
    for (const ContactShape& body : bodies) {
      if (body.polyhedron) polyhedra.push_back(body.polyhedron);
    }
    std::vector<const Polyhedron*> distinct = polyhedra;
    std::sort(distinct.begin(), distinct.end());
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    std::vector<int> table_of(distinct.size(), -1);
    tables.reserve(distinct.size());
    for (const ContactShape& body : bodies) {
      index.push_back(-1);
      if (!body.polyhedron) continue;
      int& table = table_of[std::lower_bound(distinct.begin(), distinct.end(), body.polyhedron) -
                            distinct.begin()];
      if (table < 0) {
        table = static_cast<int>(tables.size());
        tables.emplace_back(*body.polyhedron);
      }
      index.back() = table;
    }
  }
  std::vector<CollisionShape> tables;
  std::vector<int> index;
};

}  // namespace ballast

#pragma once
// What a still picture shows besides bodies: walls and their edges, the load, force chains.

#include <vector>

#include "experiments/view/lens.hpp"
#include "experiments/view/raster.hpp"
#include "experiments/view/view_data.hpp"

namespace ballast {

/// The box that all is in, over all frames: walls along the axes where there are some, else the
/// grains [m].
struct ViewBox {
  Vec3 low, high;
};
ViewBox box_of(const ViewData& view);

/// A rod between two balls. A negative radius is in pixels, else [m].
struct Rod {
  Vec3 from, to;
  double from_radius, to_radius;
  Colour colour;
};

/// A wall's part within the box, corner by corner.
struct WallPatch {
  std::vector<Vec3> loop;
  bool is_driven = false;
};
/// The part of a plane within a box; fewer than three corners: none.
std::vector<Vec3> plane_in_box(const Vec3& point, const Vec3& normal, const ViewBox& box);
std::vector<WallPatch> walls_of(const ViewData& view, size_t frame, const ViewBox& box);

/// Edges of walls, and the load on the driven one as an arrow as long as it is large.
std::vector<Rod> wall_rods(const ViewData& view, size_t frame, const ViewBox& box);

/// One rod between the centres of two bodies that push on each other with more than the mean normal
/// force of all pairs, as wide as the force is large. Of a frame before the first step: the next
/// one's.
std::vector<Rod> chain_rods(const ViewData& view, size_t frame);

/// Draws rods in front of what is nearer than they are.
void draw_rods(const std::vector<Rod>& rods, const Lens& camera, Raster& raster, Picture3& picture);
/// Draws walls as coloured glass in front of what is behind them.
void draw_walls(const std::vector<WallPatch>& walls, const Lens& camera, const Raster& raster,
                Picture3& picture);

/// `colour` over what is there.
void blend(std::array<float, 3>& pixel, const Colour& colour, float share);

}  // namespace ballast

#include "experiments/view/still_marks.hpp"

#include <limits>
#include <map>

namespace ballast {
namespace {

constexpr Colour blue{0.0f, 0.168f, 0.445f}, grey{0.18f, 0.18f, 0.17f},
    vermilion{0.665f, 0.112f, 0.0f};

/// The mean circumradius of the grains [m].
double mean_reach(const ViewData& view) {
  double sum = 0.0;
  for (int g = 0; g < view.system.grain_count; ++g)
    sum += view.system.bodies[static_cast<size_t>(g)].shape.polyhedron->circumradius();
  return view.system.grain_count > 0 ? sum / view.system.grain_count : 0.0;
}

struct Chain {
  Vec3 from, to;
  double force = 0.0;  ///< normal, of all contacts of the pair [N]
};

/// Forces between pairs of bodies. A wall's end of a chain is where it is touched.
std::vector<Chain> chains_in(const ViewData& view, size_t frame) {
  std::map<std::pair<int, int>, Chain> pairs;
  const auto centre = [&](int body) { return view.frames[frame].pose[static_cast<size_t>(body)]; };
  for (const FrameContact& contact : view.contacts(frame)) {
    const auto [a, b] = std::minmax(contact.body_a, contact.body_b);  // walls come after grains
    Chain& chain = pairs[{a, b}];
    if (chain.force == 0.0) {
      const bool meets_wall = b >= view.system.grain_count;
      chain.from = centre(a).position;
      chain.to = meets_wall ? contact.position.cast<double>() : centre(b).position;
    }
    chain.force += static_cast<double>(contact.force.dot(contact.normal));
  }
  std::vector<Chain> chains;
  for (const auto& [bodies, chain] : pairs) chains.push_back(chain);
  return chains;
}

/// What nearly all chains of some frames stay below [N].
double top_force(const ViewData& view) {
  std::vector<double> forces;
  const size_t count = view.frames.size();
  for (size_t f = 0; f < count; f += std::max<size_t>(1, count / 10))
    for (const Chain& chain : chains_in(view, f)) forces.push_back(chain.force);
  if (forces.empty()) return 1.0;
  const auto top =
      forces.begin() + static_cast<long>(0.995 * static_cast<double>(forces.size() - 1));
  std::nth_element(forces.begin(), top, forces.end());
  return *top > 0.0 ? *top : 1.0;
}

/// A series of the view at a time, by its last row before; 0 where there is none.
double series_at(const ViewData& view, const std::string& name, double time) {
  const auto row = std::upper_bound(view.series_time.begin(), view.series_time.end(), time);
  const auto k = static_cast<size_t>(std::max<long>(0, row - view.series_time.begin() - 1));
  for (const ViewSeries& series : view.series)
    if (series.name == name && k < series.values.size()) return series.values[k];
  return 0.0;
}

double largest_of(const ViewData& view, const std::string& name) {
  double largest = 0.0;
  for (const ViewSeries& series : view.series)
    if (series.name == name)
      for (const double value : series.values) largest = std::max(largest, std::abs(value));
  return largest;
}

void draw_rod(const Rod& rod, const Lens& camera, Raster& raster, Picture3& picture) {
  const Vec3 s = camera * rod.from, t = camera * rod.to;
  const auto radius_of = [&](double radius, double depth) {
    return radius < 0.0 ? -radius : std::max(0.8, camera.pixels(radius, depth));
  };
  const double at_s = radius_of(rod.from_radius, s.z()), at_t = radius_of(rod.to_radius, t.z());
  const double reach = std::max(at_s, at_t) + 1.0;
  const Eigen::Vector2d d = (t - s).head<2>();
  const auto first = [](double low) { return std::max(0, static_cast<int>(low)); };
  const int x1 = std::min(raster.width - 1, static_cast<int>(std::max(s.x(), t.x()) + reach)),
            y1 = std::min(raster.height - 1, static_cast<int>(std::max(s.y(), t.y()) + reach));
  for (int y = first(std::min(s.y(), t.y()) - reach); y <= y1; ++y)
    for (int x = first(std::min(s.x(), t.x()) - reach); x <= x1; ++x) {
      const Eigen::Vector2d p(x + 0.5 - s.x(), y + 0.5 - s.y());
      const double on = std::clamp(p.dot(d) / std::max(d.squaredNorm(), 1e-9), 0.0, 1.0),
                   radius = at_s + on * (at_t - at_s), away = (p - on * d).norm();
      const auto depth = static_cast<float>(s.z() + on * (t.z() - s.z()));
      const size_t here = raster.at(x, y);
      if (away > radius || depth >= raster.depth[here]) continue;
      raster.depth[here] = depth;
      // round, lit from where the eye is
      const double height = std::sqrt(1.0 - away * away / (radius * radius));
      const auto light = static_cast<float>(radius < 3.0 ? 1.0 : 0.55 + 0.45 * height);
      for (size_t k = 0; k < 3; ++k) picture.pixels[here][k] = light * rod.colour[k];
    }
}

}  // namespace

ViewBox box_of(const ViewData& view) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
  double largest = 0.0;
  for (const PoseFrame& frame : view.frames)
    for (int g = 0; g < view.system.grain_count; ++g) {
      const auto b = static_cast<size_t>(g);
      const double reach = view.system.bodies[b].shape.polyhedron->circumradius();
      largest = std::max(largest, reach);
      low = low.cwiseMin(frame.pose[b].position - Vec3::Constant(reach));
      high = high.cwiseMax(frame.pose[b].position + Vec3::Constant(reach));
    }
  if (low.x() > high.x()) return {-Vec3::Ones(), Vec3::Ones()};
  // a lid far above what it closes is not part of the picture
  const Vec3 least = low - Vec3::Constant(2.0 * largest),
             most = high + Vec3::Constant(2.0 * largest);
  for (auto b = static_cast<size_t>(view.system.grain_count); b < view.system.bodies.size(); ++b)
    for (int k = 0; k < 3; ++k) {
      const double side =
          (view.frames[0].pose[b].rotation * view.system.bodies[b].shape.plane.normal)[k];
      if (std::abs(side) < 0.999) continue;
      double nearest = view.frames[0].pose[b].position[k];
      for (const PoseFrame& frame : view.frames)
        nearest = side > 0.0 ? std::min(nearest, frame.pose[b].position[k])
                             : std::max(nearest, frame.pose[b].position[k]);
      if (side > 0.0)
        low[k] = std::max(nearest, least[k]);
      else
        high[k] = std::min(nearest, most[k]);
    }
  return {low, high};
}

std::vector<Vec3> plane_in_box(const Vec3& point, const Vec3& normal, const ViewBox& box) {
  const Vec3 side = normal.unitOrthogonal(), other = normal.cross(side);
  const double wide = 4.0 * (box.high - box.low).norm() + (point - box.low).norm();
  std::vector<Vec3> loop;
  for (const auto& [a, b] : {std::pair(1, 1), {-1, 1}, {-1, -1}, {1, -1}})
    loop.push_back(point + wide * (a * side + b * other));
  // cut off what is outside of each side in turn (Sutherland and Hodgman 1974); the box is a hair
  // wider, so that its own walls stay in
  for (int k = 0; k < 6; ++k) {
    const double sign = k < 3 ? 1.0 : -1.0, bound = k < 3 ? box.high[k] : -box.low[k - 3];
    const auto room = [&](const Vec3& p) { return bound + 1e-6 * wide - sign * p[k % 3]; };
    std::vector<Vec3> kept;
    for (size_t at = 0; at < loop.size(); ++at) {
      const Vec3 &p = loop[at], &q = loop[(at + 1) % loop.size()];
      if (room(p) >= 0.0) kept.push_back(p);
      if (room(p) * room(q) < 0.0) kept.push_back(p + (q - p) * (room(p) / (room(p) - room(q))));
    }
    loop = std::move(kept);
  }
  return loop;
}

std::vector<WallPatch> walls_of(const ViewData& view, size_t frame, const ViewBox& box) {
  std::vector<WallPatch> walls;
  for (auto b = static_cast<size_t>(view.system.grain_count); b < view.system.bodies.size(); ++b) {
    const Pose& pose = view.frames[frame].pose[b];
    const Vec3 normal = pose.rotation * view.system.bodies[b].shape.plane.normal;
    WallPatch wall{plane_in_box(pose.position, normal, box),
                   static_cast<int>(b) == view.driven_wall};
    if (wall.loop.size() >= 3) walls.push_back(std::move(wall));
  }
  return walls;
}

std::vector<Rod> wall_rods(const ViewData& view, size_t frame, const ViewBox& box) {
  std::vector<Rod> rods;
  for (const auto& [loop, is_driven] : walls_of(view, frame, box)) {
    const double width = is_driven ? -2.2 : -1.5;  // of the finer picture
    Vec3 middle = Vec3::Zero();
    for (size_t k = 0; k < loop.size(); ++k) {
      rods.push_back({loop[k], loop[(k + 1) % loop.size()], width, width, is_driven ? blue : grey});
      middle += loop[k] / static_cast<double>(loop.size());
    }
    const double top = largest_of(view, "f");
    if (!is_driven || top == 0.0) continue;
    const auto b = static_cast<size_t>(view.driven_wall);
    const Vec3 inward =
        view.frames[frame].pose[b].rotation * view.system.bodies[b].shape.plane.normal;
    const double radius = 0.5 * (box.high - box.low).norm(),
                 share = std::abs(series_at(view, "f", view.frames[frame].time)) / top;
    const Vec3 tail = middle - (0.08 + 0.5 * share) * radius * inward,
               neck = middle - 0.09 * radius * inward;
    rods.push_back({tail, neck, 0.009 * radius, 0.009 * radius, vermilion});
    rods.push_back({neck, middle, 0.028 * radius, 0.001 * radius, vermilion});
  }
  return rods;
}

std::vector<Rod> chain_rods(const ViewData& view, size_t frame) {
  if (!view.contacts) return {};
  if (view.contacts(frame).empty() && frame == 0 && view.frames.size() > 1) frame = 1;
  const std::vector<Chain> chains = chains_in(view, frame);
  const double top = top_force(view), reach = mean_reach(view);
  double mean = 0.0;
  for (const Chain& chain : chains) mean += chain.force / static_cast<double>(chains.size());
  std::vector<Rod> rods;
  for (const Chain& chain : chains) {
    if (chain.force < mean) continue;
    const double width = 0.24 * reach * std::min(chain.force / top, 1.3);
    rods.push_back({chain.from, chain.to, width, width,
                    ramp_colour(0.25 + 0.65 * std::sqrt(std::min(chain.force / top, 1.0)))});
  }
  return rods;
}

void draw_rods(const std::vector<Rod>& rods, const Lens& camera, Raster& raster,
               Picture3& picture) {
  for (const Rod& rod : rods) draw_rod(rod, camera, raster, picture);
}

void draw_walls(const std::vector<WallPatch>& walls, const Lens& camera, const Raster& raster,
                Picture3& picture) {
  for (const WallPatch& wall : walls) {
    const Colour& colour = wall.is_driven ? blue : grey;
    const float share = wall.is_driven ? 0.24f : 0.07f;
    for (size_t k = 2; k < wall.loop.size(); ++k)
      scan_triangle(picture.width, picture.height, camera * wall.loop[0], camera * wall.loop[k - 1],
                    camera * wall.loop[k], [&](int x, int y, float depth) {
                      const size_t here = raster.at(x, y);
                      if (depth < raster.depth[here]) blend(picture.pixels[here], colour, share);
                    });
  }
}

void blend(std::array<float, 3>& pixel, const Colour& colour, float share) {
  for (size_t k = 0; k < 3; ++k) pixel[k] += share * (colour[k] - pixel[k]);
}

}  // namespace ballast

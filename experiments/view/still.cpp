#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "experiments/view/view.hpp"
#include "platform/deflate.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

/// Red, green and blue in linear light, 1 is white.
using Colour = Eigen::Array3f;
using Box = Eigen::AlignedBox3d;

constexpr int finer = 2;           // rows and columns drawn for each one of the picture
constexpr int shadow_size = 1400;  // rows and columns of the shadow map, the sun's picture
constexpr double lens_angle = 28.0 * std::numbers::pi / 180.0;  // angle that the height spans [rad]

const Vec3 sun = Vec3(0.42, -0.5, 0.76).normalized();
const Colour paper_white(0.98f, 0.98f, 0.96f), blue(0.0f, 0.168f, 0.445f),
    grey(0.18f, 0.18f, 0.17f), vermilion(0.665f, 0.112f, 0.0f);

/// The page's colour ramp: light at rest (share 0), dark at the top (share 1).
Colour ramp_colour(double share) {
  static const Colour stops[] = {{0.79f, 0.72f, 0.58f}, {0.86f, 0.45f, 0.12f},
                                 {0.80f, 0.17f, 0.05f}, {0.56f, 0.05f, 0.10f},
                                 {0.23f, 0.03f, 0.19f}, {0.06f, 0.03f, 0.21f}};
  const double at = 5.0 * std::clamp(share, 0.0, 1.0);
  const auto k = std::min<size_t>(4, static_cast<size_t>(at));
  return stops[k] + (stops[k + 1] - stops[k]) * static_cast<float>(at - static_cast<double>(k));
}

/// A pinhole camera or, far away, the sun. It maps the world to column, row and depth. Depth is
/// linear in the picture and grows with the distance.
struct Lens {
  Mat3 axes;  // rows: right, up, back
  Vec3 eye;
  double scale = 1.0;
  int width = 0, height = 0;
  bool is_far = false;

  Vec3 operator*(const Vec3& p) const {
    const Vec3 seen = axes * (p - eye);
    const double w = is_far ? 1.0 : -seen.z();
    return {0.5 * width + scale * seen.x() / w, 0.5 * height - scale * seen.y() / w,
            is_far ? -seen.z() : -1.0 / w};
  }
  /// The point that a pinhole camera sees in the middle of a pixel.
  Vec3 point(int x, int y, float depth) const {
    const double w = -1.0 / static_cast<double>(depth);
    const Vec3 seen((x + 0.5 - 0.5 * width) * w / scale, (0.5 * height - y - 0.5) * w / scale, -w);
    return eye + axes.transpose() * seen;
  }
  size_t at(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
  size_t size() const { return at(0, height); }
};

Mat3 axes_towards(const Vec3& back) {
  const Vec3 up = std::abs(back.z()) > 0.9999 ? Vec3::UnitY() : Vec3::UnitZ();
  Mat3 axes;
  axes.row(0) = up.cross(back).normalized();
  axes.row(2) = back;
  axes.row(1) = back.cross(Vec3(axes.row(0)));
  return axes;
}

/// Calls visit(column, row, depth) for each pixel whose middle a convex polygon covers.
template <class Visit>
void scan(const Lens& lens, const std::vector<Vec3>& corners, Visit&& visit) {
  for (size_t k = 2; k < corners.size(); ++k) {
    const Vec3 a = lens * corners[0], b = lens * corners[k - 1], c = lens * corners[k];
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    if (std::abs(area) < 1e-12) continue;
    const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const int x0 = std::max(0, static_cast<int>(std::ceil(low.x() - 0.5))),
              x1 = std::min(lens.width - 1, static_cast<int>(std::floor(high.x() - 0.5))),
              y0 = std::max(0, static_cast<int>(std::ceil(low.y() - 0.5))),
              y1 = std::min(lens.height - 1, static_cast<int>(std::floor(high.y() - 0.5)));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        // barycentric coordinates of the pixel's middle
        const double px = x + 0.5, py = y + 0.5;
        const double u = ((b.x() - px) * (c.y() - py) - (b.y() - py) * (c.x() - px)) / area;
        const double v = ((c.x() - px) * (a.y() - py) - (c.y() - py) * (a.x() - px)) / area;
        const double w = 1.0 - u - v;
        if (u >= 0.0 && v >= 0.0 && w >= 0.0)
          visit(x, y, static_cast<float>(u * a.z() + v * b.z() + w * c.z()));
      }
  }
}

/// Calls use(grain, outward normal, corners) for every face of every grain.
template <class Use>
void for_faces(const ViewData& view, const MotionState& frame, Use&& use) {
  for (int g = 0; g < view.system.grain_count; ++g) {
    const Pose& pose = frame.pose[g];
    for (const ConvexPart& part : convex_parts(view.system.bodies[g].shape))
      for (int f = 0; f < part.polyhedron->face_count(); ++f) {
        std::vector<Vec3> corners;
        for (const int v : part.polyhedron->face(f))
          corners.push_back(pose * (part.pose * part.polyhedron->vertices()[v]));
        const Vec3 normal = part.pose.rotation * part.polyhedron->normal(f);
        use(g, Vec3(pose.rotation * normal), corners);
      }
  }
}

/// The box around all bodies over all frames. Walls normal to the axes bound it where there are
/// some, else the grains.
Box box_of(const ViewData& view) {
  Box grains;
  double largest = 0.0;
  for (const MotionState& frame : view.frames)
    for (int b = 0; b < view.system.grain_count; ++b) {
      const double reach = view.system.bodies[b].shape.polyhedron->circumradius();
      largest = std::max(largest, reach);
      grains.extend(frame.pose[b].position - Vec3::Constant(reach));
      grains.extend(frame.pose[b].position + Vec3::Constant(reach));
    }
  if (grains.isEmpty()) return {-Vec3::Ones(), Vec3::Ones()};
  Box box = grains;
  for (auto b = static_cast<size_t>(view.system.grain_count); b < view.system.bodies.size(); ++b)
    for (int k = 0; k < 3; ++k) {
      const double side =
          (view.frames[0].pose[b].rotation * view.system.bodies[b].shape.plane.normal)[k];
      if (std::abs(side) < 0.999) continue;
      std::vector<double> places;
      for (const MotionState& frame : view.frames) places.push_back(frame.pose[b].position[k]);
      // keeps a lid far above the grains out of the picture
      const auto [low, high] = std::minmax_element(places.begin(), places.end());
      if (side > 0.0)
        box.min()[k] = std::max(*low, grains.min()[k] - 2.0 * largest);
      else
        box.max()[k] = std::min(*high, grains.max()[k] + 2.0 * largest);
    }
  return box;
}

/// The corners, in turn, of the part of a plane within a box; fewer than three: no part.
std::vector<Vec3> plane_in_box(const Vec3& point, const Vec3& normal, const Box& box) {
  const Vec3 side = normal.unitOrthogonal(), other = normal.cross(side);
  const double wide = 4.0 * box.diagonal().norm() + (point - box.min()).norm();
  std::vector<Vec3> loop{point + wide * (side + other), point + wide * (other - side),
                         point - wide * (side + other), point + wide * (side - other)};
  // clips the loop at each side in turn (Sutherland and Hodgman 1974); the box is a hair wider, so
  // that its own walls stay in
  for (int k = 0; k < 6; ++k) {
    const double sign = k < 3 ? 1.0 : -1.0, bound = k < 3 ? box.max()[k] : -box.min()[k - 3];
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

/// A rod between two balls. A negative radius is in pixels, else [m].
struct Rod {
  Vec3 from, to;
  double from_radius, to_radius;
  Colour colour;
  double force = 0.0;  ///< normal force of the pair that it joins [N]
};

/// Returns one rod between the centres of each two touching bodies, by their numbers. At a wall it
/// ends at a contact. A frame before the first step has the rods of the next frame.
std::map<std::pair<int, int>, Rod> chains_in(const ViewData& view, size_t frame) {
  std::vector<FrameContact> contacts = view.contacts(frame);
  if (contacts.empty() && frame == 0 && view.frames.size() > 1) contacts = view.contacts(frame = 1);
  std::map<std::pair<int, int>, Rod> chains;
  const auto centre = [&](int body) { return view.frames[frame].pose[body].position; };
  for (const FrameContact& contact : contacts) {
    const auto [a, b] = std::minmax(contact.body_a, contact.body_b);  // walls come after grains
    const bool meets_wall = b >= view.system.grain_count;
    const Vec3 end = meets_wall ? Vec3(contact.position.cast<double>()) : centre(b);
    const Vec3 to = centre(a) + view.system.period.nearest(end - centre(a));
    Rod& rod = chains.try_emplace({a, b}, Rod{centre(a), to, 0, 0, grey}).first->second;
    rod.force += static_cast<double>(contact.force.dot(contact.normal));
  }
  return chains;
}

/// Takes pictures of one view, all with the same lens and scales.
class Camera {
 public:
  Camera(const ViewData& view, const StillOptions& options)
      : view_(view), options_(options), box_(box_of(view)) {
    const double yaw = options.yaw * std::numbers::pi / 180.0,
                 pitch = options.pitch * std::numbers::pi / 180.0;
    const Vec3 back(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                    std::sin(pitch));
    const double narrow = std::min(1.0, options.width / (1.25 * options.height));
    const int width = finer * options.width, height = finer * options.height;
    lens_ = {axes_towards(back), box_.center() + 3.4 * radius() * back,
             0.5 * height / std::tan(0.5 * lens_angle) * narrow, width, height};
    for (int k = 0; k < 8; ++k) {  // the whole box is in the picture
      const Vec3 corner = lens_ * box_.corner(static_cast<Box::CornerType>(k));
      const double x = 2.0 * corner.x() / width - 1.0, y = 2.0 * corner.y() / height - 1.0;
      lens_.scale /= std::max(1.0, std::max(std::abs(x), std::abs(y)) / 0.97);
    }
    sunlight_ = {axes_towards(sun), box_.center(), 0.49 * shadow_size / radius(),
                 shadow_size,       shadow_size,   true};
    for (size_t f = 0; f < view.frames.size(); ++f)
      for (int g = 0; g < view.system.grain_count; ++g)
        top_value_ = std::max(top_value_, value_of(f, g));
    if (!options.with_chains) return;
    // the force that 99.5 % of the chains of some frames do not exceed
    std::vector<double> forces;
    const size_t count = view.frames.size();
    for (size_t f = 0; f < count; f += std::max<size_t>(1, count / 10))
      for (const auto& [bodies, rod] : chains_in(view, f)) forces.push_back(rod.force);
    std::sort(forces.begin(), forces.end());
    const double top = forces.empty() ? 0.0 : forces[(forces.size() - 1) * 199 / 200];
    if (top > 0.0) top_force_ = top;
  }

  /// Returns a picture: red, green and blue as sRGB bytes, row after row from the top.
  std::string take(size_t frame) {
    depth_.assign(lens_.size(), std::numeric_limits<float>::infinity());
    pixels_.assign(lens_.size(), paper_white);
    if (!options_.with_chains) draw_solid(frame);  // it would hide the chains
    draw_walls(frame);
    if (options_.with_chains) {
      draw_chains(frame);
      draw_glass(frame);
    }
    fill_walls(frame);
    return shrunk();
  }

 private:
  double radius() const { return 0.5 * box_.diagonal().norm(); }

  /// A grain's colour value: the root of its speed, fine near rest; in a single frame its size.
  double value_of(size_t f, int g) const {
    return view_.frames.size() > 1 ? std::sqrt(view_.frames[f].velocity[g].norm())
                                   : std::cbrt(view_.system.bodies[g].volume);
  }
  Colour colour_of(size_t frame, int grain) const {
    return ramp_colour(top_value_ > 0.0 ? value_of(frame, grain) / top_value_ : 0.0);
  }

  void draw_solid(size_t frame) {
    std::vector<float> shadow(sunlight_.size(), std::numeric_limits<float>::infinity());
    for_faces(view_, view_.frames[frame], [&](int, const Vec3&, const auto& corners) {
      scan(sunlight_, corners, [&](int x, int y, float depth) {
        shadow[sunlight_.at(x, y)] = std::min(shadow[sunlight_.at(x, y)], depth);
      });
    });
    std::vector<int> owner(lens_.size(), 0);  // number of the visible face; 0: none
    int number = 0;
    for_faces(view_, view_.frames[frame], [&](int grain, const Vec3& normal, const auto& corners) {
      ++number;
      const Colour colour = colour_of(frame, grain);
      scan(lens_, corners, [&](int x, int y, float depth) {
        const size_t here = lens_.at(x, y);
        if (depth >= depth_[here]) return;
        depth_[here] = depth;
        owner[here] = number;
        const Vec3 above = lens_.point(x, y, depth) + 0.01 * radius() * normal;
        pixels_[here] = colour * light_at(sunlight_ * above, normal, shadow);
      });
    });
    // edges are where another face begins
    for (int y = 0; y < lens_.height; ++y)
      for (int x = 0; x < lens_.width; ++x) {
        const int here = owner[lens_.at(x, y)];
        const bool is_edge = (x + 1 < lens_.width && owner[lens_.at(x + 1, y)] != here) ||
                             (y + 1 < lens_.height && owner[lens_.at(x, y + 1)] != here);
        if (here > 0 && is_edge) pixels_[lens_.at(x, y)] *= 0.62f;
      }
  }

  /// The brightness of a place, given in the sun's picture: lit by the sun or in the shadow.
  float light_at(const Vec3& from_sun, const Vec3& normal, const std::vector<float>& shadow) const {
    const int x = static_cast<int>(from_sun.x()), y = static_cast<int>(from_sun.y());
    const bool is_lit = x < 0 || y < 0 || x >= shadow_size || y >= shadow_size ||
                        from_sun.z() <= static_cast<double>(shadow[sunlight_.at(x, y)]);
    const double direct = is_lit ? std::max(0.0, normal.dot(sun)) : 0.0;
    return static_cast<float>(0.80 * direct + 0.42 * (0.54 + 0.46 * normal.z()) + 0.12);
  }

  /// Draws bodies as glass: each face towards the eye blends with the picture behind it.
  void draw_glass(size_t frame) {
    for_faces(view_, view_.frames[frame], [&](int grain, const Vec3& normal, const auto& corners) {
      const double facing = normal.dot((lens_.eye - corners[0]).normalized());
      if (facing <= 0.0) return;
      const Colour colour = 0.6f * colour_of(frame, grain) + 0.16f;
      fill(corners, colour, static_cast<float>(0.03 + 0.2 * (1.0 - facing) * (1.0 - facing)));
    });
  }

  void fill(const std::vector<Vec3>& corners, const Colour& colour, float share) {
    scan(lens_, corners, [&](int x, int y, float depth) {
      const size_t here = lens_.at(x, y);
      if (depth < depth_[here]) pixels_[here] += share * (colour - pixels_[here]);
    });
  }

  /// Calls use(corners, inward normal, is_driven) for every wall in the picture.
  template <class Use>
  void for_walls(size_t frame, Use&& use) const {
    for (auto b = static_cast<size_t>(view_.system.grain_count); b < view_.system.bodies.size();
         ++b) {
      const Pose& pose = view_.frames[frame].pose[b];
      const Vec3 normal = pose.rotation * view_.system.bodies[b].shape.plane.normal;
      const std::vector<Vec3> loop = plane_in_box(pose.position, normal, box_);
      if (loop.size() >= 3)
        use(loop, normal, static_cast<int>(b) == view_.system.first_driven_wall());
    }
  }

  void fill_walls(size_t frame) {
    for_walls(frame, [&](const auto& loop, const Vec3&, bool is_driven) {
      fill(loop, is_driven ? blue : grey, is_driven ? 0.24f : 0.07f);
    });
  }

  /// Draws the edges of walls, and the load on the driven wall as an arrow that grows with it.
  void draw_walls(size_t frame) {
    // the load's last value up to the frame, over its largest
    double load = 0.0;
    const std::vector<double>& times = view_.series_time;
    const long row = std::ranges::upper_bound(times, view_.frames[frame].time) - times.begin();
    for (const ViewSeries& series : view_.series) {
      if (series.name != "f" || series.values.empty()) continue;
      const auto [low, high] = std::ranges::minmax(series.values);
      const double largest = std::max(std::abs(low), std::abs(high));
      if (largest > 0.0) load = std::abs(series.values[std::max(0L, row - 1)]) / largest;
    }
    for_walls(frame, [&](const auto& loop, const Vec3& inward, bool is_driven) {
      Vec3 middle = Vec3::Zero();
      const double width = is_driven ? -2.2 : -1.5;
      for (size_t k = 0; k < loop.size(); ++k) {
        draw({loop[k], loop[(k + 1) % loop.size()], width, width, is_driven ? blue : grey});
        middle += loop[k] / static_cast<double>(loop.size());
      }
      if (!is_driven || load == 0.0) return;
      const Vec3 tail = middle - (0.08 + 0.5 * load) * radius() * inward,
                 neck = middle - 0.09 * radius() * inward;
      draw({tail, neck, 0.009 * radius(), 0.009 * radius(), vermilion});
      draw({neck, middle, 0.028 * radius(), 0.001 * radius(), vermilion});
    });
  }

  /// Draws the chains above the mean force; their width grows with the force.
  void draw_chains(size_t frame) {
    double mean = 0.0, reach = 0.0;
    auto chains = chains_in(view_, frame);
    for (const auto& [bodies, rod] : chains) mean += rod.force / static_cast<double>(chains.size());
    for (int g = 0; g < view_.system.grain_count; ++g)
      reach += view_.system.bodies[g].shape.polyhedron->circumradius() / view_.system.grain_count;
    for (auto& [bodies, rod] : chains) {
      if (rod.force < mean) continue;
      const double share = rod.force / top_force_;
      rod.from_radius = rod.to_radius = 0.24 * reach * std::min(share, 1.3);
      rod.colour = ramp_colour(0.25 + 0.65 * std::sqrt(std::min(share, 1.0)));
      draw(rod);
    }
  }

  void draw(const Rod& rod) {
    const Vec3 s = lens_ * rod.from, t = lens_ * rod.to;
    const auto radius_at = [&](double radius, double depth) {
      return radius < 0.0 ? -radius : std::max(0.8, -lens_.scale * radius * depth);
    };
    const double at_s = radius_at(rod.from_radius, s.z()), at_t = radius_at(rod.to_radius, t.z());
    const double reach = std::max(at_s, at_t) + 1.0;
    const Eigen::Vector2d d = (t - s).head<2>();
    const int x0 = std::max(0, static_cast<int>(std::min(s.x(), t.x()) - reach)),
              y0 = std::max(0, static_cast<int>(std::min(s.y(), t.y()) - reach)),
              x1 = std::min(lens_.width - 1, static_cast<int>(std::max(s.x(), t.x()) + reach)),
              y1 = std::min(lens_.height - 1, static_cast<int>(std::max(s.y(), t.y()) + reach));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const Eigen::Vector2d p(x + 0.5 - s.x(), y + 0.5 - s.y());
        const double on = std::clamp(p.dot(d) / std::max(d.squaredNorm(), 1e-9), 0.0, 1.0),
                     radius = at_s + on * (at_t - at_s), away = (p - on * d).norm();
        const auto depth = static_cast<float>(s.z() + on * (t.z() - s.z()));
        const size_t here = lens_.at(x, y);
        if (away > radius || depth >= depth_[here]) continue;
        depth_[here] = depth;
        // the rod is round, and lit from the eye
        const double height = std::sqrt(1.0 - away * away / (radius * radius));
        pixels_[here] = rod.colour * static_cast<float>(radius < 3.0 ? 1.0 : 0.55 + 0.45 * height);
      }
  }

  std::string shrunk() const {
    std::string bytes;
    for (int y = 0; y < options_.height; ++y)
      for (int x = 0; x < options_.width; ++x) {
        Colour sum = Colour::Zero();
        for (int j = 0; j < finer; ++j)
          for (int i = 0; i < finer; ++i) sum += pixels_[lens_.at(finer * x + i, finer * y + j)];
        for (const float c : (sum / float(finer * finer)).min(1.0f).max(0.0f).eval()) {
          const float srgb =
              c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f;
          bytes += static_cast<char>(std::lround(255.0f * srgb));
        }
      }
    return bytes;
  }

  const ViewData& view_;
  const StillOptions& options_;
  Box box_;
  Lens lens_, sunlight_;
  double top_value_ = 0.0, top_force_ = 1.0;  // [N]
  std::vector<float> depth_;
  std::vector<Colour> pixels_;
};

/// Numbers as in PNG: four bytes, the most significant first.
std::string png_numbers(std::initializer_list<size_t> values) {
  std::string bytes;
  for (const size_t value : values)
    for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 255);
  return bytes;
}

/// A PNG chunk: length, name, content, check sum.
std::string png_chunk(const std::string& name, const std::string& content) {
  return png_numbers({content.size()}) + name + content + png_numbers({crc32_of(name + content)});
}

}  // namespace

void set_view(StillOptions& options, const std::string& word) {
  const std::map<std::string, std::pair<double, double>> named = {
      {"", {-52.0, 20.0}}, {"home", {-52.0, 20.0}}, {"x", {0.0, 0.0}},   {"-x", {180.0, 0.0}},
      {"y", {90.0, 0.0}},  {"-y", {-90.0, 0.0}},    {"z", {-90.0, 90.0}}};
  const std::vector<std::string> parts = split(word, ',');
  const auto yaw = parsed_number(parts[0]), pitch = parsed_number(parts.back());
  if (const auto found = named.find(word); found != named.end())
    std::tie(options.yaw, options.pitch) = found->second;
  else if (parts.size() == 2 && yaw && pitch && std::isfinite(*yaw) && std::isfinite(*pitch))
    std::tie(options.yaw, options.pitch) = std::pair(*yaw, *pitch);
  else
    throw std::invalid_argument("'" + word + "' is no view: home, x, -x, y, -y, z or YAW,PITCH");
}

std::string still_png(const ViewData& view, const std::vector<size_t>& frames,
                      const StillOptions& options) {
  const auto width = static_cast<size_t>(options.width),
             height = static_cast<size_t>(options.height);
  Camera camera(view, options);
  // 8 bits of red, green and blue
  std::string png = "\x89PNG\r\n\x1a\n" +
                    png_chunk("IHDR", png_numbers({width, height}) + std::string("\x8\2\0\0\0", 5));
  const bool moves = frames.size() > 1;
  if (moves) png += png_chunk("acTL", png_numbers({frames.size(), 0}));  // played for ever
  size_t number = 0;  // counts the fcTL and fdAT chunks together
  for (const size_t frame : frames) {
    // size, place, seconds as a fraction; the frame replaces the one before
    if (moves)
      png += png_chunk("fcTL", png_numbers({number++, width, height, 0, 0}) +
                                   std::string("\0\x64\3\xe8\0\0", 6));
    // each row as its difference from the row above
    const std::string bytes = camera.take(frame);
    std::string rows;
    for (size_t at = 0; at < bytes.size(); ++at) {
      if (at % (3 * width) == 0) rows += '\2';
      rows += static_cast<char>(bytes[at] - (at < 3 * width ? 0 : bytes[at - 3 * width]));
    }
    rows = deflated(rows, 9);
    png += number > 1 ? png_chunk("fdAT", png_numbers({number++}) + rows) : png_chunk("IDAT", rows);
  }
  return png + png_chunk("IEND", "");
}

}  // namespace ballast

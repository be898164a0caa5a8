#include "experiments/view/still.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "experiments/view/still_marks.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

constexpr int shadow_size = 1400;                               // pixels of the sun's own picture
constexpr double lens_angle = 28.0 * std::numbers::pi / 180.0;  // angle that the height spans

const Vec3 sun = Vec3(0.42, -0.5, 0.76).normalized();

/// What each grain is coloured by, largest value and all.
struct Values {
  std::vector<double> of_grain;
  double top = 0.0;
};

Values values_of(const ViewData& view, size_t frame, const std::string& colour) {
  Values values;
  for (int g = 0; g < view.system.grain_count; ++g) {
    const auto b = static_cast<size_t>(g);
    const auto at = [&](const PoseFrame& f) {
      if (colour == "speed") return f.velocity[b].norm();
      if (colour == "displacement")
        return (f.pose[b].position - view.frames.front().pose[b].position).norm();
      if (colour == "size") return std::cbrt(view.system.bodies[b].volume);
      return 0.0;
    };
    for (const PoseFrame& f : view.frames) values.top = std::max(values.top, at(f));
    values.of_grain.push_back(at(view.frames[frame]));
  }
  return values;
}

/// All faces in the picture that a lens makes; `faces` says which grain and normal a number is.
struct Face {
  int grain;
  Vec3 normal;
};
void draw_grains(const ViewData& view, const PoseFrame& frame, const Lens& camera, Raster& raster,
                 std::vector<Face>& faces) {
  faces.assign(1, {-1, Vec3::Zero()});
  for (int g = 0; g < view.system.grain_count; ++g) {
    const auto b = static_cast<size_t>(g);
    const Polyhedron& shape = *view.system.bodies[b].shape.polyhedron;
    std::vector<Vec3> seen;
    for (const Vec3& vertex : shape.vertices()) seen.push_back(camera * (frame.pose[b] * vertex));
    for (int f = 0; f < shape.face_count(); ++f) {
      const auto loop = shape.face(f);
      faces.push_back({g, frame.pose[b].rotation * shape.normal(f)});
      for (size_t k = 2; k < loop.size(); ++k)
        raster.triangle(seen[static_cast<size_t>(loop[0])], seen[static_cast<size_t>(loop[k - 1])],
                        seen[static_cast<size_t>(loop[k])],
                        static_cast<std::uint32_t>(faces.size() - 1));
    }
  }
}

/// What the eye sees, what the sun sees, and which faces these are.
struct Exposure {
  Lens camera, sunlight;
  Raster seen, shadow;
  std::vector<Face> faces = {};
  ViewBox box;
  double radius = 1.0;
};

Exposure expose(const ViewData& view, size_t frame, const StillOptions& options) {
  const ViewBox box = box_of(view);
  const auto& [low, high] = box;
  const Vec3 centre = 0.5 * (low + high);
  const double radius = 0.5 * (high - low).norm();
  const double yaw = options.yaw * std::numbers::pi / 180.0,
               pitch = options.pitch * std::numbers::pi / 180.0;
  const Vec3 back(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                  std::sin(pitch));
  const int width = still_finer * options.width, height = still_finer * options.height;
  const double narrow = std::min(1.0, options.width / (1.25 * options.height));
  Exposure exposure{
      {axes_towards(back), centre + 3.4 * radius * back,
       0.5 * height / std::tan(0.5 * lens_angle) * narrow, double(width), double(height)},
      {axes_towards(sun), centre, 0.49 * shadow_size / radius, shadow_size, shadow_size, true},
      Raster(width, height),
      Raster(shadow_size, shadow_size),
      {},
      box,
      radius};
  draw_grains(view, view.frames[frame], exposure.sunlight, exposure.shadow, exposure.faces);
  draw_grains(view, view.frames[frame], exposure.camera, exposure.seen, exposure.faces);
  return exposure;
}

/// How bright the face is that is seen at a place of the picture.
double light_at(const Exposure& exposure, int x, int y) {
  const Lens& camera = exposure.camera;
  const size_t here = exposure.seen.at(x, y);
  const Face& face = exposure.faces[exposure.seen.owner[here]];
  // the point itself, for its shadow
  const double w = -1.0 / static_cast<double>(exposure.seen.depth[here]);
  const Vec3 local((x + 0.5 - 0.5 * camera.width) * w / camera.scale,
                   (0.5 * camera.height - y - 0.5) * w / camera.scale, -w);
  const Vec3 point = camera.eye + camera.axes.transpose() * local;
  const Vec3 from_sun = exposure.sunlight * (point + 0.01 * exposure.radius * face.normal);
  const int sx = static_cast<int>(from_sun.x()), sy = static_cast<int>(from_sun.y());
  const bool is_lit =
      sx < 0 || sy < 0 || sx >= shadow_size || sy >= shadow_size ||
      from_sun.z() <= static_cast<double>(exposure.shadow.depth[exposure.shadow.at(sx, sy)]);
  const double direct = is_lit ? std::max(0.0, face.normal.dot(sun)) : 0.0;
  const double light = 0.80 * direct + 0.42 * (0.54 + 0.46 * face.normal.z()) + 0.12;
  // edges are where another face begins
  const auto other = [&](int i, int j) {
    return i < exposure.seen.width && j < exposure.seen.height &&
           exposure.seen.owner[exposure.seen.at(i, j)] != exposure.seen.owner[here];
  };
  return light * (other(x + 1, y) || other(x, y + 1) ? 0.62 : 1.0);
}

/// What colours a grain.
Colour colour_of(const Values& values, const StillOptions& options, int grain) {
  const double share =
      values.top > 0.0 ? values.of_grain[static_cast<size_t>(grain)] / values.top : 0.0;
  return ramp_colour(options.colour == "speed" ? std::sqrt(share) : share);
}

constexpr Colour paper_white{0.98f, 0.98f, 0.96f};

/// Bodies as they are seen in the light, on paper.
void draw_solid(const Exposure& exposure, const Values& values, const StillOptions& options,
                Picture3& picture) {
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const std::uint32_t owner = exposure.seen.owner[exposure.seen.at(x, y)];
      if (owner == 0) continue;
      Colour pixel = colour_of(values, options, exposure.faces[owner].grain);
      for (float& channel : pixel) channel *= static_cast<float>(light_at(exposure, x, y));
      picture.pixels[picture.at(x, y)] = pixel;
    }
}

/// Bodies as glass: each face that looks at the eye is a veil over what is behind it.
void draw_glass(const ViewData& view, const PoseFrame& frame, const Lens& camera,
                const Values& values, const StillOptions& options, const Raster& raster,
                Picture3& picture) {
  for (int g = 0; g < view.system.grain_count; ++g) {
    const auto b = static_cast<size_t>(g);
    const Polyhedron& shape = *view.system.bodies[b].shape.polyhedron;
    Colour colour = colour_of(values, options, g);
    for (float& channel : colour) channel = 0.6f * channel + 0.16f;
    for (int f = 0; f < shape.face_count(); ++f) {
      const auto loop = shape.face(f);
      const auto corner = [&](size_t k) {
        return Vec3(frame.pose[b] * shape.vertices()[static_cast<size_t>(loop[k])]);
      };
      const double facing =
          (frame.pose[b].rotation * shape.normal(f)).dot((camera.eye - corner(0)).normalized());
      if (facing <= 0.0) continue;
      const auto veil = static_cast<float>(0.03 + 0.2 * (1.0 - facing) * (1.0 - facing));
      for (size_t k = 2; k < loop.size(); ++k)
        scan_triangle(picture.width, picture.height, camera * corner(0), camera * corner(k - 1),
                      camera * corner(k), [&](int x, int y, float depth) {
                        if (depth < raster.depth[raster.at(x, y)])
                          blend(picture.pixels[picture.at(x, y)], colour, veil);
                      });
    }
  }
}

}  // namespace

void set_view(StillOptions& options, const std::string& word) {
  const std::map<std::string, std::pair<double, double>> named = {
      {"", {-52.0, 20.0}}, {"home", {-52.0, 20.0}}, {"x", {0.0, 0.0}},   {"-x", {180.0, 0.0}},
      {"y", {90.0, 0.0}},  {"-y", {-90.0, 0.0}},    {"z", {-90.0, 90.0}}};
  const std::vector<std::string> parts = split(word, ',');
  if (const auto found = named.find(word); found != named.end()) {
    std::tie(options.yaw, options.pitch) = found->second;
  } else if (const auto yaw = parsed_number(parts[0]); parts.size() == 2 && yaw) {
    const auto pitch = parsed_number(parts[1]);
    if (!pitch || !std::isfinite(*yaw) || !std::isfinite(*pitch))
      throw std::invalid_argument("'" + word + "' is no pair of angles");
    options.yaw = *yaw;
    options.pitch = *pitch;
  } else {
    throw std::invalid_argument("'" + word + "' is no view: home, x, -x, y, -y, z or YAW,PITCH");
  }
}

void set_colour(StillOptions& options, const std::string& word) {
  for (const char* known : {"speed", "displacement", "size", "none"})
    if (word == known) options.colour = word;
  if (!word.empty() && options.colour != word)
    throw std::invalid_argument("'" + word + "' is no colour: speed, displacement, size or none");
}

Picture3 still_picture(const ViewData& view, size_t frame, const StillOptions& options) {
  Exposure exposure = expose(view, frame, options);
  const Values values = values_of(view, frame, options.colour);
  const Lens& camera = exposure.camera;
  Picture3 picture{exposure.seen.width, exposure.seen.height, {}};
  picture.pixels.assign(exposure.seen.owner.size(), paper_white);
  if (options.with_chains)
    exposure.seen = Raster(picture.width, picture.height);  // nothing hides what is within
  else
    draw_solid(exposure, values, options, picture);
  draw_rods(wall_rods(view, frame, exposure.box), camera, exposure.seen, picture);
  if (options.with_chains) {
    draw_rods(chain_rods(view, frame), camera, exposure.seen, picture);
    draw_glass(view, view.frames[frame], camera, values, options, exposure.seen, picture);
  }
  draw_walls(walls_of(view, frame, exposure.box), camera, exposure.seen, picture);
  return picture;
}

std::string still_png(const ViewData& view, size_t frame, const StillOptions& options) {
  return png_of(still_picture(view, frame, options), still_finer);
}

}  // namespace ballast

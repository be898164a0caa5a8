#include "experiments/view/still.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

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

/// What the sun sees, and what the eye sees of some rows of the picture; which faces these are.
struct Exposure {
  Lens camera, sunlight;
  std::vector<float> shadow = {};  // depths
  Raster seen{0, 0};
  std::vector<Face> faces = {};
  ViewBox box = {};
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
      {axes_towards(sun), centre, 0.49 * shadow_size / radius, shadow_size, shadow_size, true}};
  exposure.box = box;
  exposure.radius = radius;
  if (options.with_chains) return exposure;  // glass has no shadow
  Raster shadow(shadow_size, shadow_size, false);
  draw_grains(view, view.frames[frame], exposure.sunlight, shadow, exposure.faces);
  exposure.shadow = std::move(shadow.depth);
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
                   (0.5 * camera.height - camera.above - y - 0.5) * w / camera.scale, -w);
  const Vec3 point = camera.eye + camera.axes.transpose() * local;
  const Vec3 from_sun = exposure.sunlight * (point + 0.01 * exposure.radius * face.normal);
  const int sx = static_cast<int>(from_sun.x()), sy = static_cast<int>(from_sun.y());
  const bool is_lit =
      sx < 0 || sy < 0 || sx >= shadow_size || sy >= shadow_size ||
      from_sun.z() <=
          double(exposure.shadow[static_cast<size_t>(sy) * shadow_size + static_cast<size_t>(sx)]);
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

/// One picture, in as many parts as one likes.
class Still {
 public:
  Still(const ViewData& view, size_t frame, const StillOptions& options)
      : view_(view),
        frame_(view.frames[frame]),
        options_(options),
        exposure_(expose(view, frame, options)),
        values_(values_of(view, frame, options.colour)),
        walls_(walls_of(view, frame, exposure_.box)),
        rods_(wall_rods(view, frame, exposure_.box)) {
    if (!options.with_chains) return;
    const std::vector<Rod> chains = chain_rods(view, frame);
    rods_.insert(rods_.end(), chains.begin(), chains.end());
  }

  /// `count` rows of the finer picture, from row `first` on.
  Picture3 rows(int first, int count) {
    Lens& camera = exposure_.camera;
    camera.above = first;
    // one row more, where there is one: it says where edges are
    const int width = static_cast<int>(camera.width),
              height = std::min(count + 1, static_cast<int>(camera.height) - first);
    exposure_.seen = Raster(width, height);
    Picture3 picture{width, height, {}};
    picture.pixels.assign(exposure_.seen.depth.size(), paper_white);
    if (!options_.with_chains) {  // else nothing hides what is within
      draw_grains(view_, frame_, camera, exposure_.seen, exposure_.faces);
      draw_solid(exposure_, values_, options_, picture);
    }
    draw_rods(rods_, camera, exposure_.seen, picture);
    if (options_.with_chains)
      draw_glass(view_, frame_, camera, values_, options_, exposure_.seen, picture);
    draw_walls(walls_, camera, exposure_.seen, picture);
    picture.height = count;
    picture.pixels.resize(picture.at(0, count));
    return picture;
  }

 private:
  const ViewData& view_;
  const PoseFrame& frame_;
  const StillOptions& options_;
  Exposure exposure_;
  Values values_;
  std::vector<WallPatch> walls_;
  std::vector<Rod> rods_;
};

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
  return Still(view, frame, options).rows(0, still_finer * options.height);
}

std::string still_png(const ViewData& view, size_t frame, const StillOptions& options) {
  // an eighth of the picture at a time: drawn finer, it takes twenty times its bytes and more
  Still still(view, frame, options);
  const int height = still_finer * options.height, most = still_finer * ((options.height + 7) / 8);
  std::string bytes;
  for (int first = 0; first < height; first += most)
    bytes += srgb_bytes(still.rows(first, std::min(most, height - first)), still_finer);
  return png_of_bytes(bytes, options.width);
}

}  // namespace ballast

#include "experiments/view/still.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

#include "experiments/view/raster.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

constexpr int finer = 2;           // rows and columns drawn for each of the picture's
constexpr int shadow_size = 1400;  // pixels of the sun's own picture
constexpr double lens = 28.0 * std::numbers::pi / 180.0;  // angle that the height spans

using Colour = std::array<float, 3>;

const Vec3 sun = Vec3(0.42, -0.5, 0.76).normalized();

/// Light at rest to dark at the top, as the page's ramp, in linear light.
Colour ramp(double share) {
  constexpr Colour stops[] = {{0.79f, 0.72f, 0.58f}, {0.86f, 0.45f, 0.12f}, {0.80f, 0.17f, 0.05f},
                              {0.56f, 0.05f, 0.10f}, {0.23f, 0.03f, 0.19f}, {0.06f, 0.03f, 0.21f}};
  const double at = 5.0 * std::clamp(share, 0.0, 1.0);
  const auto k = std::min<size_t>(4, static_cast<size_t>(at));
  Colour colour;
  for (size_t i = 0; i < 3; ++i)
    colour[i] = stops[k][i] + (stops[k + 1][i] - stops[k][i]) * static_cast<float>(at - double(k));
  return colour;
}

/// A pinhole or, without a distance, a far one: world to column, row and depth.
struct Lens {
  Mat3 axes;  // rows: right, up, back
  Vec3 eye;
  double scale = 1.0, width = 0.0, height = 0.0;
  bool is_far = false;

  Vec3 operator*(const Vec3& p) const {
    const Vec3 seen = axes * (p - eye);
    const double w = is_far ? 1.0 : -seen.z();
    // 1/w is linear in the picture; turned round it grows with the distance
    return {0.5 * width + scale * seen.x() / w, 0.5 * height - scale * seen.y() / w,
            is_far ? -seen.z() : -1.0 / w};
  }
};

Mat3 axes_towards(const Vec3& back) {
  const Vec3 up = std::abs(back.z()) > 0.9999 ? Vec3::UnitY() : Vec3::UnitZ();
  Mat3 axes;
  axes.row(0) = up.cross(back).normalized();
  axes.row(2) = back;
  axes.row(1) = back.cross(Vec3(axes.row(0)));
  return axes;
}

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

/// Corners of what there is, over all frames.
std::pair<Vec3, Vec3> extent_of(const ViewData& view) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
  for (const PoseFrame& frame : view.frames)
    for (int g = 0; g < view.system.grain_count; ++g) {
      const auto b = static_cast<size_t>(g);
      const double reach = view.system.bodies[b].shape.polyhedron->circumradius();
      low = low.cwiseMin(frame.pose[b].position - Vec3::Constant(reach));
      high = high.cwiseMax(frame.pose[b].position + Vec3::Constant(reach));
    }
  return low.x() <= high.x() ? std::pair(low, high)
                             : std::pair(Vec3(-Vec3::Ones()), Vec3(Vec3::Ones()));
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
  double radius = 1.0;
};

Exposure expose(const ViewData& view, size_t frame, const StillOptions& options) {
  const auto [low, high] = extent_of(view);
  const Vec3 centre = 0.5 * (low + high);
  const double radius = 0.5 * (high - low).norm();
  const double yaw = options.yaw * std::numbers::pi / 180.0,
               pitch = options.pitch * std::numbers::pi / 180.0;
  const Vec3 back(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                  std::sin(pitch));
  const int width = finer * options.width, height = finer * options.height;
  const double narrow = std::min(1.0, options.width / (1.25 * options.height));
  Exposure exposure{
      {axes_towards(back), centre + 3.4 * radius * back,
       0.5 * height / std::tan(0.5 * lens) * narrow, double(width), double(height)},
      {axes_towards(sun), centre, 0.49 * shadow_size / radius, shadow_size, shadow_size, true},
      Raster(width, height),
      Raster(shadow_size, shadow_size),
      {},
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
    if (!pitch) throw std::invalid_argument("'" + parts[1] + "' is no angle");
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

std::string still_png(const ViewData& view, size_t frame, const StillOptions& options) {
  const Exposure exposure = expose(view, frame, options);
  const Values values = values_of(view, frame, options.colour);
  const Raster& seen = exposure.seen;
  Picture3 picture{seen.width, seen.height, {}};
  picture.pixels.reserve(seen.owner.size());
  for (int y = 0; y < seen.height; ++y)
    for (int x = 0; x < seen.width; ++x) {
      const std::uint32_t owner = seen.owner[seen.at(x, y)];
      if (owner == 0) {
        picture.pixels.push_back({0.98f, 0.98f, 0.96f});  // paper
        continue;
      }
      const auto g = static_cast<size_t>(exposure.faces[owner].grain);
      const double share = values.top > 0.0 ? values.of_grain[g] / values.top : 0.0;
      Colour pixel = ramp(options.colour == "speed" ? std::sqrt(share) : share);
      for (float& channel : pixel) channel *= static_cast<float>(light_at(exposure, x, y));
      picture.pixels.push_back(pixel);
    }
  return png_of(picture, finer);
}

}  // namespace ballast

#include "experiments/box/vibrated_box.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>

#include "geometry/shape/mesh_file.hpp"
#include "geometry/shape/pose.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

/// The user's meshes in turn; sizes and their order are as for generated grains.
std::vector<PrincipalShape> grains_from_meshes(const GrainsSpec& spec) {
  std::vector<PrincipalShape> meshes, grains;
  for (const Polyhedron& mesh : spec.meshes) meshes.push_back(to_principal_frame(mesh));
  const auto sized =
      make_grains(spec.count, spec.distribution, spec.size_convention, spec.shape, spec.seed);
  for (int k = 0; k < spec.count; ++k) {
    const Polyhedron& mesh = meshes[k % meshes.size()].shape;
    const double scale = sized[k].shape.circumradius() / mesh.circumradius();
    std::vector<Vec3> vertices(mesh.vertices().begin(), mesh.vertices().end());
    for (Vec3& vertex : vertices) vertex *= scale;
    grains.push_back(to_principal_frame(mesh.with_vertices(std::move(vertices))));
  }
  return grains;
}

/// Centres of non-overlapping bounding spheres, drawn at random, large ones first: a loose rain.
std::vector<Vec3> scatter(const std::vector<double>& radii, double length, double width,
                          double& height, Random& random) {
  std::vector<size_t> order(radii.size());
  for (size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return radii[a] > radii[b]; });
  std::vector<Vec3> centres(radii.size());
  // By cells a little wider than the largest sphere, z first: what overlaps a sphere has its centre
  // in the same cell or in one beside it.
  using Cell = std::array<double, 3>;
  const double side = 2.001 * radii[order.front()];
  std::multimap<Cell, size_t> placed;
  const auto cell_of = [&](const Vec3& p) {
    return Cell{std::floor(p.z() / side), std::floor(p.y() / side), std::floor(p.x() / side)};
  };
  const auto is_free = [&](const Vec3& centre, double r) {
    const auto [z, y, x] = cell_of(centre);
    for (const double row : {z - 1.0, z, z + 1.0})
      for (const double column : {y - 1.0, y, y + 1.0}) {
        const auto end = placed.upper_bound({row, column, x + 1.0});
        for (auto near = placed.lower_bound({row, column, x - 1.0}); near != end; ++near) {
          const double distance = r + radii[near->second];
          if (!((centre - centres[near->second]).squaredNorm() > distance * distance)) return false;
        }
      }
    return true;
  };
  // Random sequential addition: places are drawn until one is free.
  for (size_t done = 0; done < order.size(); ++done) {
    const double r = radii[order[done]];
    for (int attempt = 0;; ++attempt) {
      // So many places were taken: the rain becomes a little higher.
      if (attempt == 2000) {
        height *= 1.05;
        attempt = 0;
      }
      const Vec3 centre(random.uniform(r, length - r), random.uniform(r, width - r),
                        random.uniform(r, height - r));
      if (!is_free(centre, r)) continue;
      centres[order[done]] = centre;
      placed.emplace(cell_of(centre), order[done]);
      break;
    }
  }
  return centres;
}

void drive_by(WallSpec& spec, double mass, const HarmonicLoad& load) {
  spec.motion = WallMotion::driven;
  spec.mass = mass;
  spec.load = load;
}

}  // namespace

const char* name_of(BoxStage stage) { return name_in({"rain", "press", "settle", "drive"}, stage); }

Rain make_rain(const Scene& scene) {
  if (scene.deposit.tiles() > 1) return tiled_rain(scene, make_rain(tile_of(scene)));
  const GrainsSpec& spec = *scene.grains;
  const auto shapes = spec.meshes.empty() ? make_grains(spec.count, spec.distribution,
                                                        spec.size_convention, spec.shape, spec.seed)
                                          : grains_from_meshes(spec);
  Random random(spec.seed ^ 0x5261696eull);  // its own stream: "Rain"
  std::vector<double> radii;
  double sphere_volume = 0.0;
  for (const PrincipalShape& shape : shapes) {
    radii.push_back(shape.shape.circumradius());
    sphere_volume += 4.0 / 3.0 * std::numbers::pi * std::pow(radii.back(), 3);
  }
  // As high as makes the spheres the wanted part of its volume, and no grain sticks out.
  Rain rain;
  rain.height =
      std::max(sphere_volume / (scene.deposit.fill_fraction * scene.box.length * scene.box.width),
               2.0 * *std::max_element(radii.begin(), radii.end()));
  const std::vector<Vec3> centres =
      scatter(radii, scene.box.length, scene.box.width, rain.height, random);
  for (size_t k = 0; k < shapes.size(); ++k) {
    BodySpec body;
    body.name = "grain " + std::to_string(k);
    body.shape = std::make_shared<const Polyhedron>(shapes[k].shape);
    body.mass = spec.density * shapes[k].volume;
    body.inertia = spec.density * shapes[k].inertia;
    body.pose = {centres[k], random_rotation(random)};
    rain.grains.push_back(std::move(body));
  }
  return rain;
}

Scene tile_of(const Scene& scene) {
  Scene tile = scene;
  tile.box.length /= scene.deposit.tiles_x;
  tile.box.width /= scene.deposit.tiles_y;
  tile.grains->count /= scene.deposit.tiles();
  tile.deposit.tiles_x = tile.deposit.tiles_y = 1;
  return tile;
}

std::vector<Vec3> tile_corners(const Scene& scene) {
  const DepositSpec& deposit = scene.deposit;
  const double length = scene.box.length / deposit.tiles_x,
               width = scene.box.width / deposit.tiles_y;
  std::vector<Vec3> corners;
  for (int iy = 0; iy < deposit.tiles_y; ++iy)
    for (int ix = 0; ix < deposit.tiles_x; ++ix) corners.emplace_back(ix * length, iy * width, 0.0);
  return corners;
}

Rain tiled_rain(const Scene& scene, const Rain& tile) {
  Rain rain{{}, tile.height};
  for (const Vec3& corner : tile_corners(scene))
    for (BodySpec grain : tile.grains) {
      grain.name = "grain " + std::to_string(rain.grains.size());
      grain.pose.position += corner;
      rain.grains.push_back(std::move(grain));
    }
  return rain;
}

Scene tiled_scene(const Scene& tile, int nx, int ny) {
  Scene scene = tile;
  scene.box.length *= nx;
  scene.box.width *= ny;
  scene.grains->count *= nx * ny;
  scene.deposit.tiles_x = nx;
  scene.deposit.tiles_y = ny;
  return scene;
}

void place_copies(const Scene& scene, const MotionState& tile, MotionState& state) {
  const size_t grains = tile.pose.size() - box_wall_count;
  size_t copy = 0;
  for (const Vec3& corner : tile_corners(scene))
    for (size_t b = 0; b < grains; ++b, ++copy) {
      state.pose[copy] = tile.pose[b];
      state.pose[copy].position += corner;
      state.velocity[copy] = tile.velocity[b];
      state.spin[copy] = tile.spin[b];
    }
}

Vec3 deposit_gravity(const Scene& scene) {
  return scene.deposit.gravity > 0.0 ? Vec3(0, 0, -scene.deposit.gravity) : scene.gravity;
}

MechanicalSystem box_system(const Scene& scene, const Rain& rain, BoxStage stage, double lid,
                            MotionState* start) {
  MechanicalSystem system;
  MotionState state;
  const bool deposits = stage != BoxStage::drive;
  system.gravity = deposits ? deposit_gravity(scene) : scene.gravity;
  system.friction = deposits ? scene.deposit.friction : scene.friction;
  system.restitution = scene.restitution;
  for (const BodySpec& grain : rain.grains)
    add_body(system, state, grain, grain.mass / scene.grains->density);

  const BoxSpec& box = scene.box;
  const double horizontal = deposits ? scene.deposit.friction : box.friction_horizontal;
  const double mass = system.mass_of_grains(), weight = mass * system.gravity.norm();
  // The box as it stands, in the order of BoxWall, then what drives a wall of it in this stage. A
  // corner of the box is the origin, and normals point into the box. A wall's plane is normal.x =
  // offset: of x_max, at x = length, the normal is -x and the offset -length. Name, normal, offset,
  // friction:
  WallSpec walls[box_wall_count] = {{"floor", Vec3::UnitZ(), 0.0, horizontal},
                                    {"lid", -Vec3::UnitZ(), -lid, horizontal},
                                    {"x_min", Vec3::UnitX(), 0.0, box.friction_vertical},
                                    {"x_max", -Vec3::UnitX(), -box.length, box.friction_vertical},
                                    {"y_min", Vec3::UnitY(), 0.0, box.friction_vertical},
                                    {"y_max", -Vec3::UnitY(), -box.width, box.friction_vertical}};
  if (stage == BoxStage::press) {
    const double load = scene.deposit.lid_pressure_weight * weight;
    drive_by(walls[wall_lid], mass, {load, load, 0.0});
  }
  if (stage == BoxStage::drive) {
    const DriveSpec& drive = scene.drive;
    drive_by(walls[wall_x_max], drive.wall_mass_over_grains * mass,
             {drive.f_min_over_weight * weight, drive.f_max_over_weight * weight, drive.frequency});
  }
  for (const WallSpec& spec : walls) add_wall(system, state, spec);
  if (start) *start = std::move(state);
  return system;
}

double grain_rms_velocity(const MechanicalSystem& system, const MotionState& state) {
  double sum = 0.0;
  for (int b = 0; b < system.grain_count; ++b) sum += state.velocity[b].squaredNorm();
  return std::sqrt(sum / system.grain_count);
}

double packing_top(const MechanicalSystem& system, const MotionState& state) {
  double top = 0.0;
  for (int b = 0; b < system.grain_count; ++b)
    for (const Vec3& vertex : system.bodies[b].shape.polyhedron->vertices())
      top = std::max(top, (state.pose[b] * vertex).z());
  return top;
}

// The text must never change for scenes that can do without a new packing: packings are kept under
// its hash. A change of what a deposit computes raises the number after "packing".
std::string packing_key(const Scene& scene) {
  std::ostringstream text;
  text.precision(17);
  const GrainsSpec& g = *scene.grains;
  text << "packing 7;" << g.count << ' ' << g.seed << ' ' << g.density << ' '
       << static_cast<int>(g.size_convention);
  for (const SizeClass& size : g.distribution) text << ' ' << size.size << ' ' << size.fraction;
  text << ';' << g.shape.min_vertices << ' ' << g.shape.max_vertices << ' '
       << g.shape.elongation_min << ' ' << g.shape.elongation_max << ' ' << g.shape.flatness_min
       << ' ' << g.shape.flatness_max << ' ' << g.shape.roughness;
  for (const Polyhedron& mesh : g.meshes) text << ';' << mesh_key(mesh);
  const BoxSpec& b = scene.box;
  text << ';' << b.length << ' ' << b.width << ' ' << b.friction_vertical;
  const DepositSpec& d = scene.deposit;
  text << ';' << d.step << ' ' << d.friction << ' ' << d.fill_fraction << ' ' << d.max_time << ' '
       << d.rest_velocity << ' ' << d.lid_pressure_weight << ' ' << d.lid_time << ' '
       << d.settle_time << ' ' << d.settle_step << ' ' << deposit_gravity(scene).z() << ' '
       << d.solver << ' ' << d.tolerance << ' ' << d.max_iterations;
  text << ';' << scene.drive.lid_raise << ' ' << scene.restitution;
  const CorrectionSpec& c = scene.correction;
  text << ';' << c.enabled << ' ' << c.slop << ' ' << c.fraction << ' ' << c.sweeps << ' '
       << scene.detection.max_points;
  if (d.tiles() > 1) text << "; tiles 2 " << d.tiles_x << ' ' << d.tiles_y;
  return content_key(text.str());
}

ControlVolume box_control_volume(const Scene& scene, double top) {
  const ControlVolumeSpec& margin = scene.control_volume;
  return {Vec3(margin.margin_x, margin.margin_y, margin.margin_floor),
          Vec3(scene.box.length - margin.margin_x, scene.box.width - margin.margin_y,
               top - margin.margin_top)};
}

}  // namespace ballast

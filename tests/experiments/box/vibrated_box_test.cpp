#include "experiments/box/vibrated_box.hpp"

#include <algorithm>
#include <functional>
#include <numbers>
#include <numeric>
#include <set>

#include "geometry/shape/mesh_file.hpp"
#include "platform/random.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/box/small_box.hpp"
#include "tests/support/mesh_writer.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

void write_box(const fs::path& file, const Vec3& size) { write_mesh(file, make_box(size)); }

Scene with_meshes(const fs::path& file) {
  return small_box({"grains.meshes=[\"" + file.string() + "\"]"});
}

}  // namespace

TEST_CASE("a packing's key is the one under which packings have been kept since format 8") {
  CHECK(packing_key(read_scene(find_scene("vibrated_box_small"))) == "f57235edb4d80f0d");
}

TEST_CASE("a packing's key knows what the deposit depends on, and nothing of the drive") {
  std::set<std::string> keys{packing_key(small_box())};
  for (const char* drive :
       {"drive.frequency=7", "solver.name=\"pgs\"", "contact.friction=0.9", "scene.step=1e-4",
        "box.friction_horizontal=0.1", "drive.wall_mass_over_grains=3", "record.pose_rate=1"})
    CHECK(keys.contains(packing_key(small_box({drive}))));
  const char* deposits[] = {"grains.count=6",
                            "grains.seed=2",
                            "grains.density=1000",
                            "grains.shape.roughness=0.01",
                            "box.length=0.21",
                            "box.friction_vertical=0.1",
                            "deposit.step=1e-4",
                            "deposit.friction=0.5",
                            "deposit.gravity=1.6",
                            "deposit.solver=\"pgs\"",
                            "deposit.lid_pressure_weight=2",
                            "drive.lid_raise=0.001",
                            "correction.sweeps=7"};
  for (const char* deposit : deposits) {
    INFO(deposit);
    CHECK(keys.insert(packing_key(small_box({deposit}))).second);
  }
}

TEST_CASE("an edited mesh makes another packing, its name and its time stamp do not") {
  const TemporaryFolder folder;
  const fs::path mesh = folder.path() / "grain.obj";
  write_box(mesh, Vec3(1, 2, 3));
  const std::string key = packing_key(with_meshes(mesh));
  CHECK(key != packing_key(small_box()));
  fs::last_write_time(mesh, fs::last_write_time(mesh) + std::chrono::hours(1));
  CHECK(packing_key(with_meshes(mesh)) == key);
  fs::copy_file(mesh, folder.path() / "copy.obj");
  CHECK(packing_key(with_meshes(folder.path() / "copy.obj")) == key);
  write_box(mesh, Vec3(1, 2, std::nextafter(3.0, 4.0)));
  CHECK(packing_key(with_meshes(mesh)) != key);
}

TEST_CASE("the rain of a scene is of the meshes as they were when the scene was read") {
  const TemporaryFolder folder;
  const fs::path mesh = folder.path() / "grain.obj";
  write_box(mesh, Vec3(1, 2, 3));
  const Scene scene = with_meshes(mesh);
  fs::remove(mesh);
  const Rain rain = make_rain(scene), generated = make_rain(small_box());
  REQUIRE(rain.grains.size() == 5);
  for (size_t k = 0; k < 5; ++k) {
    const Polyhedron& grain = *rain.grains[k].shape;
    CHECK(grain.vertex_count() == 8);
    // of the sizes of generated grains; a box of 1 x 2 x 3 has the circumradius sqrt(14) / 2
    const double radius = grain.circumradius();
    CHECK(radius == Approx(generated.grains[k].shape->circumradius()).epsilon(1e-12));
    const double volume = 6.0 * std::pow(2.0 * radius / std::sqrt(14.0), 3);
    CHECK(rain.grains[k].mass == Approx(scene.grains->density * volume).epsilon(1e-12));
  }
}

TEST_CASE("the rain is in the box, at rest, and no bounding spheres overlap") {
  const Scene scene = small_box({"grains.count=40"});
  const Rain rain = make_rain(scene);
  REQUIRE(rain.grains.size() == 40);
  for (size_t a = 0; a < rain.grains.size(); ++a) {
    const BodySpec& grain = rain.grains[a];
    const double r = grain.shape->circumradius();
    const Vec3 top(scene.box.length, scene.box.width, rain.height);
    CHECK((grain.pose.position.array() >= r * (1 - 1e-12)).all());
    CHECK(((top - grain.pose.position).array() >= r * (1 - 1e-12)).all());
    CHECK(grain.velocity == Vec3::Zero());
    for (size_t b = 0; b < a; ++b) {
      const double reach = r + rain.grains[b].shape->circumradius();
      CHECK((grain.pose.position - rain.grains[b].pose.position).norm() > reach);
    }
  }
}

TEST_CASE("the places of the rain are those that are found by testing against all spheres") {
  const Scene scene = small_box({"grains.count=300"});
  const Rain rain = make_rain(scene);
  const GrainsSpec& spec = *scene.grains;
  std::vector<double> radii;
  double volume = 0.0;
  for (const PrincipalShape& grain :
       make_grains(spec.count, spec.distribution, spec.size_convention, spec.shape, spec.seed)) {
    radii.push_back(grain.shape.circumradius());
    volume += 4.0 / 3.0 * std::numbers::pi * std::pow(radii.back(), 3);
  }
  const BoxSpec& box = scene.box;
  double height = volume / (scene.deposit.fill_fraction * box.length * box.width);
  std::vector<size_t> order(radii.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater(), [&](size_t k) { return radii[k]; });
  Random random(scene.grains->seed ^ 0x5261696eull);
  std::vector<std::pair<Vec3, double>> spheres;
  for (const size_t k : order) {
    const double r = radii[k];
    Vec3 centre;
    const auto is_hit = [&](const auto& sphere) {
      const double distance = r + sphere.second;
      return (centre - sphere.first).squaredNorm() <= distance * distance;
    };
    for (int attempt = 0; attempt == 0 || std::ranges::any_of(spheres, is_hit); ++attempt) {
      if (attempt > 0 && attempt % 2000 == 0) height *= 1.05;
      centre = Vec3(random.uniform(r, box.length - r), random.uniform(r, box.width - r),
                    random.uniform(r, height - r));
    }
    spheres.emplace_back(centre, r);
  }
  CHECK(rain.height == height);
  // Grains are numbered along x.
  std::ranges::sort(spheres, {}, [](const auto& sphere) { return sphere.first.x(); });
  for (size_t k = 0; k < spheres.size(); ++k) {
    CHECK(rain.grains[k].name == "grain " + std::to_string(k));
    CHECK(rain.grains[k].pose.position == spheres[k].first);
    CHECK(rain.grains[k].shape->circumradius() == spheres[k].second);
  }
}

TEST_CASE("the walls of each stage: what is fixed, what is driven, and by which load") {
  const Scene scene = small_box({"deposit.lid_pressure_weight=2", "deposit.gravity=1.5"});
  const Rain rain = make_rain(scene);
  const auto wall_of = [&](BoxStage stage, BoxWall wall) {
    const MechanicalSystem system = box_system(scene, rain, stage, 0.3);
    REQUIRE(system.grain_count == 5);
    REQUIRE(system.bodies.size() == 5 + box_wall_count);
    return system.bodies[static_cast<size_t>(system.grain_count + wall)];
  };
  const double mass = box_system(scene, rain, BoxStage::rain, 0.3).mass_of_grains();
  for (const BoxStage stage : {BoxStage::rain, BoxStage::settle})
    for (int w = 0; w < box_wall_count; ++w)
      CHECK(wall_of(stage, static_cast<BoxWall>(w)).wall.motion == WallMotion::fixed);
  const RigidBody lid = wall_of(BoxStage::press, wall_lid);
  CHECK(lid.wall.motion == WallMotion::driven);
  CHECK(lid.wall.normal == Vec3(0, 0, -1));
  CHECK(lid.wall.offset == -0.3);
  CHECK(lid.wall.load.f_min == Approx(2 * mass * 1.5));
  CHECK(lid.wall.load.f_max == lid.wall.load.f_min);
  const RigidBody driven = wall_of(BoxStage::drive, wall_x_max);
  CHECK(driven.wall.motion == WallMotion::driven);
  CHECK(driven.mass == Approx(scene.drive.wall_mass_over_grains * mass));
  CHECK(driven.wall.load.f_max == Approx(3.0 * mass * 9.81));
  CHECK(driven.wall.load.frequency == 20.0);
  CHECK(wall_of(BoxStage::drive, wall_lid).wall.motion == WallMotion::fixed);
}

TEST_CASE("rms speed and top of two cubes") {
  const Scene scene = small_box();
  MechanicalSystem system;
  MotionState state;
  BodySpec cube;
  cube.shape = std::make_shared<const Polyhedron>(make_box(Vec3(2, 2, 2)));
  cube.mass = 1.0;
  for (const double z : {1.0, 4.0}) {
    cube.pose.position = Vec3(0, 0, z);
    add_body(system, state, cube, 8.0);
  }
  state.velocity = {Vec3(3, 0, 0), Vec3(0, 4, 0)};
  CHECK(grain_rms_velocity(system, state) == Approx(std::sqrt(12.5)));
  CHECK(packing_top(system, state) == Approx(5.0));
  state.pose[1].rotation = Quat(Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::UnitX()));
  CHECK(packing_top(system, state) == Approx(4.0 + std::sqrt(2.0)));
  // clear of the walls by the margins, up to the top that is given
  const ControlVolume volume = box_control_volume(scene, 0.2);
  const ControlVolumeSpec& margin = scene.control_volume;
  CHECK(volume.lo() == Vec3(margin.margin_x, margin.margin_y, margin.margin_floor));
  CHECK(volume.hi() == Vec3(0.2 - margin.margin_x, 0.2 - margin.margin_y, 0.2 - margin.margin_top));
}

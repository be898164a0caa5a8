#include "problems/scene/scene_bodies.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <set>

#include "platform/random.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

using enum Presence;

constexpr double radians = std::numbers::pi / 180.0;
constexpr size_t most_bodies = 100'000;  // of one [[body]] or [[crowd]]
constexpr long most_models = 1'000;      // different sizes and shapes of a crowd

/// Reads "material" and returns its number in the scene, adding new ones; -1 without one.
int read_material(TomlTable& table, Scene& scene) {
  std::string name;
  table.read("material", &name, {}, only_where_given);
  if (name.empty()) return -1;
  const auto at = std::ranges::find(scene.materials, name);
  const auto number = static_cast<int>(at - scene.materials.begin());
  if (at == scene.materials.end()) scene.materials.push_back(name);
  return number;
}

/// Reads rows [t, value ...], which must ascend in t.
NumberRows read_table(TomlTable& table, size_t columns, const char* unit) {
  NumberRows rows;
  table.read("table", &rows, rows_of(columns, unit), only_where_given);
  for (size_t k = 1; k < rows.size(); ++k)
    if (!(rows[k - 1][0] < rows[k][0]))
      table.fail("table", "row " + std::to_string(k) + " is not later than the one before it");
  return rows;
}

void read_shift(TomlTable& table, TimeFunction<Vec3>& shift, Presence presence) {
  table.read("velocity", &shift.rate, of_unit("m/s"), only_where_given);
  table.read("amplitude", &shift.amplitude, of_unit("m"), presence);
  table.read("frequency", &shift.frequency, in(not_negative, "Hz"), presence);
  for (const std::vector<double>& row : read_table(table, 4, "s, m"))
    shift.table.emplace_back(row[0], Vec3(row.data() + 1));
}

/// `centre` is the default centre of the turn.
ImposedMotion read_motion(TomlTable table, const Vec3& centre) {
  ImposedMotion motion;
  motion.centre = centre;
  read_shift(table, motion.shift, only_where_given);
  table.know("turn");
  if (table.has("turn")) {
    TomlTable turn = table.section("turn");
    double degrees = 0.0;
    turn.read("axis", &motion.axis);
    turn.read("centre", &motion.centre, of_unit("m"));
    turn.read("rate", &motion.turn.rate, of_unit("rad/s"));
    turn.read("amplitude_degrees", &degrees, of_unit("degrees"), only_where_given);
    turn.read("frequency", &motion.turn.frequency, in(not_negative, "Hz"), only_where_given);
    for (const std::vector<double>& row : read_table(turn, 2, "s, degrees"))
      motion.turn.table.emplace_back(row[0], radians * row[1]);
    turn.finish();
    check_direction(turn, "axis", motion.axis);
    motion.axis.normalize();
    motion.turn.amplitude = radians * degrees;
  }
  table.finish();
  return motion;
}

WallSpec read_wall(TomlTable& table, Scene& scene) {
  WallSpec wall;
  std::string motion = "fixed";
  wall.name = "wall_" + std::to_string(scene.walls.size());
  table.read("name", &wall.name);
  table.read("normal", &wall.normal, {}, required);
  table.read("offset", &wall.offset, of_unit("m"));
  table.read("friction", &wall.friction, in(friction_range));
  table.read("motion", &motion, one_of({"fixed", "prescribed", "driven"}));
  wall.material = read_material(table, scene);
  check_direction(table, "normal", wall.normal);
  // The plane is normal.x = offset with the normal as given in the file, whatever its length.
  wall.offset /= wall.normal.norm();
  wall.normal.normalize();
  if (motion == "prescribed") {
    wall.motion = WallMotion::prescribed;
    if (!table.has("velocity") && !table.has("amplitude") && !table.has("table"))
      table.fail("motion", "without a motion, expected velocity, amplitude or table");
    ImposedMotion imposed;
    read_shift(table, imposed.shift, optional);
    wall.imposed = std::make_shared<const ImposedMotion>(std::move(imposed));
  } else if (motion == "driven") {
    wall.motion = WallMotion::driven;
    table.read("mass", &wall.mass, in(positive, "kg"), required);
    TomlTable load = table.section("load");
    load.read("f_max", &wall.load.f_max, in(not_negative, "N"), required);
    load.read("f_min", &wall.load.f_min, in(not_negative, "N"));
    load.read("frequency", &wall.load.frequency, in(not_negative, "Hz"), required);
    load.finish();
    if (wall.load.f_min > wall.load.f_max)
      load.fail("f_min", "larger than f_max, expected f_min <= f_max");
  }
  table.finish();
  if (!scene.period.keeps_plane(wall.normal))
    table.fail("normal", "not across scene.period: the plane would be no plane in the next one");
  return wall;
}

/// Reads either `mass` or `density`; a body that cannot move needs neither.
double read_mass(TomlTable& table, double volume, bool can_move) {
  const bool has_mass = table.has("mass"), has_density = table.has("density");
  if (has_mass && has_density)
    table.fail("mass", "given together with density, expected one of the two");
  double mass = 0.0, density = 0.0;
  table.read("mass", &mass, in(positive, "kg"), only_where_given);
  table.read("density", &density, in(positive, "kg/m^3"),
             can_move && !has_mass ? required : only_where_given);
  return has_mass ? mass : volume * density;
}

void read_locks(TomlTable& table, BodySpec& body) {
  constexpr std::array<std::string_view, 4> freedoms{"x", "y", "z", "rotation"};
  for (const std::string& lock : table.texts("locked")) {
    const auto at = std::find(freedoms.begin(), freedoms.end(), lock);
    if (at == freedoms.end())
      table.fail("locked", "unknown word \"" + lock +
                               "\", expected a list of \"x\", \"y\", \"z\", \"rotation\"");
    (lock == "rotation" ? body.free_rotation : body.free[at - freedoms.begin()]) = false;
  }
  // A velocity along a locked direction could never change: such a body needs `motion`.
  for (int i = 0; i < 3; ++i)
    if (!body.free[i] && body.velocity[i] != 0.0)
      table.fail("velocity", "moves along a locked direction, expected 0 there");
  if (!body.free_rotation && body.spin.norm() != 0.0)
    table.fail("spin", "turns a body of locked rotation, expected 0");
}

void read_force(TomlTable force, ForceSpec& spec) {
  force.read("constant", &spec.constant, of_unit("N"));
  force.read("amplitude", &spec.amplitude, of_unit("N"));
  force.read("frequency", &spec.frequency, in(not_negative, "Hz"));
  force.read("phase", &spec.phase, of_unit("rad"));
  force.finish();
}

/// A body that follows a motion has no freedom: its initial velocity is the motion's.
void read_imposed(TomlTable& table, BodySpec& body) {
  for (const char* key : {"velocity", "spin", "locked"})
    if (table.has(key)) table.fail(key, "given together with motion, which says how it moves");
  body.imposed = read_motion(table.section("motion"), body.pose.position);
  body.free = {false, false, false};
  body.free_rotation = false;
}

void read_own_motion(TomlTable& table, BodySpec& body) {
  table.know("motion");
  if (table.has("motion")) return read_imposed(table, body);
  table.read("velocity", &body.velocity, of_unit("m/s"));
  table.read("spin", &body.spin, of_unit("rad/s"));
  read_locks(table, body);
}

BodySpec read_body(TomlTable& table, const fs::path& folder, Scene& scene, size_t number) {
  BodySpec body;
  body.name = "body_" + std::to_string(number);
  table.read("name", &body.name);
  table.read("position", &body.pose.position, of_unit("m"));
  read_own_motion(table, body);
  body.material = read_material(table, scene);
  ReadShape shape = read_shape(table, folder);
  if (shape.is_surface && body.can_move())
    table.fail("shape", "a surface has no mass, expected motion, or all of it locked");
  body.mesh_key = shape.mesh_key;
  body.mass = read_mass(table, shape.volume, body.can_move());
  // Moments per unit density [m^5] times the density.
  body.inertia = body.mass / shape.volume * shape.inertia;
  body.shape = std::move(shape.hull);
  body.parts = std::move(shape.parts);

  // pose of the shape as given, then of its principal frame within it
  const Pose pose{body.pose.position, read_orientation(table.section("orientation"))};
  body.pose = composed(pose, shape.pose);
  // A scene gives spins in the world frame, and states keep them in the body frame.
  body.spin = body.pose.rotation.conjugate() * body.spin;
  read_force(table.section("force"), body.force);
  if (body.imposed && !(body.force.constant.isZero(0.0) && body.force.amplitude.isZero(0.0)))
    table.fail("force", "given together with motion, which no force changes");
  return body;
}

/// Copy k of the bodies so far is moved k times, each time turned about an axis, then shifted.
void repeat(TomlTable& table, std::vector<BodySpec>& bodies) {
  int count = 1;
  Vec3 translation = Vec3::Zero(), axis = Vec3::UnitZ(), centre = Vec3::Zero();
  double degrees = 0.0;
  table.read("count", &count, whole(1, static_cast<int>(most_bodies)), required);
  table.read("translation", &translation, of_unit("m"));
  table.read("axis", &axis);
  table.read("angle_degrees", &degrees, of_unit("degrees"));
  table.read("centre", &centre, of_unit("m"));
  table.finish();
  check_direction(table, "axis", axis);
  if (bodies.size() * static_cast<size_t>(count) > most_bodies)
    table.fail("count", "makes more than 100000 bodies");
  if (degrees != 0.0 && bodies[0].imposed)
    table.fail("angle_degrees", "turns a body with a motion, expected 0");
  const Quat turn = rotation_by(radians * degrees * axis.normalized());
  std::vector<BodySpec> step = bodies, all;
  for (int k = 0; k < count; ++k)
    for (BodySpec& body : step) {
      all.push_back(body);
      all.back().name += '_' + std::to_string(k);
      body.pose.position = centre + turn * (body.pose.position - centre) + translation;
      body.pose.rotation = (turn * body.pose.rotation).normalized();
      body.velocity = turn * body.velocity;
      for (int i = 0; i < 3; ++i)
        if (!body.free[i] && std::abs(body.velocity[i]) > 1e-12 * body.velocity.norm())
          table.fail("angle_degrees", "turns a velocity into a locked direction");
        else if (!body.free[i])
          body.velocity[i] = 0.0;
      if (body.imposed) body.imposed->centre += translation;
    }
  bodies = std::move(all);
}

/// The content of [[crowd]]: bodies of one kind, of sizes between two radii, in a box of space.
struct CrowdSpec {
  int count = 0, subdivisions = 1;
  std::uint64_t seed = 1;
  std::string shape;
  double radius = 0.0, least_radius = 0.0, density = 0.0;
  Vec3 aspect = Vec3::Ones(), from = Vec3::Zero(), to = Vec3::Zero(), velocity = Vec3::Zero();
  int material = -1;
};

CrowdSpec read_crowd(TomlTable& table, Scene& scene) {
  CrowdSpec crowd;
  table.read("count", &crowd.count, whole(1, static_cast<int>(most_bodies)), required);
  table.read("seed", &crowd.seed);
  table.read("shape", &crowd.shape, one_of({"box", "sphere", "grain"}), required);
  table.read("radius", &crowd.radius, in(positive, "m"), required);
  crowd.least_radius = crowd.radius;
  table.read("radius_min", &crowd.least_radius, in(positive, "m"));
  if (crowd.shape == "sphere") table.read("subdivisions", &crowd.subdivisions, whole(0, 5));
  if (crowd.shape == "box") table.read("aspect", &crowd.aspect);
  table.read("density", &crowd.density, in(positive, "kg/m^3"), required);
  table.read("from", &crowd.from, of_unit("m"), required);
  table.read("to", &crowd.to, of_unit("m"), required);
  table.read("velocity", &crowd.velocity, of_unit("m/s"));
  crowd.material = read_material(table, scene);
  table.finish();
  if (crowd.least_radius > crowd.radius) table.fail("radius_min", "larger than radius");
  if (!(crowd.aspect.minCoeff() > 0.0)) table.fail("aspect", "expected three ratios > 0");
  return crowd;
}

PrincipalShape crowd_shape(const CrowdSpec& crowd, double radius, std::uint64_t seed) {
  if (crowd.shape == "grain") return make_grain(GrainShapeSettings{}, radius, seed);
  if (crowd.shape == "sphere") return to_principal_frame(make_sphere(radius, crowd.subdivisions));
  return to_principal_frame(make_box(2.0 * radius / crowd.aspect.norm() * crowd.aspect));
}

BodySpec crowd_model(const TomlTable& table, const CrowdSpec& crowd, double radius, long k) try {
  PrincipalShape solid =
      crowd_shape(crowd, radius, crowd.seed * 1'000'003 + static_cast<std::uint64_t>(k));
  BodySpec body;
  body.mass = crowd.density * solid.volume;
  body.inertia = crowd.density * solid.inertia;
  body.shape = std::make_shared<const Polyhedron>(std::move(solid.shape));
  body.velocity = crowd.velocity;
  body.material = crowd.material;
  return body;
} catch (const InvalidPolyhedron& error) {  // e.g. a box a million times thinner than wide
  table.fail("shape", error.what());
}

/// Places each body in its own cubic cell, a little off its middle, layer upon layer from below.
std::vector<BodySpec> make_crowd(const TomlTable& table, const CrowdSpec& crowd) {
  constexpr double room = 1.1;  // width of a cell over the largest body's diameter
  const double cell = room * 2.0 * crowd.radius;
  const Eigen::Array3d cells =
      ((crowd.to - crowd.from).array() / cell + 1e-9).floor().min(1.0 * most_bodies);
  const double fitting = cells.minCoeff() > 0.0 ? cells.prod() : 0.0;
  if (fitting < crowd.count)
    table.fail("count", "does not fit between from and to, where " +
                            std::to_string(static_cast<long>(fitting)) + " bodies have room");
  Random random(crowd.seed);
  const bool is_varied = crowd.shape == "grain" || crowd.least_radius < crowd.radius;
  std::vector<BodySpec> models, bodies;  // models: the first bodies, which the others copy
  const auto along_x = static_cast<long>(cells.x()), along_y = static_cast<long>(cells.y());
  for (long k = 0; k < crowd.count; ++k) {
    const double radius = random.uniform(crowd.least_radius, crowd.radius);
    if (k == 0 || (is_varied && k < most_models))
      models.push_back(crowd_model(table, crowd, radius, k));
    BodySpec& body = bodies.emplace_back(models[static_cast<size_t>(k) % models.size()]);
    const long layer = k / (along_x * along_y), row = k / along_x % along_y;
    const Vec3 corner(static_cast<double>(k % along_x), static_cast<double>(row),
                      static_cast<double>(layer));
    const double slack = (room - 1.0) * crowd.radius;
    body.pose.position = crowd.from + cell * (corner + Vec3::Constant(0.5));
    for (double& x : body.pose.position) x += random.uniform(-slack, slack);
    body.pose.rotation = random_rotation(random);
  }
  return bodies;
}

}  // namespace

void read_bodies(TomlTable& root, const fs::path& folder, Scene& scene) {
  std::set<std::string> names;
  const auto check_name = [&](const TomlTable& table, const std::string& name) {
    if (name.empty()) table.fail("name", "empty, expected a name");
    if (!names.insert(name).second) table.fail("name", "given twice, expected a name of its own");
  };
  for (TomlTable& table : root.sections("wall")) {
    scene.walls.push_back(read_wall(table, scene));
    check_name(table, scene.walls.back().name);
  }
  const auto add = [&](const TomlTable& table, std::vector<BodySpec>&& bodies) {
    for (BodySpec& body : bodies) {
      check_name(table, body.name);
      // In a periodic world a body meets its own image unless it is small.
      if (!scene.period.has_room_for(body.shape->circumradius()))
        table.fail("shape", "not smaller than half of scene.period");
      scene.bodies.push_back(std::move(body));
    }
  };
  size_t number = 0;
  for (TomlTable& table : root.sections("body")) {
    std::vector<BodySpec> bodies{read_body(table, folder, scene, number++)};
    check_name(table, bodies[0].name);
    names.erase(bodies[0].name);
    for (TomlTable& entry : table.sections("repeat")) repeat(entry, bodies);
    table.finish();
    add(table, std::move(bodies));
  }
  number = 0;
  for (TomlTable& table : root.sections("crowd")) {
    const std::string name = table.text("name", "crowd_" + std::to_string(number++));
    std::vector<BodySpec> bodies = make_crowd(table, read_crowd(table, scene));
    for (size_t k = 0; k < bodies.size(); ++k) bodies[k].name = name + '_' + std::to_string(k);
    add(table, std::move(bodies));
  }
}

void read_material_pairs(const std::vector<TomlTable>& tables, Scene& scene) {
  std::set<std::pair<int, int>> known;
  for (TomlTable table : tables) {
    std::vector<std::string> names;
    MaterialPair pair{-1, -1, 0.0, scene.restitution};
    table.read("materials", &names, {}, required);
    table.read("friction", &pair.friction, in(friction_range), required);
    table.read("restitution", &pair.restitution, in(zero_to_one));
    table.finish();
    if (names.size() != 2) table.fail("materials", "expected two names of materials");
    for (auto [name, place] : {std::pair(&names[0], &pair.a), std::pair(&names[1], &pair.b)}) {
      const auto at = std::ranges::find(scene.materials, *name);
      if (at == scene.materials.end())
        table.fail("materials", "nothing is made of \"" + *name + "\"");
      *place = static_cast<int>(at - scene.materials.begin());
    }
    if (!known.insert(std::minmax(pair.a, pair.b)).second)
      table.fail("materials", "given twice, expected one law for each pair");
    scene.material_pairs.push_back(pair);
  }
}

}  // namespace ballast

#include "geometry/contact/broad_phase.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/catch.hpp"
#include "tests/geometry/contact/detection_support.hpp"

using namespace ballast;
using namespace ballast::testing;

namespace {

struct World {
  explicit World(int count, std::uint64_t seed) : random(seed) {
    for (int i = 0; i < count; ++i) {
      const bool plane = i % 11 == 5;
      bodies.push_back(
          {plane ? nullptr
                 : &collision_pool()[random.below(static_cast<int>(collision_pool().size()))],
           i % 7 == 3});
      Pose pose;
      pose.position =
          Vec3(random.uniform(0.0, 0.4), random.uniform(0.0, 0.3), random.uniform(0.0, 0.3));
      pose.rotation = random_rotation(random);
      poses.push_back(pose);
      reach.push_back(1e-4 * random.uniform());
    }
  }
  std::vector<Mat3> rotations() const {
    std::vector<Mat3> result;
    for (const Pose& pose : poses) result.push_back(pose.rotation.toRotationMatrix());
    return result;
  }
  /// All pairs of bodies whose boxes overlap when each is grown by its reach.
  std::set<std::pair<int, int>> required() const {
    const std::vector<Mat3> rotation = rotations();
    std::set<std::pair<int, int>> result;
    const int count = static_cast<int>(bodies.size());
    for (int a = 0; a < count; ++a) {
      for (int b = a + 1; b < count; ++b) {
        if (!bodies[a].shape || !bodies[b].shape || (bodies[a].fixed && bodies[b].fixed)) continue;
        const Bounds p = bounding_box(*bodies[a].shape, rotation[a], poses[a].position);
        const Bounds q = bounding_box(*bodies[b].shape, rotation[b], poses[b].position);
        const double apart = std::max((p.low - q.high).maxCoeff(), (q.low - p.high).maxCoeff());
        if (apart <= reach[a] + reach[b]) result.emplace(a, b);
      }
    }
    return result;
  }
  Random random;
  std::vector<BroadPhase::Body> bodies;
  std::vector<Pose> poses;
  std::vector<double> reach;
};

void check_list(BroadPhase& broad_phase, const World& world) {
  std::set<std::pair<int, int>> listed;
  std::pair<int, int> last{-1, -1};
  bool sorted = true, allowed = true;
  for (const CandidatePair& pair : broad_phase.pairs()) {
    sorted &= last < std::pair(pair.a, pair.b);
    last = {pair.a, pair.b};
    listed.insert(last);
    allowed &= pair.a < pair.b && world.bodies[pair.a].shape && world.bodies[pair.b].shape &&
               !(world.bodies[pair.a].fixed && world.bodies[pair.b].fixed);
  }
  CHECK(sorted);
  CHECK(allowed);
  for (int a = 0; a < static_cast<int>(world.bodies.size()); ++a) {
    for (int k = broad_phase.first(a); k < broad_phase.first(a + 1); ++k)
      allowed &= broad_phase.pairs()[k].a == a;
  }
  CHECK(allowed);
  CHECK(broad_phase.first(static_cast<int>(world.bodies.size())) ==
        static_cast<int>(broad_phase.pairs().size()));
  const auto required = world.required();
  if (!std::includes(listed.begin(), listed.end(), required.begin(), required.end()))
    FAIL_CHECK("a pair is missing");
}

}  // namespace

TEST_CASE("bounding boxes hold every vertex and touch one on each side") {
  Random random(1);
  for (const CollisionShape& shape : collision_pool()) {
    const Mat3 rotation = random_rotation(random).toRotationMatrix();
    const Vec3 position = random_direction(random);
    const Bounds box = bounding_box(shape, rotation, position);
    Vec3 low = Vec3::Constant(1e9), high = -low;
    for (int v = 0; v < shape.vertices().count(); ++v) {
      low = low.cwiseMin(position + rotation * shape.vertices().xyz(v));
      high = high.cwiseMax(position + rotation * shape.vertices().xyz(v));
    }
    CHECK((low - box.low).norm() <= 1e-15);
    CHECK((high - box.high).norm() <= 1e-15);
  }
}

TEST_CASE("the list holds every pair within reach, under motion, teleports and changing reaches") {
  for (int run = 0; run < 8; ++run) {
    World world(90, 100 + run);
    BroadPhase broad_phase(world.bodies, run % 2 ? 0.002 : 1e-9);
    const double speed = std::pow(10.0, -2.0 - run / 2);
    for (int step = 0; step < 60; ++step) {
      for (size_t i = 0; i < world.poses.size(); ++i) {
        if (world.bodies[i].fixed) continue;
        world.poses[i].position += speed * random_direction(world.random);
        world.poses[i].rotation =
            world.poses[i].rotation * rotation_by(10.0 * speed * random_direction(world.random));
      }
      const int some = world.random.below(static_cast<int>(world.poses.size()));
      if (step % 9 == 4) world.poses[some].position = 0.3 * random_direction(world.random);
      if (step % 9 == 6) world.poses[some].rotation = random_rotation(world.random);
      if (step % 9 == 7) world.poses[some].rotation.coeffs() *= -1.0;  // the same rotation
      if (step % 9 == 8) world.reach[some] = 0.02 * world.random.uniform();
      const std::vector<Mat3> rotations = world.rotations();
      broad_phase.update(world.poses, rotations, world.reach);
      check_list(broad_phase, world);
    }
  }
}

TEST_CASE("a wide world, which is cut into strips, lists every pair once") {
  for (const Vec3& stretch : {Vec3(20, 10, 1), Vec3(1, 10, 20), Vec3(10, 1, 1), Vec3(0, 0, 0)}) {
    World world(700, 9);
    for (Pose& pose : world.poses) pose.position.array() *= stretch.array();
    for (const int large : {100, 200, 300}) world.reach[large] = 0.3;
    BroadPhase broad_phase(world.bodies, 1e-9), shared(world.bodies, 1e-9);
    WorkerTeam team;
    team.resize(3);
    shared.use_team(&team);
    for (BroadPhase* list : {&broad_phase, &shared})
      list->update(world.poses, world.rotations(), world.reach);
    check_list(broad_phase, world);
    CHECK(std::ranges::equal(shared.pairs(), broad_phase.pairs(), [](const auto& p, const auto& q) {
      return p.a == q.a && p.b == q.b;
    }));
  }
}

TEST_CASE("a slow motion keeps the list, a turn of sign is no motion") {
  World world(60, 5);
  BroadPhase broad_phase(world.bodies, 0.002);
  std::vector<Mat3> rotations = world.rotations();
  broad_phase.update(world.poses, rotations, world.reach);
  CHECK(broad_phase.rebuilds() == 1);
  const double allowed = 0.001;  // half the skin
  for (int step = 0; step < 20; ++step) {
    for (Pose& pose : world.poses) {
      pose.position.x() += allowed / 21;
      pose.rotation.coeffs() *= -1.0;
    }
    broad_phase.update(world.poses, rotations, world.reach);
  }
  CHECK(broad_phase.rebuilds() == 1);
  for (Pose& pose : world.poses) pose.position.x() += 0.001;
  broad_phase.update(world.poses, rotations, world.reach);
  CHECK(broad_phase.rebuilds() == 2);
  world.reach[0] += 0.01;
  broad_phase.update(world.poses, rotations, world.reach);
  CHECK(broad_phase.rebuilds() == 3);
}

TEST_CASE("remembered axes survive a new list") {
  World world(80, 6);
  BroadPhase broad_phase(world.bodies, 0.002);
  std::vector<Mat3> rotations = world.rotations();
  broad_phase.update(world.poses, rotations, world.reach);
  for (CandidatePair& pair : broad_phase.pairs()) pair.axis = {AxisKind::edges, pair.a, pair.b};
  std::set<std::pair<int, int>> before;
  for (const CandidatePair& pair : broad_phase.pairs()) before.emplace(pair.a, pair.b);
  for (Pose& pose : world.poses) pose.position += 0.01 * random_direction(world.random);
  broad_phase.update(world.poses, rotations, world.reach);
  CHECK(broad_phase.rebuilds() == 2);
  int kept = 0, fresh = 0;
  for (const CandidatePair& pair : broad_phase.pairs()) {
    const bool was = before.count({pair.a, pair.b}) > 0;
    (was ? kept : fresh)++;
    CHECK(pair.axis == (was ? AxisFeature{AxisKind::edges, pair.a, pair.b} : AxisFeature{}));
  }
  CHECK(kept > 10);
  CHECK(fresh > 10);
}

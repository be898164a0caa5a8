// Bodies of several parts against the same parts as bodies of their own, and periodic worlds
// against the same bodies copied into the neighbouring periods.

#include "geometry/contact/convex_elements.hpp"
#include "geometry/contact/contact_detector.hpp"
#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// The data of contacts without the names of features, sorted.
using Seen = std::vector<std::array<double, 9>>;

Seen seen(const std::vector<ContactPoint>& contacts, const std::function<int(int)>& body,
          const std::function<Vec3(const Vec3&)>& place) {
  Seen rows;
  for (const ContactPoint& c : contacts) {
    int a = body(c.body_a), b = body(c.body_b);
    const double sign = a < b ? 1.0 : -1.0;
    if (a > b) std::swap(a, b);
    const Vec3 p = place(c.position), n = sign * c.normal;
    rows.push_back({double(a), double(b), c.gap, p.x(), p.y(), p.z(), n.x(), n.y(), n.z()});
  }
  std::ranges::sort(rows);
  return rows;
}

void check_same(const Seen& ours, const Seen& theirs) {
  REQUIRE(ours.size() == theirs.size());
  for (size_t k = 0; k < ours.size(); ++k)
    for (size_t i = 0; i < 9; ++i) CHECK(ours[k][i] == Approx(theirs[k][i]).margin(1e-9));
}

const Polyhedron cube = make_box(Vec3(0.2, 0.2, 0.2)), bar = make_box(Vec3(0.6, 0.1, 0.1));

Vec3 random_place(Random& random, double size) {
  return Vec3(random.uniform(0, size), random.uniform(0, size), random.uniform(0, size));
}

}  // namespace

TEST_CASE("contacts of bodies of parts are those of the parts, but for parts of one body") {
  // Each body is a bar with a cube on each end. The oracle has three bodies instead.
  const Pose ends[] = {{Vec3::Zero(), Quat::Identity()},
                       {Vec3(0.3, 0, 0.05), Quat(0.6, 0.8, 0, 0)},
                       {Vec3(-0.3, 0, 0), Quat(0.8, 0, 0.6, 0)}};
  ContactShape body{&bar};
  for (int k = 0; k < 3; ++k) body.parts.push_back({k == 0 ? &bar : &cube, ends[k]});
  ContactShape floor;
  std::vector<ContactShape> bodies(12, body), alone;
  for (size_t b = 0; b < 12; ++b)
    for (const ConvexPart& part : body.parts) alone.push_back({part.polyhedron});
  bodies.push_back(floor);
  alone.push_back(floor);
  ContactDetector detector(bodies, {}), oracle(alone, {});
  Random random(7);
  std::vector<ContactPoint> ours, theirs;
  size_t found = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<Pose> poses, part_poses;
    for (int b = 0; b < 12; ++b) {
      poses.push_back({random_place(random, 0.9), random_rotation(random)});
      for (const Pose& end : ends)
        part_poses.push_back({poses[b] * end.position, poses[b].rotation * end.rotation});
    }
    poses.emplace_back();
    part_poses.emplace_back();
    detector.detect(poses, std::vector<double>(13, 0.01), ours);
    oracle.detect(part_poses, std::vector<double>(37, 0.01), theirs);
    std::erase_if(theirs, [](const ContactPoint& c) { return c.body_a / 3 == c.body_b / 3; });
    check_same(seen(ours, std::identity(), std::identity()),
               seen(
                   theirs, [](int part) { return part / 3; }, std::identity()));
    CHECK(std::ranges::is_sorted(
        ours, {}, [](const ContactPoint& c) { return std::tuple(c.body_a, c.body_b, c.feature); }));
    CHECK(std::ranges::adjacent_find(ours, {}, [](const ContactPoint& c) {
            return std::tuple(c.body_a, c.body_b, c.feature);
          }) == ours.end());
    found += ours.size();
  }
  CHECK(found > 1000);
}

TEST_CASE("contacts in a world that repeats itself are those of bodies copied out") {
  const Period period{Vec3(0.8, 0.6, 0)};
  const int count = 30;
  std::vector<ContactShape> shapes(count, {&cube}), copies;
  shapes[3].fixed = shapes[4].fixed = true;
  for (int k = 0; k < 3; ++k) copies.insert(copies.end(), shapes.begin(), shapes.end());
  ContactDetector detector(shapes, {}, period), oracle(copies, {});
  Random random(11);
  const auto wrapped = [&](const Vec3& p) { return period.wrapped(p); };
  size_t across = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<Pose> poses, copied;
    for (int b = 0; b < count; ++b)
      poses.push_back({random_place(random, 1.0) - Vec3::Constant(0.5), random_rotation(random)});
    for (int k = -1; k <= 1; ++k)
      for (const Pose& pose : poses)
        copied.push_back({wrapped(pose.position) + k * period.vector, pose.rotation});
    std::vector<ContactPoint> ours, theirs;
    detector.detect(poses, std::vector<double>(count, 0.01), ours);
    oracle.detect(copied, std::vector<double>(3 * count, 0.01), theirs);
    // Keeps each contact once: the one whose lower copy is that in the middle period.
    std::erase_if(theirs, [&](const ContactPoint& c) {
      const int a = c.body_a / count, b = c.body_b / count;
      return std::min(a, b) != 1;
    });
    for (const ContactPoint& c : theirs) across += c.body_a / count != c.body_b / count;
    const auto place = [&](const Vec3& p) { return Vec3(period.nearest(p - Vec3(1, 1, 1))); };
    check_same(seen(ours, std::identity(), place),
               seen(
                   theirs, [&](int copy) { return copy % count; }, place));
  }
  CHECK(across > 50);
}

TEST_CASE("a pair keeps its keys when one of its bodies goes on into the next period") {
  const Period period{Vec3(1, 0, 0)};
  ContactDetector detector({{&cube}, {&cube}}, {}, period);
  std::vector<ContactPoint> before, after;
  std::vector<Pose> poses{{Vec3(0.79, 0, 0), Quat::Identity()}, {Vec3(0.98, 0, 0), {1, 0, 0, 0}}};
  detector.detect(poses, std::vector<double>(2, 0.01), before);
  poses[0].position.x() += 0.03;
  poses[1].position.x() += 0.03 - 1.0;  // 1.01, which is 0.01 in the period
  detector.detect(poses, std::vector<double>(2, 0.01), after);
  REQUIRE(before.size() == 4);
  REQUIRE(after.size() == 4);
  for (size_t k = 0; k < 4; ++k) {
    CHECK(after[k].feature == before[k].feature);
    CHECK((after[k].normal - before[k].normal).norm() < 1e-12);
  }
}

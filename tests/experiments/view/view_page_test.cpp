#include <nlohmann/json.hpp>

#include "experiments/view/view.hpp"
#include "platform/deflate.hpp"
#include "tests/support/sample_run.hpp"

namespace ballast {
namespace {

/// Three grains in a box, in `frames` frames that are all different; the contacts are made up.
ViewData sample_view(size_t frames) {
  ViewData view;
  view.title = "a </script> in words";
  view.system = sample_system();
  view.system.bodies[6].wall.motion = WallMotion::driven;
  for (size_t f = 0; f < frames; ++f) {
    const MotionState state = sample_state(view.system, static_cast<long>(50 * f));
    view.frames.push_back({state.time, state.step, state.pose, state.velocity, state.spin});
  }
  view.contacts = [frames = view.frames](size_t f) {
    const Eigen::Vector3f place = frames[f].pose[0].position.cast<float>();
    return std::vector<FrameContact>{
        {0, 1, place, Eigen::Vector3f::UnitX(), Eigen::Vector3f(4.0f, 1.0f, 0.0f)},
        {0, 3, place, Eigen::Vector3f::UnitZ(), Eigen::Vector3f(0.0f, 0.0f, 1.0f)}};
  };
  view.series_time = {0.0, 1.0};
  view.series = {{"x", "x", "mm", "blue", {0.0, 2.5}}};
  view.plots = {{"", {"x"}}};
  return view;
}

/// Decodes the bytes of a history in the simplest way, as the twin of
/// experiments/page/replay/data.js.
template <class Word>
std::vector<Word> unpacked(const std::string& bytes, size_t columns, int order) {
  const size_t count = bytes.size() / sizeof(Word), frames = count / columns;
  std::vector<Word> values(count);
  for (size_t c = 0; c < columns; ++c) {
    long value = 0, slope = 0;
    for (size_t f = 0; f < frames; ++f) {
      long code = static_cast<unsigned char>(bytes[c * frames + f]);
      if (sizeof(Word) == 2)
        code += 256L * static_cast<unsigned char>(bytes[count + c * frames + f]);
      const long difference = code % 2 == 0 ? code / 2 : -(code + 1) / 2;
      slope = order == 2 ? slope + difference : difference;
      value += slope;
      values[f * columns + c] = static_cast<Word>(value);
    }
  }
  return values;
}

const std::string& part(const page::Replay& replay, const std::string& name) {
  for (const auto& [key, bytes] : replay.parts)
    if (key == name) return bytes;
  FAIL("no part " << name);
  return replay.head;
}

TEST_CASE("packed poses come back: places to a 2^16th of the box, rotations to 1e-4 rad") {
  const ViewData view = sample_view(7);
  const page::Replay replay = pack_view(view);
  const auto head = nlohmann::json::parse(replay.head);
  const auto places = unpacked<std::uint16_t>(part(replay, "positions"), 9, 2);
  const auto turns = unpacked<std::uint16_t>(part(replay, "rotations"), 12, 2);
  const auto speeds = unpacked<std::uint8_t>(part(replay, "velocities"), 9, 1);
  REQUIRE(places.size() == 7 * 9);
  for (size_t f = 0; f < 7; ++f) {
    CHECK(head["times"][f] == view.frames[f].time);
    for (size_t g = 0; g < 3; ++g) {
      const Pose& pose = view.frames[f].pose[g];
      for (size_t k = 0; k < 3; ++k) {
        const double low = head["low"][k], span = head["span"][k];
        const auto place = places[9 * f + 3 * g + k];
        CHECK(std::abs(low + span * place / 65535.0 - pose.position[static_cast<long>(k)]) <=
              0.501 * span / 65535.0);
        const double root = (speeds[9 * f + 3 * g + k] - 128) / 127.0;
        CHECK(std::abs(root * std::abs(root) * double(head["fastest"]) -
                       view.frames[f].velocity[g][static_cast<long>(k)]) <
              0.008 * double(head["fastest"]));
      }
      const auto entry = [&](size_t k) { return turns[12 * f + 4 * g + k] / 32767.5 - 1.0; };
      CHECK(
          Quat(entry(0), entry(1), entry(2), entry(3)).normalized().angularDistance(pose.rotation) <
          1e-4);
    }
  }
}

TEST_CASE("shapes, walls, contacts and curves are in the head or in a part of its size") {
  const ViewData view = sample_view(2);
  const page::Replay replay = pack_view(view);
  const auto head = nlohmann::json::parse(replay.head);
  CHECK((head["grains"] == 3 && head["shapes"] == 2 && head["walls"].size() == 6));
  CHECK(head["shape_of"] == nlohmann::json({0, 1, 1}));
  CHECK((head["walls"][3]["name"] == "x_max" && head["walls"][3]["driven"] == true));
  CHECK(head["walls"][2]["driven"] == false);
  size_t words = 0;
  for (const auto& shape : view.system.shapes) {
    words += 2 + 3 * shape->vertices().size() + static_cast<size_t>(shape->face_count());
    for (int f = 0; f < shape->face_count(); ++f) words += shape->face(f).size();
  }
  CHECK(part(replay, "shapes").size() == 2 * words);
  CHECK(part(replay, "walls").size() == 4 * 6 * 2 * 6);
  CHECK(part(replay, "series").size() == 4 * 2 * 2);
  CHECK(part(replay, "masses").size() == 4 * 2 * 3);
  // Body a is a grain: the second contact is turned round. A quarter of the force: half the root.
  CHECK(head["contact_counts"] == nlohmann::json({2, 2}));
  CHECK(head["largest_force"] == 4.0);
  CHECK(part(replay, "contact_bodies").substr(0, 8) == std::string("\0\0\0\0\1\3\1\3", 8));
  const std::string& forces = part(replay, "contact_forces");
  CHECK(static_cast<unsigned char>(forces[0]) + 256 * forces[4] == 4095);
  CHECK(static_cast<unsigned char>(forces[1]) + 256 * forces[5] == 2048);
}

TEST_CASE("a page knows the period, how often each grain has gone round, and all contacts") {
  ViewData view = sample_view(40);
  CHECK_FALSE(nlohmann::json::parse(pack_view(view).head).contains("period"));
  view.system.period.vector = Vec3(0.8, 0.6, 0.0);
  // The first grain moves forwards, the second back, the third across.
  const Vec3 ways[] = {{0.3, 0.0, 0.0}, {0.0, -0.5, 0.0}, {-0.6, 0.8, 0.0}};
  for (size_t f = 0; f < 40; ++f)
    for (size_t g = 0; g < 3; ++g)
      view.frames[f].pose[g].position =
          view.system.period.wrapped(0.1 * Vec3::Ones() + static_cast<double>(f) * ways[g]);
  view.contacts = [frames = view.frames](size_t f) {
    const Vec3 place = frames[f].pose[0].position + Vec3(0.81, 0.6, 0.0);  // one period farther
    return std::vector<FrameContact>{
        {0, 1, place.cast<float>(), Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitX()}};
  };
  for (const size_t most_bytes : {replay_bytes, size_t{0}}) {
    const page::Replay replay = pack_view(view, most_bytes);
    const auto head = nlohmann::json::parse(replay.head);
    CHECK(head["period"] == nlohmann::json({0.8, 0.6, 0.0}));
    const size_t frames = head["times"].size();
    CHECK(frames == (most_bytes > 0 ? 40 : 2));
    const auto laps = unpacked<std::uint16_t>(part(replay, "laps"), 3, 1);
    REQUIRE(laps.size() == 3 * frames);
    CHECK((laps[0] == 0 && laps[1] == 0 && laps[2] == 0));
    CHECK(laps[3 * frames - 3] == std::floor(0.14 + 39 * 0.24));
    CHECK(static_cast<std::int16_t>(laps[3 * frames - 2]) == std::floor(0.14 - 39 * 0.3));
    CHECK(laps[3 * frames - 1] == 0);
    // No contact is left out, and each is at its grain.
    for (const auto& count : head["contact_counts"]) CHECK(count == 1);
    const double reach = 1.02 * view.system.bodies[0].shape.polyhedron->circumradius();
    CHECK(part(replay, "contact_places")[0] ==
          static_cast<char>(128 + std::lround(127.0 * 0.01 / reach)));
  }
}

TEST_CASE("before the first step no forces are known: the next frame's stand for them") {
  ViewData view = sample_view(3);
  const auto frames_of = [](const ViewData& of) {
    return nlohmann::json::parse(pack_view(of).head)["contact_frames"];
  };
  CHECK(frames_of(view) == nlohmann::json({0, 1, 2}));
  // In the last frame bodies fly, and an empty list of contacts is right.
  view.contacts = [known = view.contacts](size_t f) {
    return f == 1 ? known(f) : std::vector<FrameContact>{};
  };
  REQUIRE(view.frames[0].step == 0);
  CHECK(frames_of(view) == nlohmann::json({1, 2}));
}

TEST_CASE("a caption speaks of a driven wall and of forces as they are") {
  ViewData view = sample_view(2);
  const auto caption = [&] { return plain_words(replay_of(view).caption); };
  CHECK_THAT(caption(), Catch::Contains("The driven wall stands"));
  view.system.bodies[6].wall.motion = WallMotion::fixed;
  view.contacts = {};
  CHECK_THAT(caption(), !Catch::Contains("driven wall") && Catch::Contains("not stored"));
  view.has_forces_later = true;
  CHECK_THAT(caption(), !Catch::Contains("not stored") && Catch::Contains("finished record"));
}

TEST_CASE("what would be too much is thinned out, its ends kept") {
  const ViewData view = sample_view(400);
  const auto all = nlohmann::json::parse(pack_view(view).head);
  const page::Replay small = pack_view(view, 12000);
  const auto few = nlohmann::json::parse(small.head);
  size_t bytes = 0;
  for (const auto& [name, content] : small.parts) bytes += base64(deflated(content, 9)).size();
  CHECK((bytes < 12100 && bytes > 6000));
  CHECK((all["times"].size() == 400 && all["contact_frames"].size() == 400));
  CHECK((few["times"].size() < 300 && few["times"].size() > 10));
  CHECK(few["times"].back() == view.frames.back().time);
  CHECK(few["contact_frames"].size() <= few["times"].size());
  CHECK_THROWS_AS(pack_view(ViewData{}), std::invalid_argument);
}

}  // namespace
}  // namespace ballast

#include <cmath>
#include <utility>

#include "experiments/view/view.hpp"
#include "platform/deflate.hpp"
#include "tests/support/inflated.hpp"
#include "tests/support/sample_run.hpp"

namespace ballast {
namespace {

std::uint32_t number_at(const std::string& bytes, size_t at) {
  std::uint32_t value = 0;
  for (size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

/// The names and contents of a PNG's chunks, with their checksums checked.
std::vector<std::pair<std::string, std::string>> chunks_of(const std::string& png) {
  CHECK(png.starts_with("\x89PNG\r\n\x1a\n"));
  std::vector<std::pair<std::string, std::string>> chunks;
  for (size_t at = 8; at < png.size();) {
    const size_t size = number_at(png, at);
    chunks.emplace_back(png.substr(at + 4, 4), png.substr(at + 8, size));
    CHECK(number_at(png, at + 8 + size) == crc32_of(png.substr(at + 4, 4 + size)));
    at += 12 + size;
  }
  return chunks;
}

/// The pixels of a frame, from rows that are stored as differences from the row above.
struct Pixels {
  size_t width, height;
  std::vector<std::array<int, 3>> rgb = {};

  Pixels(const std::string& deflated_rows, size_t wide, size_t high) : width(wide), height(high) {
    const std::string rows = inflated(deflated_rows);
    REQUIRE(rows.size() == height * (1 + 3 * width));
    for (size_t y = 0; y < height; ++y) {
      REQUIRE(rows[y * (1 + 3 * width)] == 2);
      for (size_t x = 0; x < width; ++x) {
        std::array<int, 3> pixel = y > 0 ? rgb[(y - 1) * width + x] : std::array<int, 3>{};
        for (size_t k = 0; k < 3; ++k)
          pixel[k] =
              (pixel[k] + static_cast<unsigned char>(rows[y * (1 + 3 * width) + 1 + 3 * x + k])) &
              255;
        rgb.push_back(pixel);
      }
    }
  }
  const std::array<int, 3>& at(size_t x, size_t y) const { return rgb[y * width + x]; }
  bool is_paper(size_t x, size_t y) const { return at(x, y) == at(0, 0); }
};

Pixels picture_of(const ViewData& view, const StillOptions& options) {
  for (const auto& [name, content] : chunks_of(still_png(view, {0}, options)))
    if (name == "IDAT")
      return {content, static_cast<size_t>(options.width), static_cast<size_t>(options.height)};
  FAIL("no picture");
  return {"", 0, 0};
}

ViewData view_of(MechanicalSystem system, const std::vector<MotionState>& states) {
  ViewData view;
  view.system = std::move(system);
  for (const MotionState& state : states)
    view.frames.push_back({state.time, state.step, state.pose, state.velocity, state.spin});
  return view;
}

StillOptions small_still(const std::string& way) {
  StillOptions options{.width = 200, .height = 160};
  set_view(options, way);
  return options;
}

/// Cubes of 0.1 m, each 0.8 m above the one below.
ViewData column_of_cubes(size_t count) {
  Scene scene;
  BodySpec body;
  body.shape = std::make_shared<const Polyhedron>(make_box(Vec3::Constant(0.1)));
  body.mass = 1.0;
  body.inertia = Vec3::Ones();
  scene.bodies.assign(count, body);
  MotionState state;
  MechanicalSystem system = make_system(scene, state);
  for (size_t k = 0; k < count; ++k) state.pose[k].position.z() = 0.8 * static_cast<double>(k);
  return view_of(std::move(system), {state});
}

TEST_CASE("a cube seen along an axis is a square in the middle, as large as the lens says") {
  const Pixels picture = picture_of(column_of_cubes(1), small_still("x"));
  CHECK(picture.is_paper(1, 1));
  CHECK_FALSE(picture.is_paper(100, 80));
  size_t wide = 0, high = 0;
  for (size_t x = 0; x < 200; ++x) wide += !picture.is_paper(x, 80);
  for (size_t y = 0; y < 160; ++y) high += !picture.is_paper(100, y);
  // The bodies' box has a margin of the circumradius of a cube; the near face is 0.05 m nearer.
  const double radius = 0.05 * 3.0, away = 3.4 * radius - 0.05;
  const double size = 0.1 / away * 80.0 / std::tan(14.0 * 3.14159265 / 180.0);
  CHECK(std::abs(static_cast<double>(wide) - size) <= 1.5);
  CHECK(std::abs(static_cast<double>(high) - size) <= 1.5);
}

TEST_CASE("all of a tall heap is in the picture") {
  const Pixels picture = picture_of(column_of_cubes(3), small_still("home"));
  size_t at_rim = 0, drawn = 0;
  for (size_t x = 0; x < picture.width; ++x)
    for (size_t y = 0; y < picture.height; ++y) {
      const bool is_rim = y == 0 || y + 1 == picture.height;
      (is_rim ? at_rim : drawn) += !picture.is_paper(x, y);
    }
  CHECK(at_rim == 0);
  CHECK(drawn > 100);
}

/// Three grains in the box of sample_system(): two beside each other, the third away from both.
MotionState three_grains(const MechanicalSystem& system) {
  MotionState state = sample_state(system, 0);
  state.pose[0].position = {0.15, 0.3, 0.25};
  state.pose[1].position = {0.45, 0.3, 0.25};
  state.pose[2].position = {0.3, 0.3, 0.44};
  return state;
}

TEST_CASE("several frames are an animated PNG, in which the driven wall moves") {
  const MechanicalSystem system = sample_system();
  MotionState before = three_grains(system);
  before.pose[0].position = {0.1, 0.1, 0.1};  // in corners, to show the whole box
  before.pose[1].position = {0.5, 0.5, 0.4};
  MotionState after = before;
  after.pose[6].position.x() -= 0.2;
  ViewData view = view_of(system, {before, after});
  view.system.bodies[6].wall.motion = WallMotion::driven;
  const StillOptions options = small_still("y");
  const auto chunks = chunks_of(still_png(view, {0, 1}, options));
  std::string names;
  std::vector<int> edges;
  for (const auto& [name, content] : chunks) {
    names += name + ' ';
    if (name != "IDAT" && name != "fdAT") continue;
    const Pixels picture(name == "IDAT" ? content : content.substr(4), 200, 160);
    // Only the wall is blue. x points to the left: the first blue column is the wall's near edge.
    for (size_t x = 0; x < 200; ++x) {
      const auto& [r, g, b] = picture.at(x, 80);
      if (b < r + 25) continue;
      edges.push_back(static_cast<int>(x));
      break;
    }
  }
  CHECK(names == "IHDR acTL fcTL IDAT fcTL fdAT IEND ");
  CHECK((number_at(chunks[1].second, 0) == 2 && number_at(chunks[1].second, 4) == 0));
  // Sequence numbers count fcTL and fdAT together. Each frame lasts a tenth of a second.
  CHECK((number_at(chunks[2].second, 0) == 0 && number_at(chunks[4].second, 0) == 1));
  CHECK(number_at(chunks[5].second, 0) == 2);
  CHECK(chunks[2].second.substr(20, 4) == std::string("\0\x64\3\xe8", 4));
  REQUIRE(edges.size() == 2);
  // The view is from 1.7 diagonals away, and the near edge is half the box's depth nearer.
  Eigen::AlignedBox3d box(Vec3::Zero(), Vec3(0.6, 0.6, 0.5));
  const double away = 1.7 * box.diagonal().norm() - 0.3;
  CHECK(std::abs(edges[1] - edges[0] - 0.2 / away * 80.0 / std::tan(14.0 * 3.14159265 / 180.0)) <
        2.0);
}

TEST_CASE("a chain joins the centres of two grains, where without it one sees what is between") {
  const MechanicalSystem system = sample_system();
  ViewData view = view_of(system, {three_grains(system)});
  const Eigen::Vector3f middle(0.3f, 0.3f, 0.25f), along = Eigen::Vector3f::UnitX();
  view.contacts = [&](size_t) {
    return std::vector<FrameContact>{{0, 1, middle, along, 4.0f * along},
                                     {1, 0, middle, -along, -4.0f * along},
                                     {1, 2, middle, along, 1.0f * along}};  // below the mean
  };
  StillOptions options = small_still("y");
  const auto darkest = [&] {
    const Pixels picture = picture_of(view, options);
    int least = 255;
    for (size_t y = 70; y < 90; ++y) least = std::min(least, picture.at(100, y)[2]);
    return least;
  };
  CHECK(darkest() > 150);
  options.with_chains = true;
  CHECK(darkest() < 120);
}

TEST_CASE("views by name and by angles") {
  StillOptions options;
  set_view(options, "30,-12.5");
  CHECK((options.yaw == 30.0 && options.pitch == -12.5));
  for (const char* word : {"w", "1", "1,b", "1,2,3", "nan,3", "30,inf"})
    CHECK_THROWS_AS(set_view(options, word), std::invalid_argument);
}

}  // namespace
}  // namespace ballast

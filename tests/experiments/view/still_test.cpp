#include "experiments/view/still.hpp"

#include <cmath>

#include "tests/support/inflated.hpp"
#include "tests/support/sample_run.hpp"

namespace ballast {
namespace {

ViewData one_cube() {
  Scene scene;
  BodySpec body;
  body.shape = std::make_shared<const Polyhedron>(make_box(Vec3::Constant(0.1)));
  body.mass = 1.0;
  body.inertia = Vec3::Ones();
  scene.bodies = {body};
  MotionState state;
  ViewData view;
  view.system = make_system(scene, state);
  view.frames = {{0.0, 0, state.pose, state.velocity, state.spin}};
  return view;
}

/// Rows of red, green, blue, without their filter bytes.
std::string pixels_of(const std::string& png, size_t width) {
  const size_t data = png.find("IDAT");
  std::string rows = inflated(png.substr(data + 4, png.find("IEND") - 4 - data - 8));
  std::string pixels;
  for (size_t at = 0; at < rows.size(); at += 1 + 3 * width)
    pixels += rows.substr(at + 1, 3 * width);
  return pixels;
}

TEST_CASE("a cube seen along an axis is a square in the middle, as large as the lens says") {
  StillOptions options;
  options.width = 100;
  options.height = 80;
  set_view(options, "x");
  const std::string pixels = pixels_of(still_png(one_cube(), 0, options), 100);
  REQUIRE(pixels.size() == 100 * 80 * 3);
  const auto is_paper = [&](size_t x, size_t y) { return pixels[3 * (100 * y + x)] == pixels[0]; };
  CHECK(is_paper(1, 1));
  CHECK_FALSE(is_paper(50, 40));
  size_t wide = 0, high = 0;
  for (size_t x = 0; x < 100; ++x) wide += !is_paper(x, 40);
  for (size_t y = 0; y < 80; ++y) high += !is_paper(50, y);
  // the bodies' box has the cube's circumradius on every side; the near face is 0.05 m nearer
  const double radius = 0.05 * 3.0, away = 3.4 * radius - 0.05;
  const double size = 0.1 / away * 40.0 / std::tan(14.0 * 3.14159265 / 180.0);
  CHECK(std::abs(static_cast<double>(wide) - size) <= 1.5);
  CHECK(std::abs(static_cast<double>(high) - size) <= 1.5);
}

TEST_CASE("a picture that is drawn part by part is the whole one, its edges and shadows too") {
  StillOptions options;
  options.width = 90;
  options.height = 77;  // no multiple of the parts
  ViewData view = one_cube();
  for (const auto& [way, chains] : {std::pair("home", false), {"20,50", false}, {"home", true}}) {
    set_view(options, way);
    options.with_chains = chains;
    const std::string whole = srgb_bytes(still_picture(view, 0, options), still_finer);
    CHECK((still_png(view, 0, options) == png_of_bytes(whole, options.width)));
  }
}

TEST_CASE("views and colours by name") {
  StillOptions options;
  set_view(options, "30,-12.5");
  CHECK((options.yaw == 30.0 && options.pitch == -12.5));
  for (const char* word : {"w", "1", "1,b", "1,2,3", "nan,3", "30,inf"})
    CHECK_THROWS_AS(set_view(options, word), std::invalid_argument);
  set_colour(options, "size");
  CHECK(options.colour == "size");
  CHECK_THROWS_AS(set_colour(options, "taste"), std::invalid_argument);
}

}  // namespace
}  // namespace ballast

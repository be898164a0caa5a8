#include "experiments/view/still_marks.hpp"

#include "experiments/view/still.hpp"
#include "tests/support/sample_run.hpp"

namespace ballast {
namespace {

/// Three grains in their box, of which the driven wall has moved inward by `inward` [m].
ViewData box_view(double inward) {
  ViewData view;
  view.system = sample_system();
  view.driven_wall = 6;
  MotionState state = sample_state(view.system, 0);
  state.pose[6].position.x() -= inward;
  view.frames = {{0.0, 0, state.pose, state.velocity, state.spin}};
  return view;
}

/// First and last column of the finer picture with a pixel of which `test` holds; none: -1.
template <class Test>
std::pair<int, int> columns_of(const Picture3& picture, Test&& test) {
  std::pair<int, int> columns{-1, -1};
  for (int x = 0; x < picture.width; ++x)
    for (int y = 0; y < picture.height; ++y)
      if (test(picture.pixels[picture.at(x, y)])) {
        if (columns.first < 0) columns.first = x;
        columns.second = x;
      }
  return columns;
}

/// Column and row where a still that looks along y has a point: x goes to the left.
std::pair<double, double> place_of(const ViewBox& box, const Picture3& picture, const Vec3& point) {
  const Vec3 from_centre = point - 0.5 * (box.low + box.high);
  const double away = 1.7 * (box.high - box.low).norm() - from_centre.y();
  const double scale = 0.5 * picture.height / std::tan(14.0 * 3.14159265358979 / 180.0) / away;
  return {0.5 * picture.width - scale * from_centre.x(),
          0.5 * picture.height - scale * from_centre.z()};
}

TEST_CASE("a plane's part in a box") {
  const ViewBox box{Vec3(0, 0, 0), Vec3(2, 1, 1)};
  const auto area = [](const std::vector<Vec3>& loop) {
    Vec3 sum = Vec3::Zero();
    for (size_t k = 2; k < loop.size(); ++k)
      sum += 0.5 * (loop[k - 1] - loop[0]).cross(loop[k] - loop[0]);
    return sum.norm();
  };
  CHECK(std::abs(area(plane_in_box(Vec3(0.5, 7, 7), Vec3::UnitX(), box)) - 1.0) < 1e-4);
  CHECK(std::abs(area(plane_in_box(Vec3(2, 0, 0), -Vec3::UnitX(), box)) - 1.0) < 1e-4);
  const Vec3 slant = Vec3(0, 1, 1).normalized();
  CHECK(std::abs(area(plane_in_box(Vec3(0, 0.5, 0.5), slant, box)) - 2.0 * std::sqrt(2.0)) < 1e-3);
  CHECK(plane_in_box(Vec3(2.5, 0, 0), Vec3::UnitX(), box).size() < 3);
}

TEST_CASE("the driven wall stands in a still where its pose says, within a pixel's worth") {
  StillOptions options;
  options.width = 300;
  options.height = 240;
  set_view(options, "y");
  std::vector<double> places;
  for (const double inward : {0.0, 0.05}) {
    const ViewData view = box_view(inward);
    const Picture3 picture = still_picture(view, 0, options);
    const ViewBox box = box_of(view);
    // blue is the driven wall alone; from the side it is a band between its near and far edges
    const auto [first, last] =
        columns_of(picture, [](const Colour& c) { return c[2] > c[0] + 0.15f && c[2] > c[1]; });
    const double x = view.frames[0].pose[6].position.x();
    const double near = place_of(box, picture, Vec3(x, box.high.y(), 0)).first,
                 far = place_of(box, picture, Vec3(x, box.low.y(), 0)).first;
    CHECK(std::abs(first - std::min(near, far)) < 4.0);
    CHECK(std::abs(last - std::max(near, far)) < 4.0);
    places.push_back(x);
  }
  CHECK(std::abs(places[0] - places[1] - 0.05) < 1e-12);
}

TEST_CASE("a chain joins the centres of two grains, where without it one sees what is between") {
  ViewData view = box_view(0.0);
  // two grains apart, the third out of the way
  for (const auto& [grain, place] : {std::pair<size_t, Vec3>{0, {0.15, 0.3, 0.25}},
                                     {1, {0.45, 0.3, 0.25}},
                                     {2, {0.3, 0.3, 0.44}}})
    view.frames[0].pose[grain].position = place;
  const Eigen::Vector3f middle(0.3f, 0.3f, 0.25f), along = Eigen::Vector3f::UnitX();
  view.contacts = [&](size_t) {
    return std::vector<FrameContact>{{0, 1, middle, along, 4.0f * along},
                                     {1, 0, middle, -along, -4.0f * along},
                                     {1, 2, middle, along, 1.0f * along}};
  };
  const std::vector<Rod> rods = chain_rods(view, 0);
  REQUIRE(rods.size() == 1);  // the weak one is below the mean
  CHECK((rods[0].from - view.frames[0].pose[0].position).norm() < 1e-12);
  CHECK((rods[0].to - view.frames[0].pose[1].position).norm() < 1e-12);
  StillOptions options;
  options.width = 120;
  options.height = 100;
  set_view(options, "y");
  const auto is_rod = [](const Colour& c) { return c[0] < 0.5f && c[2] < 0.3f; };
  const Picture3 bare = still_picture(view, 0, options);
  options.with_chains = true;
  const Picture3 drawn = still_picture(view, 0, options);
  const ViewBox box = box_of(view);
  const auto [column, row] = place_of(box, drawn, Vec3(0.3, 0.3, 0.25));
  bool was_there = false, is_there = false;
  for (int y = static_cast<int>(row) - 3; y < static_cast<int>(row) + 3; ++y) {
    was_there = was_there || is_rod(bare.pixels[bare.at(static_cast<int>(column), y)]);
    is_there = is_there || is_rod(drawn.pixels[drawn.at(static_cast<int>(column), y)]);
  }
  CHECK_FALSE(was_there);
  CHECK(is_there);
}

}  // namespace
}  // namespace ballast

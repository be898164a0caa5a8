#include "experiments/page/plot_layout.hpp"

#include <stdexcept>

#include "experiments/measure/curve_fit.hpp"
#include "tests/catch.hpp"

namespace ballast {
namespace {

Panel panel_of(std::vector<double> x, std::vector<double> y, const std::string& title = "") {
  Curve curve;
  curve.x = std::move(x);
  curve.y = std::move(y);
  curve.title = title;
  Panel panel;
  panel.x_label = "t";
  panel.curves = {curve};
  return panel;
}

TEST_CASE("axes hold every value, bar and reference line, with room around them") {
  Panel panel = panel_of({0, 10}, {1, 3});
  CHECK(x_extent(panel).low == Approx(-0.3));
  CHECK(x_extent(panel).high == Approx(10.3));
  CHECK(y_extent(panel).low == Approx(1.0 - 0.12));
  panel.curves[0].y_error = {0.0, 1.0};
  panel.lines = {{-1.0, "below", false, Ink::grey}, {99.0, "along x", true, Ink::grey}};
  CHECK(y_extent(panel).low == Approx(-1.0 - 0.06 * 5.0));
  CHECK(y_extent(panel).high == Approx(4.0 + 0.06 * 5.0));
  panel.y_max = 7.0;
  panel.x_min = 0.0;
  panel.x_max = 10.0;
  CHECK(y_extent(panel).high == 7.0);
  CHECK(x_extent(panel).low == 0.0);
  CHECK(x_extent(panel).high == 10.0);
}

TEST_CASE("values that differ in digits that no axis writes are a constant with room around it") {
  const Panel panel = panel_of({0, 1}, {-6.605827e-15, -6.6058270000001e-15});
  CHECK(y_extent(panel).low < -1e-10);
  CHECK(y_extent(panel).high > 1e-10);
  const Panel great = panel_of({0, 1}, {5e9, 5e9 + 1.0});
  CHECK(y_extent(great).high - y_extent(great).low > 1e8);
}

TEST_CASE("what an axis cannot show doesn't stretch it") {
  Panel panel = panel_of({0, 1, 2, not_known}, {not_known, 2, 4, 1e9});
  CHECK(y_extent(panel).high == Approx(4.0 + 0.12));
  panel = panel_of({1, 2, 3}, {-5, 0, 10});
  panel.log_y = true;
  CHECK(y_extent(panel).low == Approx(5.0));  // one value: a factor of two to both sides
  CHECK(y_extent(panel).high == Approx(20.0));
  panel.curves[0].y = {-1, 0, -2};
  CHECK_THROWS_AS(y_extent(panel), std::invalid_argument);
}

TEST_CASE("a logarithmic axis is numbered at 1, 2, 5, over many decades at powers of ten") {
  const std::vector<double> few = log_ticks({true, 0.9, 70.0}), many = log_ticks({true, 0.5, 2e3}),
                            short_one = log_ticks({true, 3.5, 8.0});
  CHECK(few.size() == 6);
  CHECK(few[2] == Approx(5.0));
  CHECK(few.back() == Approx(50.0));
  CHECK(many.size() == 4);
  CHECK(many.back() == Approx(1000.0));
  CHECK(short_one.size() == 5);  // 4 to 8
  CHECK(minor_log_ticks({true, 0.95, 3.1}).size() == 3);
}

TEST_CASE("an inset stands inside the panel before it and takes no room") {
  Figure figure;
  figure.panels = {panel_of({0, 1}, {0, 1}), panel_of({0, 1}, {0, 1})};
  figure.panels[1].is_inset = true;
  const std::vector<PanelPlace> places = panel_places(figure);
  CHECK(places[0].shows_x);
  CHECK(places[0].bottom == Approx(66.0));
  CHECK(places[1].left > places[0].left);
  CHECK(places[1].right < places[0].right);
  CHECK(places[1].top < places[0].top);
  CHECK(places[1].bottom > places[0].bottom);
}

TEST_CASE("a constant has room above and below") {
  const Extent y = y_extent(panel_of({0, 1}, {5, 5}));
  CHECK(y.low < 5.0 - 0.2);
  CHECK(y.high > 5.0 + 0.2);
}

TEST_CASE("panels stand under each other, equally high, inside the figure") {
  Figure figure;
  figure.height = 600;
  figure.panels = {panel_of({0, 1}, {0, 1}), panel_of({0, 1}, {0, 1}, "one line of key"),
                   panel_of({0, 1}, {0, 1})};
  std::vector<PanelPlace> places = panel_places(figure);
  REQUIRE(places.size() == 3);
  const double height = places[0].top - places[0].bottom;
  double above = figure.height;
  for (const PanelPlace& place : places) {
    CHECK(place.top - place.bottom == Approx(height));
    CHECK(place.top < above);
    above = place.bottom;
  }
  CHECK(above == Approx(66.0));  // numbers and label of the x axis
  CHECK(places[1].key.rows == 1);
  CHECK(places[0].bottom - places[1].top == Approx(12.0 + 12.0 + key_row));
  CHECK_FALSE(places[0].shows_x);
  CHECK(places[2].shows_x);
  figure.panels[1].x_label = "another";
  places = panel_places(figure);
  for (const PanelPlace& place : places) CHECK(place.shows_x);
  CHECK(places[2].bottom == Approx(66.0));
}

TEST_CASE("a key takes as many columns as its longest title leaves room for") {
  Figure figure;
  Panel panel = panel_of({0, 1}, {0, 1}, "short");
  const Curve curve = panel.curves[0];
  panel.curves.assign(20, curve);
  figure.panels = {panel};
  const KeySize narrow = panel_places(figure)[0].key;
  CHECK(narrow.columns * narrow.rows >= 20);
  CHECK(narrow.columns > 1);
  figure.panels[0].curves[7].title = std::string(100, 'w');
  CHECK(panel_places(figure)[0].key.columns == 1);
  CHECK(panel_places(figure)[0].key.rows == 20);
}

}  // namespace
}  // namespace ballast

#include "experiments/paper/section.hpp"

#include "experiments/measure/curve_fit.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("a figure's data are its panels and curves, row by row") {
  Figure figure;
  figure.panels.resize(1);
  figure.panels[0].x_label = "t, s";
  figure.panels[0].y_label = "x";
  figure.panels[0].curves = {points_of({1.0, 2.0}, {3.0, 4.5}, {0.5, not_known}, "", Ink::blue)};
  CHECK(figure_csv(figure) ==
        "panel,y_label,curve,x_label,x,y,y_error,y_low\n1,x,1,\"t, s\",1,3,0.5,\n"
        "1,x,1,\"t, s\",2,4.5,0,\n");
}

TEST_CASE("what is not known is an empty cell, and an area has its lower bound") {
  Figure figure;
  figure.panels.resize(1);
  Curve area;
  area.x = {1.0, 2.0};
  area.y = {1.0 / 3.0, not_known};
  area.y_low = {0.0, 0.0};
  figure.panels[0].curves = {area};
  CHECK(figure_csv(figure) ==
        "panel,y_label,curve,x_label,x,y,y_error,y_low\n"
        "1,,1,,1,0.3333333333,,0\n1,,1,,2,,,0\n");
}

TEST_CASE("a function is drawn from end to end, evenly on its axis") {
  const Curve line = curve_of([](double x) { return 2.0 * x; }, 1.0, 100.0, true, "", Ink::blue);
  REQUIRE(line.x.size() == 201);
  CHECK(line.x.front() == 1.0);
  CHECK(line.x[100] == Approx(10.0));
  CHECK(line.y.back() == Approx(200.0));
  CHECK(curve_of([](double x) { return x; }, 0.0, 1.0, false, "", Ink::blue).x[50] == 0.25);
}

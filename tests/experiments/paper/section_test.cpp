// How the report writes numbers and keeps its figures' data.

#include "experiments/paper/section.hpp"

#include "experiments/measure/curve_fit.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("numbers are written as a person writes them") {
  CHECK(digits(-1.9342) == "−1.93");
  CHECK(digits(0.00025) == "2.50e-4");
  CHECK(digits(not_known) == "–");
  CHECK(with_error(1.23456, 0.0421) == "1.235 ± 0.042");
  CHECK(with_error(123.4, 5.6) == "123.4 ± 5.6");
  CHECK(with_error(1.5, not_known) == "1.50");
}

TEST_CASE("relative deviations and intervals have their sign and both ends") {
  CHECK(percent(0.0312) == "+3.1 %");
  CHECK(percent(-0.12) == "−12 %");
  CHECK(percent(not_known) == "–");
  CHECK(interval(1.1, 1.4) == "[1.10, 1.40]");
}

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

#include <algorithm>

#include "experiments/run_page/figures.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/run_page/box_run.hpp"

namespace ballast {
namespace {

using Catch::Matchers::Contains;

const page::Picture* find(const std::vector<page::Picture>& pictures, const std::string& name) {
  const auto at = std::find_if(pictures.begin(), pictures.end(), [&](const page::Picture& picture) {
    return picture.plot.name == name;
  });
  return at == pictures.end() ? nullptr : &*at;
}

TEST_CASE("a slide without overlap has no figure of it, and no jam") {
  const BoxRun slide = slide_run();
  const auto figures = diagnostic_figures(slide.data, slide.summary);
  CHECK_FALSE(find(figures, "penetration"));
  CHECK_FALSE(find(figures, "jammed"));
  REQUIRE(find(figures, "error"));
  CHECK_THAT(plain_words(find(figures, "error")->caption.at(0)),
             Contains("Gravity is not known, so that the error is in m/s."));
}

TEST_CASE("costs are stacked: each phase stands on the one before, and the top is the sum") {
  const BoxRun box = box_run();
  const auto figures = diagnostic_figures(box.data, box.summary);
  REQUIRE(find(figures, "cost"));
  const std::vector<Curve>& curves = find(figures, "cost")->plot.panels.at(0).curves;
  REQUIRE(curves.size() == box.summary.cost.size());
  for (const double low : curves[0].y_low) CHECK(low == 0.0);
  for (size_t c = 1; c < curves.size(); ++c) CHECK(curves[c].y_low == curves[c - 1].y);
  double mean = 0.0;
  for (const double top : curves.back().y)
    mean += top / static_cast<double>(curves.back().y.size());
  CHECK(mean == Approx(box.summary.ms_per_step));
  CHECK_THAT(plain_words(find(figures, "cost")->caption.at(0)),
             Contains("stretches of 4.00\u202fms"));
}

TEST_CASE("errors are drawn over g h when gravity is known, with the tolerance") {
  BoxRun box = box_run();
  CHECK(find(diagnostic_figures(box.data, box.summary), "error")->plot.panels.at(0).lines.empty());
  box.summary.facts.tolerance = 0.01;
  const auto figures = diagnostic_figures(box.data, box.summary);
  REQUIRE(find(figures, "error"));
  const Panel& panel = find(figures, "error")->plot.panels.at(0);
  REQUIRE(panel.lines.size() == 1);
  CHECK(panel.lines[0].value == 0.01);
  const double largest =
      *std::max_element(panel.curves.at(1).y.begin(), panel.curves.at(1).y.end());
  CHECK(largest == Approx(box.summary.error_max_relative));
}

TEST_CASE("the residual of a balanced record stays at rounding") {
  const BoxRun slide = slide_run();
  const auto figures = diagnostic_figures(slide.data, slide.summary);
  REQUIRE(find(figures, "energy"));
  const Panel& below = find(figures, "energy")->plot.panels.back();
  for (const double residual : below.curves.at(1).y) CHECK(residual < 1e-12);
}

}  // namespace
}  // namespace ballast

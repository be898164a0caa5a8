#include "experiments/run_page/figures.hpp"

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/experiments/run_page/box_run.hpp"

namespace ballast {
namespace {

TEST_CASE("lines are thinned, forces have a readable unit") {
  std::vector<double> x(10000), y(10000, 1.0);
  for (size_t k = 0; k < x.size(); ++k) x[k] = static_cast<double>(k);
  y[1234] = 9.0;
  const Curve curve = line_of(x, y, "a", Ink::blue);
  CHECK(curve.x.size() <= 3000);
  CHECK(*std::max_element(curve.y.begin(), curve.y.end()) == 9.0);
  CHECK(std::string(force_unit(999.0).name) == "N");
  CHECK(force_unit(1000.0).factor == 1e-3);
}

using Catch::Matchers::Contains;

TEST_CASE("the loop's phases take each step once, and the axis cuts spikes off") {
  MeasuredRun box = box_run();
  const WallCycles& cycles = box.summary.wall;
  const size_t first = cycles.loop().front().first;
  box.data.steps[first + 10].wall_force = 1e9;  // a spike in one step
  const Panel panel = figure_4(box.data, box.summary).plot.panels.at(0);
  REQUIRE(panel.curves.size() == 5);  // each step, three phases, fits
  CHECK(*panel.y_max < 20.0);         // kN
  const size_t last = cycles.loop().back().last;
  for (size_t k = first + 1; k < last; ++k) {
    int drawn = 0;
    for (size_t c = 1; c < 4; ++c) drawn += std::isfinite(panel.curves[c].y[k - first]);
    // At a change of phase the sample belongs to both curves, so that there is no gap.
    const WallPhase before = cycles.phase[k - 1], now = cycles.phase[k];
    CHECK(drawn == (now != WallPhase::none) + (before != WallPhase::none && before != now));
  }
}

TEST_CASE("captions say the run's own numbers") {
  const MeasuredRun box = box_run();
  const auto caption = [](const page::Picture& picture) {
    return plain_words(picture.caption.at(0));
  };
  const std::string first = caption(figure_3(box.data, box.summary));
  CHECK_THAT(first, Contains("Here the wall first goes in by 6.0"));
  CHECK_THAT(caption(paper_figures(box.data, box.summary).at(2)),
             Contains("before the drive, 0.5010 (paper: 0.50)") &&
                 Contains(plain_words(page::number(box.summary.compaction.gain)) + " per period"));
  CHECK_THAT(caption(figure_4(box.data, box.summary)), Contains("Dashed: least squares"));
  RunSummary without_fits = box.summary;
  without_fits.law.active.r2 = not_known;
  CHECK_THAT(caption(figure_4(box.data, without_fits)), !Contains("Dashed"));
  CHECK_THAT(caption(diagnostic_figures(box.data, box.summary).at(0)),
             Contains("While f is above its mean"));
}

TEST_CASE("of a wall that moves out no caption says that it goes in") {
  MeasuredRun box = box_run();
  box.summary.contraction.size = 0.0;
  box.summary.net.mean = box.summary.rise.mean;
  CHECK_THAT(plain_words(figure_3(box.data, box.summary).caption.at(0)),
             !Contains("goes in by") && Contains("in a period and gains "));
  box.summary.facts.f_max = not_known;
  const page::Picture loop = figure_4(box.data, box.summary);
  CHECK_THAT(plain_words(loop.caption.at(0)), !Contains("side by side"));
  CHECK_FALSE(loop.plot.panels.at(0).y_max);
}

const page::Picture* find(const std::vector<page::Picture>& pictures, const std::string& name) {
  const auto at = std::find_if(pictures.begin(), pictures.end(), [&](const page::Picture& picture) {
    return picture.plot.name == name;
  });
  return at == pictures.end() ? nullptr : &*at;
}

TEST_CASE("a slide without overlap has no figure of it, and no jam") {
  MeasuredRun slide = slide_run();
  const auto figures = diagnostic_figures(slide.data, slide.summary);
  CHECK_FALSE(find(figures, "penetration"));
  CHECK_FALSE(find(figures, "jammed"));
  CHECK(find(figures, "error"));
  // The record is balanced: its residual is of the size of rounding errors.
  REQUIRE(find(figures, "energy"));
  for (const double residual : find(figures, "energy")->plot.panels.back().curves.at(1).y)
    CHECK(residual < 1e-12);
  CHECK_THAT(plain_words(find(figures, "error")->caption.at(0)),
             Contains("In m/s, as there is no"));
  // The caption of a scene's overlaps does not mention a first contraction.
  slide.summary.penetration_max = 1e-6;
  const auto overlapping = diagnostic_figures(slide.data, slide.summary);
  CHECK_THAT(plain_words(find(overlapping, "penetration")->caption.at(0)),
             Contains("Deepest") && !Contains("first contraction"));
}

TEST_CASE("errors are drawn over g h when gravity is known, with the tolerance") {
  MeasuredRun box = box_run();
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

}  // namespace
}  // namespace ballast

#include "experiments/paper/sections.hpp"

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("a figure's data are its panels and curves, row by row, empty where nothing is known") {
  Figure figure;
  figure.panels.resize(1);
  figure.panels[0].x_label = "t, s";
  figure.panels[0].y_label = "x";
  Curve area;
  area.x = {1.0, 2.0};
  area.y = {1.0 / 3.0, not_known};
  area.y_low = {0.0, 0.0};
  figure.panels[0].curves = {
      curve_of(Points{{1.0, 2.0}, {3.0, 4.5}, {0.5, not_known}}, "", Ink::blue), area};
  CHECK(figure_csv(figure) ==
        "panel,y_label,curve,x_label,x,y,y_error,y_low\n1,x,1,\"t, s\",1,3,0.5,\n"
        "1,x,1,\"t, s\",2,4.5,0,\n1,x,2,\"t, s\",1,0.3333333333,,0\n1,x,2,\"t, s\",2,,,0\n");
}

TEST_CASE("a function is drawn from end to end, evenly on its axis") {
  const Curve line = curve_of([](double x) { return 2.0 * x; }, {1.0, 100.0, true}, "", Ink::blue);
  REQUIRE(line.x.size() == 201);
  CHECK(line.x.front() == 1.0);
  CHECK(line.x[100] == Approx(10.0));
  CHECK(line.y.back() == Approx(200.0));
  CHECK(curve_of([](double x) { return x; }, {0.0, 1.0, false}, "", Ink::blue).x[50] == 0.25);
}

TEST_CASE("a figure has its words, and files that sort by number") {
  PaperSection section;
  section.draw("fig8", {.panels = {Panel{}}},
               {{"slow", "3"},
                {"fast", "7"},
                {"raw", "0.5"},
                {"scaled", "0.1"},
                {"samples", "3"},
                {"more", "x"}});
  REQUIRE(section.figures.size() == 1);
  const page::Picture& picture = section.figures[0];
  CHECK(picture.plot.name == "fig08");
  CHECK_THAT(picture.plot.title, Catch::Contains("Phase portraits"));
  REQUIRE(picture.caption.size() == 2);
  CHECK_THAT(plain_words(picture.caption[0]), Catch::StartsWith("Paper: Displacements"));
  CHECK_THAT(plain_words(picture.caption[1]), Catch::Contains("0.5 raw, 0.1 scaled"));
  CHECK(picture.files.spans.at(0).link == "data/fig08.csv");
  section.draw("fig10_mass", {.name = "mine", .title = "Mine"},
               {{"exponent", "1"}, {"misfit", "2"}});
  CHECK(section.figures[1].plot.name == "mine");
  CHECK(section.figures[1].plot.title == "Mine");
}

TEST_CASE(
    "a claim is a row: where, what the paper says, what was measured, and whether it agrees") {
  PaperSection section;
  section.claim("fig8.collapse", {{"raw", "0.5"}, {"scaled", "0.1"}}, PaperRange::at_most(0.1),
                {.value = 0.2, .low = 0.19, .high = 0.21});
  REQUIRE(section.claims.size() == 1);
  REQUIRE(section.claims[0].size() == 6);
  CHECK(section.claims[0][0] == page::Text("Fig. 8"));
  CHECK(section.claims[0][1] == page::Text("orbits at 5 and 10 Hz collapse"));
  CHECK(section.claims[0][2] == page::Text("DIFFERS"));
  CHECK_THAT(plain_words(section.claims[0][3]), Catch::StartsWith("distance raw 0.5, scaled"));
  section.report("curve.bend", {{"bend", "nothing"}});
  REQUIRE(section.findings.size() == 1);
  REQUIRE(section.findings[0].size() == 2);
  CHECK(plain_words(section.findings[0][0]) == "the curve bends");
  CHECK(section.claims.size() == 1);
}

TEST_CASE("the one rule of the verdicts, case by case") {
  struct Judged {
    PaperRange paper;
    double value, half_width;
    Agreement verdict;
    double law_p = 0.5;
    bool is_whole = true;
  };
  const PaperRange square = PaperRange::exponent(-2.0), bound = PaperRange::at_most(0.26);
  using enum Agreement;
  const Judged cases[] = {
      // in the range: sharp agrees; a wide interval, a failing law or missing runs: partly
      {square, -1.93, 0.05, agrees},
      {square, -1.93, 0.5, partly},
      {square, -1.93, 0.05, partly, 1e-3},
      {square, -1.93, 0.05, agrees, not_known},
      {square, -1.93, 0.02, partly, 0.5, false},
      // Scatter is not rewarded: a value far off whose interval reaches the range is undecided.
      {square, -1.75, 0.01, partly},
      {square, -1.5, 0.1, differs},
      {square, -1.5, 0.6, reported},
      {square, -1.93, not_known, reported},
      // A bound is not widened.
      {bound, 0.2, 0.05, agrees},
      {bound, 0.2, 0.1, partly},
      {bound, 0.3, 0.01, differs},
      {bound, 0.3, 0.1, reported},
      {PaperRange::at_least(0.0), 1.0, 0.4, agrees}};
  for (const Judged& c : cases) {
    INFO(c.value << " ± " << c.half_width);
    CHECK(agreement_of(c.paper, {c.value, c.value - c.half_width, c.value + c.half_width, c.law_p,
                                 c.is_whole}) == c.verdict);
  }
  CHECK(found(SampleMean{1.0, 0.1, 3}).low == Approx(1.0 - 4.303 * 0.1).epsilon(1e-4));
  CHECK(agreement_of(PaperRange::at_least(0.0), found(SampleMean{1.0, not_known, 1})) == reported);
}

TEST_CASE("ranges and findings in words") {
  CHECK(plain_words(words_of(PaperRange::exponent(-2.0))) == "−2.1 … −1.9");
  CHECK(plain_words(words_of(PaperRange::roughly(0.01))) == "0.007 … 0.013");
  CHECK(plain_words(words_of(PaperRange::at_most(0.26))) == "≤ 0.26");
  const Found found{.value = -1.7, .low = -1.74, .high = -1.66, .law_p = 1e-4};
  CHECK(plain_words(words_of(found)) == "−1.70 [−1.74, −1.66]; the law misses the points");
}

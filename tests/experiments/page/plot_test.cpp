#include "experiments/page/plot.hpp"

#include <chrono>
#include <cmath>

#include "experiments/measure/curve_fit.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"
#include "tests/catch.hpp"
#include "tests/support/environment_guard.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

Curve curve(std::vector<double> x, std::vector<double> y, const std::string& title,
            Mark mark = Mark::line) {
  return {.x = std::move(x), .y = std::move(y), .title = title, .mark = mark};
}

Figure simple_figure(const page::Text& label = page::marked("*x*  (mm)")) {
  return {.name = "simple",
          .panels = {{.x_label = "time",
                      .y_label = label,
                      .curves = {curve({0, 1, 2, 3}, {1, 4, not_known, 2}, "a title")}}}};
}

/// The part of the script between two words.
std::string between(const std::string& script, const std::string& before,
                    const std::string& after) {
  const size_t begin = script.find(before) + before.size();
  return script.substr(begin, script.find(after, begin) - begin);
}

/// A folder with an executable `gnuplot` that is this shell script.
void write_false_gnuplot(const TemporaryFolder& folder, const std::string& script) {
  const fs::path program = folder.write("gnuplot", "#!/bin/sh\n" + script + "\n");
  fs::permissions(program, fs::perms::owner_all);
}

TEST_CASE("a figure becomes an SVG, and a script that makes it again") {
  REQUIRE_THAT(gnuplot_version(), Contains("gnuplot"));  // listed in apt-packages.txt
  const TemporaryFolder folder;
  const fs::path figures = folder.path() / "figures";
  const std::string svg = render_svg(simple_figure(), figures);
  CHECK_THAT(svg, Contains("<svg") && Contains("a title") && Contains("(mm)"));
  CHECK(read_whole_file(figures / "simple.svg") == svg);
  const ProgramResult again =
      run_program("gnuplot", {"-d", (figures / "simple.gnuplot").string()}, 30.0);
  CHECK(again.output == svg);
  CHECK(std::distance(fs::directory_iterator(figures), fs::directory_iterator()) == 2);
}

TEST_CASE("every kind of mark, logarithms, references, several panels with different axes") {
  Figure figure = simple_figure();
  Panel& panel = figure.panels[0];
  panel.log_x = panel.log_y = true;
  panel.curves[0].x[0] = 0.5;
  panel.curves.push_back(curve({1, 10}, {3, 30}, "points", Mark::points));
  panel.curves.back().y_error = {0.5, 2};
  panel.curves.push_back(curve({1, 10}, {3, 30}, "bare points", Mark::points));
  panel.curves.push_back(curve({1, 10}, {30, 50}, "area", Mark::area));
  panel.curves.back().y_low = {20, 25};
  panel.curves.back().opacity = 0.4;
  panel.lines = {{100.0, "bound", false, Ink::grey}, {4.0, "there", true, Ink::grey}};
  figure.panels.push_back(simple_figure().panels[0]);
  figure.panels[1].x_label = "another axis";
  const TemporaryFolder folder;
  const std::string svg = render_svg(figure, folder.path());
  CHECK_THAT(svg, Contains("bound") && Contains("there") && Contains("another axis") &&
                      Contains("bare points"));
}

TEST_CASE("labels cannot run commands or end their string") {
  const TemporaryFolder folder;
  const fs::path trap = folder.path() / "trap";
  const std::string hostile = "it's `touch " + trap.string() + "`'; system('touch " +
                              trap.string() + "') #\n!touch " + trap.string();
  Figure figure = simple_figure(hostile);
  figure.panels[0].curves[0].title = hostile;
  figure.panels[0].lines = {{2.0, hostile, false, Ink::grey}};
  const std::string svg = render_svg(figure, folder.path());
  CHECK_FALSE(fs::exists(trap));
  CHECK_THAT(svg, Contains("system("));
}

TEST_CASE("styles of a label are gnuplot's, what is no style is no markup of gnuplot either") {
  const auto label = [](const page::Text& text) {
    return between(gnuplot_script(simple_figure(text)), "set ylabel ", "\n");
  };
  CHECK(label(page::marked("*f*~max~ = **2**×10^−4^ N\n")) ==
        "'{/:Italic f}_{max} = {/:Bold 2}×10^{−4} N '");
  CHECK(label("pgs_warm {x^2} a&b's ~@\\") == "'pgs\\_warm \\{x\\^2\\} a\\&b''s \\~\\@\\\\'");
}

TEST_CASE("a figure without a value is refused by name, a missing gnuplot too") {
  const TemporaryFolder folder, empty;
  Figure figure = simple_figure();
  figure.panels[0].log_y = GENERATE(false, true);
  figure.panels[0].curves[0].y.assign(4, figure.panels[0].log_y ? 0.0 : not_known);
  CHECK_THROWS_WITH(render_svg(figure, folder.path()), Contains("figure simple"));
  const EnvironmentGuard guard("PATH", empty.path().string());
  CHECK(gnuplot_version().empty());
  CHECK_THROWS_WITH(render_svg(simple_figure(), folder.path()), Contains("cannot be started"));
}

TEST_CASE("a failing gnuplot is one clear error, and no stale figure stays") {
  const TemporaryFolder folder, path;
  folder.write("simple.svg", "an older one");
  const EnvironmentGuard guard("PATH", path.path().string() + ":/bin:/usr/bin");
  write_false_gnuplot(path, "echo 'line 3: out of ink' >&2; exit 3");
  CHECK_THROWS_WITH(
      render_svg(simple_figure(), folder.path()),
      Contains("figure simple") && Contains("(3)") && Contains("out of ink") && !Contains("\n"));
  CHECK_FALSE(fs::exists(folder.path() / "simple.svg"));
  write_false_gnuplot(path, "echo '<svg>'");
  CHECK_THROWS_WITH(render_svg(simple_figure(), folder.path()), Contains("incomplete"));
  write_false_gnuplot(path, "kill -9 $$");
  CHECK_THROWS_WITH(render_svg(simple_figure(), folder.path()), Contains("(137)"));
}

TEST_CASE("a gnuplot that hangs is ended") {
  const TemporaryFolder folder, path;
  const EnvironmentGuard guard("PATH", path.path().string() + ":/bin:/usr/bin");
  SECTION("silent") { write_false_gnuplot(path, "exec sleep 60"); }
  SECTION("with its outputs closed") { write_false_gnuplot(path, "exec sleep 60 >&- 2>&-"); }
  const auto begin = std::chrono::steady_clock::now();
  CHECK_THROWS_WITH(render_svg(simple_figure(), folder.path(), 0.3),
                    Contains("figure simple") && Contains("was ended"));
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(20));
}

TEST_CASE("the user's own gnuplot settings don't reach the figures") {
  const TemporaryFolder folder, home;
  home.write(".gnuplot", "set title 'mine'\n");
  const EnvironmentGuard guard("HOME", home.path().string()), terminal("GNUTERM", "dumb");
  CHECK_THAT(render_svg(simple_figure(), folder.path()), Contains("<svg") && !Contains("mine"));
}

TEST_CASE("thinned curves keep their extremes and their order") {
  std::vector<double> x, y;
  for (int k = 0; k < 10000; ++k) {
    x.push_back(k);
    y.push_back(std::sin(0.01 * k));
  }
  y[4321] = 7.0;
  y[8765] = -9.0;
  for (int k = 6000; k < 6100; ++k) y[k] = not_known;
  thin_out(x, y, 400);
  CHECK(x.size() <= 400);
  CHECK(x.size() > 300);
  CHECK(std::is_sorted(x.begin(), x.end()));
  CHECK(std::count(y.begin(), y.end(), 7.0) == 1);
  CHECK(std::count(y.begin(), y.end(), -9.0) == 1);
  CHECK(std::count_if(y.begin(), y.end(), [](double v) { return std::isnan(v); }) > 0);
  std::vector<double> few{1, 2}, as_few{3, 4};
  thin_out(few, as_few, 400);
  CHECK(few == std::vector<double>{1, 2});
}

TEST_CASE("axes hold every value, bar and reference line, with room around them") {
  const auto ranges = [](const Figure& figure) {
    const std::string script = gnuplot_script(figure);
    return between(script, "set xrange [", "]") + ' ' + between(script, "set yrange [", "]");
  };
  Figure figure = simple_figure();
  Panel& panel = figure.panels[0];
  panel.curves = {curve({0, 10}, {1, 3}, "")};
  CHECK(ranges(figure) == "-0.3:10.3 0.88:3.12");
  panel.curves[0].y_error = {0.0, 1.0};
  panel.curves[0].mark = Mark::points;
  panel.lines = {{-1.0, "below", false, Ink::grey}, {99.0, "along x", true, Ink::grey}};
  CHECK(ranges(figure) == "-0.3:10.3 -1.3:4.3");
  panel.y_max = 7.0;
  panel.x_min = 0.0;
  panel.x_max = 10.0;
  CHECK(ranges(figure) == "0:10 -1.3:7");
  // values that the axis cannot show do not widen it; one value has a factor of two to both sides
  figure = simple_figure();
  figure.panels[0].curves = {curve({1, 2, 3, not_known}, {-5, 0, 10, 1e9}, "")};
  figure.panels[0].log_y = true;
  CHECK(ranges(figure) == "0.94:3.06 5:20");
  // a constant, and values that differ only in digits that no axis writes, have room on both sides
  figure.panels[0].log_y = false;
  figure.panels[0].curves = {curve({0, 1}, {5e9, 5e9 + 1.0}, "")};
  CHECK(parsed_number(between(gnuplot_script(figure), "set yrange [", ":")).value() < 4.8e9);
}

TEST_CASE("a logarithmic axis is numbered at 1, 2, 5, over many decades at powers of ten") {
  Figure figure = simple_figure();
  Panel& panel = figure.panels[0];
  panel.log_y = true;
  const auto ticks = [&](double low, double high) {
    panel.curves = {curve({0, 1}, {low, high}, "")};
    panel.y_min = low;
    panel.y_max = high;
    return between(gnuplot_script(figure), "set ytics (", ", ''");
  };
  CHECK(ticks(0.9, 70.0) == "1, 2, 5, 10, 20, 50");
  CHECK(ticks(0.5, 2e3) == "1, 10, 100, 1000");
  CHECK(ticks(3.5, 8.0) == "4, 5, 6, 7, 8");
}

}  // namespace
}  // namespace ballast

// The closed loop from one start: equal settings give equal bits, and looser tolerances end farther
// from the reference.

#include "experiments/compare/live.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/compare/comparison.hpp"
#include "experiments/page/plot.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_live.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

/// The options for a dozen grains in a driven box.
LiveOptions small_live(const std::filesystem::path& folder) {
  LiveOptions options;
  options.scene = "vibrated_box_small";
  options.overrides = {"grains.count=12", "box.length=0.12", "box.width=0.12",
                       "control_volume.margin_x=0.02"};
  options.solvers = parse_solvers("pgs,nncg");
  options.tolerances = {1e-2, 1e-8};
  options.start = 2e-3;
  options.duration = 4e-3;
  options.max_seconds = 5.0;
  options.style = StatusLine::Style::quiet;
  options.folder = folder;
  return options;
}

void say_nothing(const Trajectory&) {}

double number_of(const char* name, size_t trajectory, const LiveComparison& live) {
  for (const LiveNumber& number : live_numbers())
    if (std::string(name) == number.name) return number.of(live.trajectories[trajectory], live);
  FAIL("no number " << name);
  return 0.0;
}

const page::Picture* find_figure(const std::vector<page::Picture>& figures,
                                 const std::string& name) {
  for (const page::Picture& figure : figures)
    if (figure.plot.name == name && !figure.plot.panels.empty()) return &figure;
  return nullptr;
}

}  // namespace

TEST_CASE("One start under several backends and tolerances") {
  const TemporaryFolder folder;
  const LiveOptions options = small_live(folder.path());
  const auto run = [&] { return run_live(options, say_nothing); };
  LiveOptions earlier = options;  // another start in the same folder
  earlier.start = 1e-3;
  earlier.duration = 2e-4;
  earlier.solvers = parse_solvers("pgs");
  run_live(earlier, say_nothing);
  const LiveComparison comparison = run();
  REQUIRE(comparison.trajectories.size() == 4);
  CHECK(comparison.has_driven_wall);
  for (const Trajectory& t : comparison.trajectories) {
    INFO(t.label());
    CHECK(t.ended == "complete");
    REQUIRE(t.steps.size() == 20);
    CHECK(t.frame_times.front() == Approx(2e-3));
    CHECK(t.frame_times.back() == Approx(6e-3));
    CHECK(t.positions.front() == comparison.trajectories[0].positions.front());  // the same start
    CHECK(t.positions.back().size() == 36);
    for (const StepRecord& step : t.steps)
      CHECK(step.error_rms <= t.tolerance * comparison.velocity_scale);
  }
  REQUIRE(comparison.reference() >= &comparison.trajectories[2]);  // one with the tight tolerance
  const Trajectory& reference = *comparison.reference();
  for (const Trajectory& t : comparison.trajectories)
    CHECK(reference.mean_error() <= t.mean_error());
  const double loose = distances(comparison.trajectories[0], reference).back();
  const size_t other = &reference == &comparison.trajectories[2] ? 3 : 2;
  const double other_backend = distances(comparison.trajectories[other], reference).back();
  CHECK(distances(reference, reference).back() == 0.0);
  CHECK(loose > 0.0);
  CHECK(other_backend < loose);
  // Reading the files gives the same; damaged files are made again.
  for (const bool are_damaged : {false, true}) {
    if (are_damaged)
      for (const auto& file : std::filesystem::directory_iterator(folder.path() / "trajectories"))
        write_whole_file(file.path(), read_whole_file(file.path()).substr(0, 300));
    const LiveComparison again = run();
    REQUIRE(again.trajectories.size() == 4);
    for (size_t k = 0; k < 4; ++k) {
      CHECK(again.trajectories[k].steps.size() == 20);
      CHECK(again.trajectories[k].positions.back() == comparison.trajectories[k].positions.back());
    }
  }
}

TEST_CASE("Trajectories of so many iterations stand beside those to a tolerance") {
  const TemporaryFolder folder;
  LiveOptions options = small_live(folder.path());
  options.solvers = parse_solvers("pgs");
  options.tolerances = {1e-8};
  options.iterations = {2, 30};
  const LiveComparison live = run_live(options, say_nothing);
  REQUIRE(live.trajectories.size() == 3);
  CHECK(live.trajectories[1].label() == "pgs 2 iterations");
  for (const Trajectory& t : live.trajectories) CHECK(t.is_complete());
  CHECK(live.reference() == &live.trajectories[0]);
  CHECK(number_of("error_max", 0, live) <= 1e-8);
  CHECK(number_of("distance_end", 0, live) == 0.0);
  CHECK(number_of("iterations_mean", 1, live) == 2.0);
  CHECK(number_of("error_mean", 1, live) > number_of("error_mean", 2, live));
  CHECK(number_of("distance_end", 1, live) > 0.0);
  const std::vector<page::Picture> figures = live_figures(live);
  const page::Picture* accuracy = find_figure(figures, "live_accuracy");
  REQUIRE(accuracy);
  const Curve& line = accuracy->plot.panels[0].curves[0];
  CHECK(line.title == "pgs");
  REQUIRE(line.x.size() == 3);
  for (size_t k = 0; k < 3; ++k) {  // 5000 steps of 2e-4 s make a second
    const auto found = std::ranges::find(line.y, number_of("error_mean", k, live));
    REQUIRE(found != line.y.end());
    const double cost = line.x[static_cast<size_t>(found - line.y.begin())];
    CHECK(cost == Approx(5.0 * number_of("ms_per_step", k, live)));
  }
  CHECK(std::isnan(number_of("missed", 1, live)));
  CHECK(live_csv(live).find("\npgs,coulomb,nan,2,complete,20,") != std::string::npos);
}

TEST_CASE("The reference is complete, of the exact law, and of the least mean error") {
  LiveComparison live;
  live.trajectories = {hand_made_trajectory("pgs", 1e-1, 0.0),
                       hand_made_trajectory("nncg", 1e-2, 0.0)};
  Trajectory &first = live.trajectories[0], &second = live.trajectories[1];
  CHECK(live.reference() == &first);  // of equals, the first in the list
  first.steps[1].error_rms *= 2.0;
  CHECK(live.reference() == &second);
  second.steps[0].error_rms = 0.0;
  second.steps[1].error_rms = std::nan("");  // makes the mean not finite
  CHECK(live.reference() == &first);
  first.ended = "time limit";
  CHECK(live.reference() == nullptr);
  first.ended = Trajectory::complete;
  first.law = "convex_relaxation";
  CHECK(live.reference() == nullptr);
}

TEST_CASE("Distances are rms over grains at common frames") {
  Trajectory a, b;
  a.positions = {Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(6)};
  b.positions = {Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(6)};
  b.positions[1] << 3.0, 4.0, 0.0, 0.0, 0.0, 5.0;
  CHECK(distances(a, b) == std::vector<double>{0.0, 5.0});
}

TEST_CASE("A trajectory is called after its solver, its limit and a law that is not Coulomb's") {
  Trajectory t;
  t.solver = "pgs";
  t.law = "coulomb";
  t.tolerance = 1e-4;
  CHECK(t.label() == "pgs 0.0001");
  t.iterations = 50;
  CHECK(t.label() == "pgs 50 iterations");
  t.law = "convex";
  CHECK(t.label() == "pgs (convex) 50 iterations");
}

TEST_CASE("A trajectory comes to its means, its worst and its end") {
  LiveComparison live = hand_made_live();
  struct Expected {
    const char* name;
    double value;
  };
  for (const auto& [name, value] : {Expected{"error_mean", 1.5e-2},  // 1.5e-4 m/s over 1e-2 m/s
                                    {"error_max", 2e-2},
                                    {"missed", 0.5},  // the second of two steps
                                    {"wall_x_end", 2.003e-3},
                                    {"wall_force_mean", 15.0},
                                    {"penetration_max", 2e-6},
                                    {"kinetic_energy_end", 1.0},
                                    {"energy_residual", 0.5},
                                    {"solid_fraction_end", 0.6},
                                    {"iterations_mean", 15.0},
                                    {"solve_ms_per_step", 1.5},
                                    {"ms_per_step", 1.5},
                                    {"distance_end", 3e-6}}) {
    INFO(name);
    CHECK(number_of(name, 1, live) == Approx(value));
    CHECK(std::isnan(number_of(name, 2, live)));  // has no step
  }
  CHECK(number_of("missed", 0, live) == 0.0);
  CHECK(number_of("distance_end", 0, live) == 0.0);
  // Without a driven wall or a reference their columns are empty and their figures missing.
  live.has_driven_wall = false;
  for (Trajectory& t : live.trajectories) t.law = "convex_relaxation";
  for (const char* name : {"wall_x_end", "wall_force_mean", "distance_end"})
    CHECK(std::isnan(number_of(name, 0, live)));
  const auto figures = live_figures(live);
  for (const char* name : {"live_wall", "live_wall_deviation", "live_force", "live_distance"})
    CHECK(find_figure(figures, name) == nullptr);
  CHECK(find_figure(figures, "live_error") != nullptr);
}

TEST_CASE("Tables of rows and of steps have a line for each") {
  const LiveComparison live = hand_made_live();
  const std::string csv = live_csv(live);
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 4);
  CHECK(csv.find("\npgs,coulomb,0.1,0,complete,2,0.015,0.02,0,0.002,15,") != std::string::npos);
  const TemporaryFolder folder;
  write_steps_csv(folder.path() / "steps.csv", live.trajectories[0].steps);
  const std::string steps = read_whole_file(folder.path() / "steps.csv");
  CHECK(std::count(steps.begin(), steps.end(), '\n') == 3);
  CHECK(std::count(steps.begin(), steps.begin() + static_cast<long>(steps.find('\n')), ',') + 1 ==
        static_cast<long>(step_columns().size()));
}

TEST_CASE("Every trajectory with something to show is a line") {
  const auto figures = live_figures(hand_made_live());
  const page::Picture* wall = find_figure(figures, "live_wall");
  REQUIRE(wall);
  const std::vector<Curve>& curves = wall->plot.panels[0].curves;
  REQUIRE(curves.size() == 2);  // the third has no step
  CHECK(curves[0].title == "pgs 0.1");
  CHECK(curves[0].y == std::vector<double>{1.0, 2.0});  // mm
  CHECK(curves[1].ink != curves[0].ink);
  CHECK(curves[1].dash < curves[0].dash);  // has the tighter tolerance
  CHECK(curves[0].opacity == 1.0);
  const page::Picture* cost = find_figure(figures, "live_cost");
  REQUIRE(cost);
  CHECK(cost->plot.panels[0].curves[0].y[1] == Approx(3e-3));  // the sum over steps
  // Distances and deviations are those of the others from the reference.
  for (const char* name : {"live_distance", "live_wall_deviation"}) {
    INFO(name);
    const page::Picture* figure = find_figure(figures, name);
    REQUIRE(figure);
    REQUIRE(figure->plot.panels[0].curves.size() == 1);
    const Curve& curve = figure->plot.panels[0].curves[0];
    CHECK(curve.title == "nncg 0.015");
    for (const double y : curve.y) CHECK(y == Approx(3.0));  // µm
  }
}

TEST_CASE("The page of a closed loop says who was the reference, and what others' words were") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(write_live_page(folder.path(), hand_made_live()), Error);  // there is no manifest
  Manifest("compare --live x", {}, "key").write(folder.path() / "manifest.json");
  write_live_page(folder.path(), hand_made_live());
  const std::string page = read_whole_file(folder.path() / "live.html");
  check_page(without_scripts(page));
  CHECK(page.find("(reference)") != std::string::npos);
  CHECK(page.find("hand &amp; made") != std::string::npos);
  CHECK(page.find("failed: &lt;no words&gt;") != std::string::npos);
  const std::string csv = read_whole_file(folder.path() / "live.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 4);
  CHECK(std::filesystem::exists(folder.path() / "steps-pgs_0_1.csv"));
  if (!gnuplot_version().empty())
    CHECK(page.find("<figure id=\"live_distance\"") != std::string::npos);
}

TEST_CASE("No two of twenty-four backends look alike") {
  for (size_t a = 0; a < 24; ++a)
    for (size_t b = 0; b < a; ++b) {
      const Curve p = backend_curve(a, "p"), q = backend_curve(b, "q");
      CHECK((p.ink != q.ink || p.dash != q.dash || p.width != q.width));
    }
}

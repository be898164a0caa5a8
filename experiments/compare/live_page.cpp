#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <set>
#include <utility>

#include "experiments/compare/compare_page.hpp"
#include "experiments/compare/live.hpp"
#include "experiments/measure/curve_fit.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

/// The statistics of a column of the record; NaN without steps.
Statistics over_steps(const Trajectory& t, double StepRecord::*value) {
  return statistics(record_column(t.steps, value));
}

double last_of(const Trajectory& t, double StepRecord::*value) {
  return t.steps.empty() ? not_known : t.steps.back().*value;
}

/// The last known solid fraction: not every step has one.
double last_solid_fraction(const Trajectory& t, const LiveComparison&) {
  double last = not_known;
  for (const StepRecord& step : t.steps)
    if (std::isfinite(step.solid_fraction)) last = step.solid_fraction;
  return last;
}

/// The share of the steps whose error is above the tolerance.
double missed_share(const Trajectory& t, const LiveComparison& c) {
  if (t.iterations > 0) return not_known;  // it has no tolerance
  const double bound = t.tolerance * c.velocity_scale, count = static_cast<double>(t.steps.size());
  const auto is_missed = [&](const StepRecord& s) { return !(s.error_rms <= bound); };
  return static_cast<double>(std::count_if(t.steps.begin(), t.steps.end(), is_missed)) / count;
}

double mean_step_seconds(const Trajectory& t) {
  double sum = 0.0;
  for (const StepRecord& step : t.steps) sum += step_seconds(step);
  return sum / static_cast<double>(t.steps.size());
}

double last_distance(const Trajectory& t, const LiveComparison& c) {
  const Trajectory* reference = c.reference();
  if (!reference) return not_known;
  const std::vector<double> d = distances(t, *reference);
  return d.empty() ? not_known : d.back();
}

using T = const Trajectory&;
using C = const LiveComparison&;
constexpr LiveNumber shown_numbers[] = {
    {"error_mean", "error, mean", "", 1.0, 3,
     [](T t, C c) { return t.mean_error() / c.velocity_scale; }},
    {"error_max", "worst", "", 1.0, 3,
     [](T t, C c) { return over_steps(t, &StepRecord::error_rms).max / c.velocity_scale; }},
    {"missed", "above tolerance", "%", 100.0, 3, missed_share},
    {"wall_x_end", "wall *x*", "mm", 1e3, 4,
     [](T t, C c) { return c.has_driven_wall ? last_of(t, &StepRecord::wall_x) : not_known; }},
    {"wall_force_mean", "mean *f*~g~", "N", 1.0, 4,
     [](T t, C c) {
       return c.has_driven_wall ? over_steps(t, &StepRecord::wall_force).mean : not_known;
     }},
    {"penetration_max", "overlap", "µm", 1e6, 3,
     [](T t, C) { return over_steps(t, &StepRecord::penetration_max).max; }},
    {"kinetic_energy_end", "kinetic energy", "J", 1.0, 3,
     [](T t, C) { return last_of(t, &StepRecord::kinetic_energy); }},
    {"energy_residual", nullptr, "", 1.0, 3,
     [](T t, C) {
       return over_steps(t, &StepRecord::energy_residual).mean *
              static_cast<double>(t.steps.size());
     }},
    {"solid_fraction_end", "solid fraction", "", 1.0, 4, last_solid_fraction},
    {"iterations_mean", "iterations", "", 1.0, 3,
     [](T t, C) { return over_steps(t, &StepRecord::iterations).mean; }},
    {"ms_per_step", nullptr, "", 1.0, 3, [](T t, C) { return 1e3 * mean_step_seconds(t); }},
    {"solve_ms_per_step", "solve per step", "ms", 1.0, 3,
     [](T t, C) { return 1e3 * over_steps(t, &StepRecord::seconds_solve).mean; }},
    {"distance_end", "distance", "µm", 1e6, 3, last_distance}};

/// The backends of all trajectories, in the order of the trajectories.
std::vector<std::string> backends_of(const LiveComparison& comparison) {
  std::vector<std::string> backends;
  for (const Trajectory& t : comparison.trajectories)
    if (std::ranges::find(backends, t.backend()) == backends.end()) backends.push_back(t.backend());
  return backends;
}

/// In the backend's colour: solid for the tightest limit, with shorter dashes for looser ones.
Curve trajectory_curve(const LiveComparison& comparison, const Trajectory& trajectory) {
  const std::vector<std::string> backends = backends_of(comparison);
  // orders tolerances from the tightest on, then iterations from the most on
  const auto limit_of = [](const Trajectory& t) {
    return t.iterations > 0 ? std::pair(1, -1.0 * t.iterations) : std::pair(0, t.tolerance);
  };
  std::set<std::pair<int, double>> limits;
  for (const Trajectory& t : comparison.trajectories) limits.insert(limit_of(t));
  const auto backend = std::ranges::find(backends, trajectory.backend()) - backends.begin();
  const auto looseness = std::distance(limits.begin(), limits.find(limit_of(trajectory)));
  Curve curve = backend_curve(static_cast<size_t>(backend), trajectory.label());
  curve.dash = static_cast<int>(std::min<std::ptrdiff_t>(looseness, 3));
  curve.width = looseness == 0 ? 2.0 : 1.6;
  return curve;
}

/// Fills in the line of a trajectory. `reference` is the trajectory itself where there is none.
using LiveLine = std::function<void(T t, T reference, Curve& line)>;

LiveLine column(double StepRecord::*value, double factor) {
  return [=](T t, T, Curve& line) {
    for (const StepRecord& s : t.steps)
      if (std::isfinite(s.*value)) line.add(s.time, factor * (s.*value));
  };
}

void line_of_cost(T t, T, Curve& line) {
  double cost = 0.0;
  for (const StepRecord& s : t.steps) line.add(s.time, cost += s.seconds_solve);
}

/// The wall's distance from its place in the reference [µm]: the paths coincide to the eye.
void line_of_deviation(T t, T reference, Curve& line) {
  for (size_t k = 0; k < std::min(t.steps.size(), reference.steps.size()); ++k)
    line.add(t.steps[k].time, 1e6 * std::abs(t.steps[k].wall_x - reference.steps[k].wall_x));
}

void line_of_distance(T t, T reference, Curve& line) {
  const std::vector<double> metres = distances(t, reference);
  for (size_t k = 0; k < metres.size(); ++k) line.add(t.frame_times[k], 1e6 * metres[k]);
}

page::Table numbers_table(const LiveComparison& comparison) {
  page::Table table{.head = {"backend, tolerance", "law", "ended"},
                    .is_number = {false, false, false}};
  for (const LiveNumber& number : shown_numbers)
    if (number.head) table.head.push_back(page::marked(number.head));
  table.is_number.resize(table.head.size(), true);
  for (const Trajectory& t : comparison.trajectories) {
    page::Text label = t.label();
    if (&t == comparison.reference()) label += page::Text(" (reference)", page::strong);
    std::vector<page::Text> line{label, t.law, t.ended};
    for (const LiveNumber& number : shown_numbers)
      if (number.head)
        line.push_back(
            page::quantity(number.factor * number.of(t, comparison), number.unit, number.digits));
    table.rows.push_back(std::move(line));
  }
  return table;
}

/// Error over cost, with a line for each backend; no panel without known values.
std::vector<Panel> accuracy_panels(const LiveComparison& comparison) {
  Panel panel{.x_label = page::marked("cost of a simulated second  (s)"),
              .y_label = "error, relative, mean over steps",
              .log_x = true,
              .log_y = true};
  const std::vector<std::string> backends = backends_of(comparison);
  for (size_t k = 0; k < backends.size(); ++k) {
    std::multiset<std::pair<double, double>> points;
    for (const Trajectory& t : comparison.trajectories)
      if (const double error = t.mean_error() / comparison.velocity_scale;
          t.backend() == backends[k] && t.is_complete() && error > 0.0 && std::isfinite(error))
        points.emplace(mean_step_seconds(t) / comparison.scene.step, error);
    if (points.empty()) continue;
    Curve curve = backend_curve(k, backends[k]);
    curve.mark = Mark::marked_line;
    for (const auto& [cost, error] : points) curve.add(cost, error);
    panel.curves.push_back(std::move(curve));
  }
  return panel.curves.empty() ? std::vector<Panel>() : std::vector{std::move(panel)};
}

}  // namespace

std::span<const LiveNumber> live_numbers() { return shown_numbers; }

std::string live_csv(const LiveComparison& comparison) {
  CsvWriter csv;
  for (const char* name : {"solver", "law", "tolerance", "iterations", "ended", "steps"})
    csv.add(name);
  for (const LiveNumber& number : shown_numbers) csv.add(number.name);
  csv.end_row();
  for (const Trajectory& t : comparison.trajectories) {
    csv.add(t.solver);
    csv.add(t.law);
    csv.add(t.tolerance, 6);
    csv.add(long{t.iterations});
    csv.add(t.ended);
    csv.add(static_cast<long>(t.steps.size()));
    for (const LiveNumber& number : shown_numbers) csv.add(number.of(t, comparison), 9);
    csv.end_row();
  }
  return csv.take();
}

std::vector<page::Picture> live_figures(const LiveComparison& comparison) {
  using R = StepRecord;
  const Trajectory* reference = comparison.reference();
  std::vector<page::Picture> pictures;
  // adds a figure with a line for every trajectory; in a difference the reference has none
  const auto add = [&](const char* name, const char* title, const char* y_label, bool log_y,
                       const LiveLine& line, bool is_difference = false) {
    Panel panel{
        .x_label = page::marked("*t*  (s)"), .y_label = page::marked(y_label), .log_y = log_y};
    for (const Trajectory& t : comparison.trajectories) {
      Curve curve = trajectory_curve(comparison, t);
      if (!is_difference || &t != reference) line(t, reference ? *reference : t, curve);
      const auto is_drawn = [&](double v) { return std::isfinite(v) && (!log_y || v > 0.0); };
      if (std::ranges::none_of(curve.y, is_drawn)) continue;
      thin_out(curve.x, curve.y, 1500);
      panel.curves.push_back(std::move(curve));
    }
    Figure figure{.name = name, .title = title};
    // the legend grows with the curves, the axes keep their size
    figure.height = 440 + 22 * static_cast<int>(2 * panel.curves.size() / 3);
    if (!panel.curves.empty()) figure.panels = {std::move(panel)};
    pictures.push_back({figure, {page::words(std::string(name) + ".caption")}});
  };
  const bool has_wall = comparison.has_driven_wall;
  if (has_wall)
    add("live_wall", "Wall trajectory", "wall *x*  (mm)", false, column(&R::wall_x, 1e3));
  if (has_wall && reference)
    add("live_wall_deviation", "Deviation of the wall", "|*x* − *x*~ref~|  (µm)", true,
        line_of_deviation, true);
  if (has_wall)
    add("live_force", "Force on the wall", "*f*~g~  (N)", false, column(&R::wall_force, 1.0));
  if (reference)
    add("live_distance", "Distance from the reference", "rms distance  (µm)", true,
        line_of_distance, true);
  add("live_error", "Error of the contact law", "error, relative", true,
      column(&R::error_rms, 1.0 / comparison.velocity_scale));
  add("live_penetration", "Deepest overlap", "deepest overlap  (µm)", true,
      column(&R::penetration_max, 1e6));
  add("live_energy", "Kinetic energy", "kinetic energy  (J)", true,
      column(&R::kinetic_energy, 1.0));
  add("live_solid_fraction", "Solid fraction", "solid fraction", false,
      column(&R::solid_fraction, 1.0));
  add("live_cost", "Cost", "wall clock of the solver  (s)", false, line_of_cost);
  pictures.push_back({{.name = "live_accuracy",
                       .title = "Error against the cost of a simulated second",
                       .panels = accuracy_panels(comparison)},
                      {page::words("live_accuracy.caption")}});
  return pictures;
}

void write_live_page(const std::filesystem::path& folder, const LiveComparison& comparison) {
  for (const Trajectory& t : comparison.trajectories)  // "steps-pgs_0_0001.csv"
    write_steps_csv(folder / (made_plain("steps-" + t.label(), "-") + ".csv"), t.steps);
  write_whole_file(folder / "live.csv", live_csv(comparison));
  page::Page page{.title = "One start, several solvers: " + comparison.scene.name};
  page.add(
      {"table",
       "Side by side",
       {page::words("live.table", {{"scale", page::quantity(comparison.velocity_scale, "m/s")}}),
        numbers_table(comparison),
        page::Listing{comparison.command + " --solvers SOLVER --output results/again \\\n" +
                          "  --tolerances TOLERANCE    # or none --iterations COUNT",
                      "Makes one of them again"}}});
  page::Section figures{"figures", "Figures"};
  figures.add(live_figures(comparison));
  page.add(figures);
  page.answers = {.is_enabled = true, .has_charts = true};
  write_with_origin(page, folder / "live.html");
}

Curve backend_curve(size_t k, const std::string& title) {
  constexpr Ink inks[] = {Ink::blue,   Ink::vermilion, Ink::green, Ink::orange,
                          Ink::purple, Ink::sky,       Ink::black, Ink::grey};
  constexpr size_t count = std::size(inks);
  Curve curve;
  curve.title = title;
  curve.ink = inks[k % count];
  curve.dash = static_cast<int>(k / count % 2);
  curve.width = k < 2 * count ? 1.8 : 0.9;
  return curve;
}

}  // namespace ballast

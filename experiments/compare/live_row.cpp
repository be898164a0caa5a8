#include "experiments/compare/live_row.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/measure/curve_fit.hpp"
#include "platform/csv.hpp"

namespace ballast {
namespace {

LiveRow row_of(const Trajectory& t, const LiveComparison& comparison) {
  LiveRow row{&t};
  if (t.steps.empty()) return row;
  const auto column = [&](double StepRecord::*value) {
    return statistics(record_column(t.steps, value));
  };
  const Statistics error = column(&StepRecord::error_rms);
  row.error_mean = error.mean / comparison.velocity_scale;
  row.error_max = error.max / comparison.velocity_scale;
  const double bound = t.tolerance * comparison.velocity_scale;
  row.missed = static_cast<double>(
                   std::count_if(t.steps.begin(), t.steps.end(),
                                 [&](const StepRecord& s) { return !(s.error_rms <= bound); })) /
               static_cast<double>(t.steps.size());
  if (comparison.has_driven_wall) {
    row.wall_x = t.steps.back().wall_x;
    row.force_mean = column(&StepRecord::wall_force).mean;
  }
  row.penetration_max = column(&StepRecord::penetration_max).max;
  row.kinetic_energy = t.steps.back().kinetic_energy;
  double residual = 0.0, solve = 0.0, all = 0.0;
  for (const StepRecord& s : t.steps) {
    residual += s.energy_residual;
    solve += s.seconds_solve;
    all += step_seconds(s);
    if (std::isfinite(s.solid_fraction)) row.solid_fraction = s.solid_fraction;
  }
  row.energy_residual = residual;
  row.iterations = column(&StepRecord::iterations).mean;
  row.solve_ms_per_step = 1e3 * solve / static_cast<double>(t.steps.size());
  row.ms_per_step = 1e3 * all / static_cast<double>(t.steps.size());
  if (comparison.reference >= 0) {
    const std::vector<double> d =
        distances(t, comparison.trajectories[static_cast<size_t>(comparison.reference)]);
    if (!d.empty()) row.distance = d.back();
  }
  return row;
}

}  // namespace

std::vector<LiveRow> live_rows(const LiveComparison& comparison) {
  std::vector<LiveRow> rows;
  for (const Trajectory& t : comparison.trajectories) rows.push_back(row_of(t, comparison));
  return rows;
}

std::string live_csv(const std::vector<LiveRow>& rows) {
  struct Column {
    const char* name;
    double LiveRow::*value;
    int digits;
  };
  constexpr Column columns[] = {{"error_mean", &LiveRow::error_mean, 6},
                                {"error_max", &LiveRow::error_max, 6},
                                {"missed", &LiveRow::missed, 6},
                                {"wall_x_end", &LiveRow::wall_x, 9},
                                {"wall_force_mean", &LiveRow::force_mean, 9},
                                {"penetration_max", &LiveRow::penetration_max, 6},
                                {"kinetic_energy_end", &LiveRow::kinetic_energy, 9},
                                {"energy_residual", &LiveRow::energy_residual, 6},
                                {"solid_fraction_end", &LiveRow::solid_fraction, 9},
                                {"iterations_mean", &LiveRow::iterations, 6},
                                {"ms_per_step", &LiveRow::ms_per_step, 6},
                                {"solve_ms_per_step", &LiveRow::solve_ms_per_step, 6},
                                {"distance_end", &LiveRow::distance, 6}};
  CsvWriter csv;
  for (const char* name : {"solver", "law", "tolerance", "ended", "steps"}) csv.add(name);
  for (const Column& column : columns) csv.add(column.name);
  csv.end_row();
  for (const LiveRow& row : rows) {
    const Trajectory& trajectory = *row.trajectory;
    csv.add(trajectory.solver);
    csv.add(trajectory.law);
    csv.add(trajectory.tolerance, 6);
    csv.add(trajectory.ended);
    csv.add(static_cast<long>(trajectory.steps.size()));
    for (const Column& column : columns) csv.add(row.*column.value, column.digits);
    csv.end_row();
  }
  return csv.take();
}

std::string steps_csv(const Trajectory& t) {
  CsvWriter csv;
  for (const StepColumn& column : step_columns()) csv.add(column.name);
  csv.end_row();
  for (const StepRecord& step : t.steps) {
    for (const StepColumn& column : step_columns()) csv.add(step.*column.value, 17);
    csv.end_row();
  }
  return csv.take();
}

}  // namespace ballast

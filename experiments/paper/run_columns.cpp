// The table of runs.csv: names, units and meanings, and where each number stands.

#include <algorithm>
#include <cmath>

#include "experiments/paper/run_observables.hpp"
#include "platform/csv.hpp"

namespace ballast {
namespace {

using Run = const RunObservables&;

const RunColumn columns[] = {
    // what was set
    {"seed", "1", "of the grains: the sample", [](auto& r) { return &r.setup.seed; }},
    {"frequency", "Hz", "nu", [](auto& r) { return &r.seen.facts.frequency; }},
    {"force_over_weight", "1", "f_max/(m g)", [](Run r) { return r.force_over_weight(); }},
    {"gravity", "m/s^2", "g", [](auto& r) { return &r.seen.facts.gravity; }},
    {"wall_mass_over_grains", "1", "m_w/m", [](Run r) { return r.wall_mass_over_grains(); }},
    {"grain_mass", "kg", "m, all grains", [](auto& r) { return &r.seen.facts.grain_mass; }},
    {"grains", "1", "number", [](auto& r) { return &r.setup.grains; }},
    {"length", "m", "L of the box", [](auto& r) { return &r.setup.length; }},
    {"width", "m", "W of the box", [](auto& r) { return &r.setup.width; }},
    {"height", "m", "H, top of the packing", [](auto& r) { return &r.setup.height; }},
    {"aspect", "1", "L/H", [](Run r) { return r.aspect(); }},
    {"largest_size", "m", "largest distance centre - vertex of a grain",
     [](auto& r) { return &r.setup.largest_size; }},
    {"lid_raise", "m", "gap under the lid", [](auto& r) { return &r.setup.lid_raise; }},
    {"friction", "1", "mu of the drive", [](auto& r) { return &r.setup.friction; }},
    {"deposit_friction", "1", "mu of the deposit",
     [](auto& r) { return &r.setup.deposit_friction; }},
    {"lid_pressure", "1", "on the lid while depositing, grain weights; 0: placed",
     [](auto& r) { return &r.setup.lid_pressure; }},
    {"start_noise", "m", "of the grains' places at the start",
     [](auto& r) { return &r.setup.start_noise; }},
    {"step", "s", "h", [](auto& r) { return &r.seen.facts.step; }},
    {"iterations_most", "1", "allowed to the solver per step",
     [](auto& r) { return &r.setup.iterations_most; }},
    {"tolerance", "g h", "of the solver", [](auto& r) { return &r.setup.tolerance; }},
    // what the solver did
    {"iterations", "1", "mean per step", [](auto& r) { return &r.iterations.mean; }},
    {"error", "g h", "rms natural map, mean over the steps that count",
     [](auto& r) { return &r.seen.error_mean; }},
    {"penetration", "m", "deepest overlap", [](auto& r) { return &r.seen.penetration_max; }},
    {"seconds_per_step", "s", "wall clock, median",
     [](auto& r) { return &r.seen.seconds_per_step; }},
    // the motion
    {"periods", "1", "that count", [](auto& r) { return &r.seen.periods; }},
    {"rise", "m", "Delta x_max", [](auto& r) { return &r.seen.rise; }},
    {"speed_in", "m/s", "v_max", [](auto& r) { return &r.seen.speed_in; }},
    {"speed_out", "m/s", "largest outward velocity", [](auto& r) { return &r.speed_out; }},
    {"net", "m", "contraction per period", [](auto& r) { return &r.seen.net; }},
    {"eq3", "m", "X, right side of Eq. 3", [](Run r) { return r.x_scale(); }},
    {"prefactor", "1", "C = Delta x_max / X", [](Run r) { return r.prefactor(); }},
    {"first_contraction", "m", "least x of the first period, at least 0.3 s",
     [](auto& r) { return &r.seen.first_contraction; }},
    {"first_time90", "s", "t90, when 90 % of it is reached",
     [](auto& r) { return &r.seen.first_time90; }},
    {"dissipated", "J", "per period", [](auto& r) { return &r.seen.dissipated; }},
    // the forces
    {"law_by_place_amplitude", "N", "A of f_g = A exp(kappa xi), active",
     [](auto& r) { return &r.law.by_place.amplitude; }},
    {"law_by_place_rate", "1/m", "kappa", [](auto& r) { return &r.law.by_place.rate; }},
    {"law_by_place_r2", "1", "R^2 of it", [](auto& r) { return &r.law.by_place.r2; }},
    {"law_by_load_offset", "N", "a of f_g = a + w f, the same samples",
     [](auto& r) { return &r.law.by_load.offset; }},
    {"law_by_load_slope", "1", "w", [](auto& r) { return &r.law.by_load.slope; }},
    {"law_by_load_r2", "1", "R^2 of it", [](auto& r) { return &r.law.by_load.r2; }},
    {"passive_offset", "N", "f_g = offset + slope xi, wall moving in",
     [](auto& r) { return &r.law.passive.offset; }},
    {"passive_slope", "N/m", "", [](auto& r) { return &r.law.passive.slope; }},
    {"passive_r2", "1", "", [](auto& r) { return &r.law.passive.r2; }},
    {"push", "N", "F = a/(1 - w)", [](auto& r) { return &r.law.push; }},
    {"push_over_weight", "1", "F/(m g)",
     [](Run r) { return r.law.push / (r.seen.facts.grain_mass * r.seen.facts.gravity); }},
    {"carried_mass", "kg", "M = m_w w/(1 - w)", [](auto& r) { return &r.law.carried_mass; }},
    {"prefactor_theory", "1", "(9/4 pi^2) (F/(m g))^2 (m + m_w)/(m_w + M)",
     [](auto& r) { return &r.law.prefactor; }},
    // the jam
    {"jam_share", "1", "of the time", [](auto& r) { return &r.jam.share; }},
    {"jam_force", "1", "mean |f_g - f|/f_max", [](auto& r) { return &r.jam.force_mean; }},
    {"jam_force_smooth", "1", "the same, f_g smoothed",
     [](auto& r) { return &r.jam.force_smooth; }},
    {"jam_speed", "m/s", "mean |v|", [](auto& r) { return &r.jam.speed_mean; }},
    {"jam_speed_max", "m/s", "largest |v|", [](auto& r) { return &r.jam.speed_max; }},
    {"jam_compliance", "m/N", "1/k of v = creep - (df/dt)/k",
     [](auto& r) { return &r.jam.compliance; }},
    {"jam_compliance_error", "m/N", "its standard error",
     [](auto& r) { return &r.jam.compliance_error; }},
    {"jam_creep", "m/s", "outward", [](auto& r) { return &r.jam.creep; }},
    // the packing
    {"density_before", "1", "rho before the drive", [](auto& r) { return &r.seen.solid_initial; }},
    {"density_reference", "1", "rho_0, at 0.2 s", [](auto& r) { return &r.seen.solid_reference; }},
    {"gain", "1", "Delta rho_1 per period", [](auto& r) { return &r.seen.gain; }},
    {"gain_extension", "1", "part of it while the wall moves out",
     [](auto& r) { return &r.gains.extension; }},
    {"gain_contraction", "1", "from the stroke's peak to the period's end",
     [](auto& r) { return &r.gains.contraction; }},
    {"rate", "1/s", "Eq. 4, from 0.2 s to the end", [](auto& r) { return &r.seen.rate; }},
    {"rate_common", "1/s", "Eq. 4, within 0.4 to 1 s", [](auto& r) { return &r.seen.rate_common; }},
    {"density0_with_walls", "1", "t = 0, from wall to wall",
     [](auto& r) { return &r.before.with_walls; }},
    {"density0_inner", "1", "t = 0, a margin from all faces",
     [](auto& r) { return &r.before.inner; }},
    {"density0_by_centres", "1", "t = 0, grains by their centres",
     [](auto& r) { return &r.before.by_centres; }},
    {"density0_whole_grains", "1", "t = 0, grains wholly inside",
     [](auto& r) { return &r.before.whole_grains; }},
    {"density0_without_top", "1", "t = 0, without the top tenth",
     [](auto& r) { return &r.before.without_top; }},
    {"density2_as_run", "1", "t = 0.2 s, the run's volume",
     [](auto& r) { return &r.after.as_run; }},
    {"density2_with_walls", "1", "t = 0.2 s", [](auto& r) { return &r.after.with_walls; }},
    {"density2_inner", "1", "t = 0.2 s", [](auto& r) { return &r.after.inner; }},
    {"density2_by_centres", "1", "t = 0.2 s", [](auto& r) { return &r.after.by_centres; }},
    {"density2_whole_grains", "1", "t = 0.2 s", [](auto& r) { return &r.after.whole_grains; }},
    {"density2_without_top", "1", "t = 0.2 s", [](auto& r) { return &r.after.without_top; }},
    {"layer1_extension", "1", "lowest quarter, as gain_extension",
     [](auto& r) { return &r.layers[0].extension; }},
    {"layer1_contraction", "1", "", [](auto& r) { return &r.layers[0].contraction; }},
    {"layer2_extension", "1", "", [](auto& r) { return &r.layers[1].extension; }},
    {"layer2_contraction", "1", "", [](auto& r) { return &r.layers[1].contraction; }},
    {"layer3_extension", "1", "", [](auto& r) { return &r.layers[2].extension; }},
    {"layer3_contraction", "1", "", [](auto& r) { return &r.layers[2].contraction; }},
    {"layer4_extension", "1", "highest quarter", [](auto& r) { return &r.layers[3].extension; }},
    {"layer4_contraction", "1", "", [](auto& r) { return &r.layers[3].contraction; }},
    {"roll_top", "m", "mean displacement of a period, clockwise, along the top of the middle half",
     [](auto& r) { return &r.roll.along[0]; }},
    {"roll_right", "m", "", [](auto& r) { return &r.roll.along[1]; }},
    {"roll_bottom", "m", "", [](auto& r) { return &r.roll.along[2]; }},
    {"roll_left", "m", "", [](auto& r) { return &r.roll.along[3]; }},
    {"circulation", "m^2", "around that rectangle, per period",
     [](auto& r) { return &r.roll.circulation; }},
};

constexpr const char* text_columns[] = {"name", "stage", "key", "record", "solver"};

/// What the columns of a file are after its texts, by its first line.
std::vector<const RunColumn*> columns_of(const CsvReader& reader) {
  const auto names = reader.cells();
  if (!std::ranges::equal(names.first(std::min(names.size(), std::size(text_columns))),
                          text_columns))
    reader.fail("not a report's runs.csv: it begins with name,stage,key,record,solver");
  std::vector<const RunColumn*> found;
  for (const std::string_view name : names.subspan(std::size(text_columns))) {
    const auto* column = std::ranges::find(columns, name, &RunColumn::name);
    if (column == std::end(columns))
      reader.fail('\'' + std::string(name) + "' is no column of runs.csv");
    found.push_back(column);
  }
  return found;
}

/// What stands in the row; what follows from its numbers, where a mass or a force is asked for.
RunObservables row_of(const CsvReader& reader, const std::vector<const RunColumn*>& found) {
  constexpr size_t texts = std::size(text_columns);
  reader.require_cells(texts + found.size());
  const auto cells = reader.cells();
  RunObservables run;
  std::string* const places[texts] = {&run.name, &run.stage, &run.key, &run.record,
                                      &run.setup.solver};
  for (size_t k = 0; k < texts; ++k) *places[k] = cells[k];
  double force = not_known, wall = not_known;  // over the grains' weight and mass
  for (size_t k = 0; k < found.size(); ++k) {
    if (cells[texts + k].empty()) continue;
    const double value = reader.number(texts + k, found[k]->name);
    const std::string_view name = found[k]->name;
    if (name == "force_over_weight") force = value;
    if (name == "wall_mass_over_grains") wall = value;
    if (found[k]->set) found[k]->set(run, value);
  }
  Observation& seen = run.seen;
  seen.facts.f_max = force * seen.facts.grain_mass * seen.facts.gravity;
  seen.facts.wall_mass = wall * seen.facts.grain_mass;
  seen.mean_grain_mass = seen.facts.grain_mass / run.setup.grains;
  seen.relative_gain = seen.gain / seen.solid_reference;
  return run;
}

}  // namespace

std::span<const RunColumn> run_columns() { return columns; }

std::string runs_csv(std::span<const RunObservables> runs) {
  CsvWriter csv;
  std::vector<std::string> names(std::begin(text_columns), std::end(text_columns)),
      units(names.size(), "text");
  for (const RunColumn& column : run_columns()) {
    names.emplace_back(column.name);
    units.emplace_back(column.unit);
  }
  csv.add_row(names);
  csv.add_row(units);
  for (const RunObservables& run : runs) {
    for (const std::string& text : {run.name, run.stage, run.key, run.record, run.setup.solver})
      csv.add(text);
    // what is not known is an empty cell
    for (const RunColumn& column : run_columns()) {
      const double value = column.value(run);
      if (std::isfinite(value))
        csv.add(value, 9);
      else
        csv.add("");
    }
    csv.end_row();
  }
  return csv.take();
}

std::vector<RunObservables> read_runs_csv(const std::filesystem::path& file) {
  CsvReader reader(file);
  if (!reader.next()) reader.fail("empty");
  const std::vector<const RunColumn*> found = columns_of(reader);
  std::vector<RunObservables> runs;
  if (!reader.next()) reader.fail("the line of units is missing");
  while (reader.next()) runs.push_back(row_of(reader, found));
  return runs;
}

std::string run_columns_csv() {
  CsvWriter csv;
  csv.add_row(std::vector<std::string>{"column", "unit", "description"});
  for (const RunColumn& column : run_columns())
    csv.add_row(std::vector<std::string>{column.name, column.unit, column.description});
  return csv.take();
}

}  // namespace ballast

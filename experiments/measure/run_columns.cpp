#include "experiments/measure/run_columns.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "platform/csv.hpp"

namespace ballast {
namespace {

using Run = const RunSummary&;

const RunColumn columns[] = {
    // what was set
    {"seed", "1", "of the grains: the sample", [](auto& r) { return &r.facts.seed; }},
    {"frequency", "Hz", "nu", [](auto& r) { return &r.facts.frequency; }},
    {"force_over_weight", "1", "f_max/(m g)",
     [](Run r) { return r.facts.f_max / (r.facts.grain_mass * r.facts.gravity); }},
    {"gravity", "m/s^2", "g", [](auto& r) { return &r.facts.gravity; }},
    {"wall_mass_over_grains", "1", "m_w/m",
     [](Run r) { return r.facts.wall_mass / r.facts.grain_mass; }},
    {"grain_mass", "kg", "m, all grains", [](auto& r) { return &r.facts.grain_mass; }},
    {"grains", "1", "number", [](auto& r) { return &r.facts.grains; }},
    {"length", "m", "L of the box", [](auto& r) { return &r.facts.length; }},
    {"height", "m", "H, top of the packing", [](auto& r) { return &r.facts.height; }},
    {"aspect", "1", "L/H", [](Run r) { return r.facts.length / r.facts.height; }},
    {"largest_size", "m", "largest distance centre - vertex of a grain",
     [](auto& r) { return &r.facts.largest_size; }},
    {"lid_raise", "m", "gap under the lid", [](auto& r) { return &r.facts.lid_raise; }},
    {"friction", "1", "mu of the drive", [](auto& r) { return &r.facts.friction; }},
    {"deposit_friction", "1", "mu of the deposit",
     [](auto& r) { return &r.facts.deposit_friction; }},
    {"lid_pressure", "1", "on the lid while depositing, grain weights; 0: placed",
     [](auto& r) { return &r.facts.lid_pressure; }},
    {"step", "s", "h", [](auto& r) { return &r.facts.step; }},
    {"iterations_most", "1", "allowed to the solver per step",
     [](auto& r) { return &r.facts.iterations_most; }},
    {"tolerance", "g h", "of the solver", [](auto& r) { return &r.facts.tolerance; }},
    // what the solver did
    {"iterations", "1", "mean per step", [](auto& r) { return &r.iterations.mean; }},
    {"error", "g h", "rms natural map, mean over the steps that count",
     [](auto& r) { return &r.error_counted; }},
    {"penetration", "m", "deepest overlap", [](auto& r) { return &r.penetration_max; }},
    // the motion
    {"periods", "1", "that count", [](auto& r) { return &r.periods; }},
    {"rise", "m", "Delta x_max", [](auto& r) { return &r.rise.mean; }},
    {"speed_in", "m/s", "v_max", [](auto& r) { return &r.speed_in.mean; }},
    {"net", "m", "contraction per period", [](auto& r) { return &r.net_contraction; }},
    {"eq3", "m", "X, right side of Eq. 3", [](Run r) { return eq3_displacement(r.facts); }},
    {"prefactor", "1", "C = Delta x_max / X", [](auto& r) { return &r.prefactor; }},
    {"first_contraction", "m", "least x of the first period, at least 0.3 s",
     [](auto& r) { return &r.contraction.size; }},
    {"first_time90", "s", "t90, when 90 % of it is reached",
     [](auto& r) { return &r.contraction.time90; }},
    // the forces
    {"push", "N", "F = a/(1 - w)", [](auto& r) { return &r.law.push; }},
    {"push_over_weight", "1", "F/(m g)",
     [](Run r) { return r.law.push / (r.facts.grain_mass * r.facts.gravity); }},
    {"carried_mass", "kg", "M = m_w w/(1 - w)", [](auto& r) { return &r.law.carried_mass; }},
    {"prefactor_theory", "1", "(9/4 pi^2) (F/(m g))^2 (m + m_w)/(m_w + M)",
     [](auto& r) { return &r.law.prefactor; }},
    // the jam
    {"jam_share", "1", "of the time", [](auto& r) { return &r.jammed.share; }},
    {"jam_force", "1", "mean |f_g - f|/f_max", [](auto& r) { return &r.jammed.force_mean; }},
    {"jam_speed", "m/s", "mean |v|", [](auto& r) { return &r.jammed.speed_mean; }},
    // the packing
    {"density_before", "1", "rho before the drive", [](auto& r) { return &r.compaction.initial; }},
    {"density_reference", "1", "rho_0, at 0.2 s", [](auto& r) { return &r.compaction.reference; }},
    {"gain", "1", "Delta rho_1 per period", [](auto& r) { return &r.compaction.gain; }},
    {"rate", "1/s", "Eq. 4, from 0.2 s to the end", [](auto& r) { return &r.compaction.rate; }},
    {"rate_common", "1/s", "Eq. 4, within 0.4 to 1 s",
     [](auto& r) { return &r.compaction.rate_common; }},
    {"roll_top", "m", "mean displacement of a period, clockwise, along the top of the middle half",
     [](auto& r) { return &r.roll.along[0]; }},
    {"roll_right", "m", "", [](auto& r) { return &r.roll.along[1]; }},
    {"roll_bottom", "m", "", [](auto& r) { return &r.roll.along[2]; }},
    {"roll_left", "m", "", [](auto& r) { return &r.roll.along[3]; }},
    {"circulation", "m^2", "around that rectangle, per period",
     [](auto& r) { return &r.roll.circulation; }},
};

constexpr const char* text_columns[] = {"name", "stage", "key", "record", "solver"};

/// What the columns of a file are after its texts, by its first line; null: not known here.
std::vector<const RunColumn*> columns_of(const CsvReader& reader) {
  const auto names = reader.cells();
  if (!std::ranges::equal(names.first(std::min(names.size(), std::size(text_columns))),
                          text_columns))
    reader.fail("not a report's runs.csv: it begins with name,stage,key,record,solver");
  std::vector<const RunColumn*> found;
  for (const std::string_view name : names.subspan(std::size(text_columns))) {
    const auto* column = std::ranges::find(columns, name, &RunColumn::name);
    found.push_back(column == std::end(columns) ? nullptr : column);
  }
  return found;
}

/// What stands in the row; what follows from its numbers, where a mass or a force is asked for.
RunRow row_of(const CsvReader& reader, const std::vector<const RunColumn*>& found) {
  constexpr size_t texts = std::size(text_columns);
  reader.require_cells(texts + found.size());
  const auto cells = reader.cells();
  RunRow row;
  RunSummary& run = row.run;
  std::string* const places[texts] = {&row.name, &row.stage, &row.key, &row.record,
                                      &run.facts.solver};
  for (size_t k = 0; k < texts; ++k) *places[k] = cells[k];
  double force = not_known, wall = not_known;  // over the grains' weight and mass
  for (size_t k = 0; k < found.size(); ++k) {
    if (!found[k] || cells[texts + k].empty()) continue;
    const double value = reader.number(texts + k, found[k]->name);
    const std::string_view name = found[k]->name;
    if (name == "force_over_weight") force = value;
    if (name == "wall_mass_over_grains") wall = value;
    if (found[k]->set) found[k]->set(run, value);
  }
  run.facts.f_max = force * run.facts.grain_mass * run.facts.gravity;
  run.facts.wall_mass = wall * run.facts.grain_mass;
  run.compaction.relative_gain = run.compaction.gain / run.compaction.reference;
  return row;
}

}  // namespace

std::span<const RunColumn> run_columns() { return columns; }

std::string runs_csv(std::span<const RunRow> rows) {
  CsvWriter csv;
  std::vector<std::string> names(std::begin(text_columns), std::end(text_columns)),
      units(names.size(), "text");
  for (const RunColumn& column : columns) {
    names.emplace_back(column.name);
    units.emplace_back(column.unit);
  }
  csv.add_row(names);
  csv.add_row(units);
  for (const RunRow& row : rows) {
    for (const std::string& text : {row.name, row.stage, row.key, row.record, row.run.facts.solver})
      csv.add(text);
    // what is not known is an empty cell
    for (const RunColumn& column : columns) {
      const double value = column.value(row.run);
      if (std::isfinite(value))
        csv.add(value, 9);
      else
        csv.add("");
    }
    csv.end_row();
  }
  return csv.take();
}

std::vector<RunRow> read_runs_csv(const std::filesystem::path& file) {
  CsvReader reader(file);
  if (!reader.next()) reader.fail("empty");
  const std::vector<const RunColumn*> found = columns_of(reader);
  std::vector<RunRow> rows;
  if (!reader.next()) reader.fail("the line of units is missing");
  while (reader.next()) rows.push_back(row_of(reader, found));
  return rows;
}

std::string run_columns_csv() {
  CsvWriter csv;
  csv.add_row(std::vector<std::string>{"column", "unit", "description"});
  for (const RunColumn& column : columns)
    csv.add_row(std::vector<std::string>{column.name, column.unit, column.meaning});
  return csv.take();
}

std::string record_hash(std::span<const StepRecord> steps) {
  std::uint64_t hash = fnv1a("");
  for (const StepRecord& step : steps)
    for (const StepColumn& column : step_columns()) {
      if (column.phase) continue;
      const auto bits = std::bit_cast<std::array<char, sizeof(double)>>(step.*column.value);
      hash = fnv1a({bits.data(), bits.size()}, hash);
    }
  return hash_text(hash);
}

}  // namespace ballast

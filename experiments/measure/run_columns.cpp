#include "experiments/measure/run_columns.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "platform/csv.hpp"

namespace ballast {
namespace {

using Run = const RunSummary&;

const RunColumn columns[] = {
    // what was set
    {"seed", "1", "of the grains: the sample", [](Run r) { return 1.0 * r.facts.seed; }},
    {"frequency", "Hz", "nu", [](Run r) { return r.facts.frequency; }},
    {"force_over_weight", "1", "f_max/(m g)",
     [](Run r) { return r.facts.f_max / (r.facts.grain_mass * r.facts.gravity); }},
    {"gravity", "m/s^2", "g", [](Run r) { return r.facts.gravity; }},
    {"wall_mass_over_grains", "1", "m_w/m",
     [](Run r) { return r.facts.wall_mass / r.facts.grain_mass; }},
    {"grain_mass", "kg", "m, all grains", [](Run r) { return r.facts.grain_mass; }},
    {"grains", "1", "number", [](Run r) { return r.facts.grains; }},
    {"length", "m", "L of the box", [](Run r) { return r.facts.length; }},
    {"height", "m", "H, top of the packing", [](Run r) { return r.facts.height; }},
    {"aspect", "1", "L/H", [](Run r) { return r.facts.length / r.facts.height; }},
    {"largest_size", "m", "largest distance centre - vertex of a grain",
     [](Run r) { return r.facts.largest_size; }},
    {"lid_raise", "m", "gap under the lid", [](Run r) { return r.facts.lid_raise; }},
    {"friction", "1", "mu of the drive", [](Run r) { return r.facts.friction; }},
    {"deposit_friction", "1", "mu of the deposit", [](Run r) { return r.facts.deposit_friction; }},
    {"lid_pressure", "1", "on the lid while depositing, grain weights; 0: placed",
     [](Run r) { return r.facts.lid_pressure; }},
    {"step", "s", "h", [](Run r) { return r.facts.step; }},
    {"iterations_most", "1", "allowed to the solver per step",
     [](Run r) { return r.facts.iterations_most; }},
    {"tolerance", "g h", "of the solver", [](Run r) { return r.facts.tolerance; }},
    // what the solver did
    {"iterations", "1", "mean per step", [](Run r) { return r.iterations.mean; }},
    {"error", "g h", "rms natural map, mean over the steps that count",
     [](Run r) { return r.error_counted; }},
    {"penetration", "m", "deepest overlap", [](Run r) { return r.penetration_max; }},
    // the motion
    {"periods", "1", "that count",
     [](Run r) { return static_cast<double>(r.wall.periods.size()); }},
    {"rise", "m", "Delta x_max", [](Run r) { return r.rise.mean; }},
    {"speed_in", "m/s", "v_max", [](Run r) { return r.speed_in.mean; }},
    {"net", "m", "contraction per period", [](Run r) { return -r.net.mean; }},
    {"eq3", "m", "X, right side of Eq. 3", [](Run r) { return eq3_displacement(r.facts); }},
    {"prefactor", "1", "C = Delta x_max / X", [](Run r) { return r.prefactor; }},
    {"first_contraction", "m", "least x of the first period, at least 0.3 s",
     [](Run r) { return r.contraction.size; }},
    {"first_time90", "s", "t90, when 90 % of it is reached",
     [](Run r) { return r.contraction.time90; }},
    // the forces
    {"push", "N", "F = a/(1 - w)", [](Run r) { return r.law.push; }},
    {"push_over_weight", "1", "F/(m g)",
     [](Run r) { return r.law.push / (r.facts.grain_mass * r.facts.gravity); }},
    {"carried_mass", "kg", "M = m_w w/(1 - w)", [](Run r) { return r.law.carried_mass; }},
    {"prefactor_theory", "1", "(9/4 pi^2) (F/(m g))^2 (m + m_w)/(m_w + M)",
     [](Run r) { return r.law.prefactor; }},
    // the jam
    {"jam_share", "1", "of the time", [](Run r) { return r.jammed.share; }},
    {"jam_force", "1", "mean |f_g - f|/f_max", [](Run r) { return r.jammed.force_mean; }},
    {"jam_speed", "m/s", "mean |v|", [](Run r) { return r.jammed.speed_mean; }},
    // the packing
    {"density_before", "1", "rho before the drive", [](Run r) { return r.compaction.initial; }},
    {"density_reference", "1", "rho_0, at 0.2 s", [](Run r) { return r.compaction.reference; }},
    {"gain", "1", "Delta rho_1 per period", [](Run r) { return r.compaction.gain; }},
    {"rate", "1/s", "Eq. 4, from 0.2 s to the end", [](Run r) { return r.compaction.rate; }},
    {"rate_common", "1/s", "Eq. 4, within 0.4 to 1 s",
     [](Run r) { return r.compaction.rate_common; }},
    {"roll_top", "m", "mean displacement of a period, clockwise, along the top of the middle half",
     [](Run r) { return r.roll.along[0]; }},
    {"roll_right", "m", "", [](Run r) { return r.roll.along[1]; }},
    {"roll_bottom", "m", "", [](Run r) { return r.roll.along[2]; }},
    {"roll_left", "m", "", [](Run r) { return r.roll.along[3]; }},
    {"circulation", "m^2", "around that rectangle, per period",
     [](Run r) { return r.roll.circulation; }},
};

/// What a table begins with.
struct TextColumn {
  const char* name;
  std::string RunRow::*text;
};
constexpr TextColumn text_columns[] = {{"name", &RunRow::name},
                                       {"stage", &RunRow::stage},
                                       {"key", &RunRow::key},
                                       {"record", &RunRow::record},
                                       {"solver", &RunRow::solver}};
constexpr size_t texts = std::size(text_columns);

/// What the columns of a file are after its texts, by its first line; null: not known here.
std::vector<const RunColumn*> columns_of(const CsvReader& reader) {
  const auto names = reader.cells();
  if (!std::ranges::equal(names.first(std::min(names.size(), texts)), text_columns, {}, {},
                          &TextColumn::name))
    reader.fail("not a report's runs.csv: it begins with name,stage,key,record,solver");
  std::vector<const RunColumn*> found;
  for (const std::string_view name : names.subspan(texts)) {
    const auto* column = std::ranges::find(columns, name, &RunColumn::name);
    found.push_back(column == std::end(columns) ? nullptr : column);
  }
  return found;
}

RunRow row_of(const CsvReader& reader, const std::vector<const RunColumn*>& found) {
  reader.require_cells(texts + found.size());
  const auto cells = reader.cells();
  RunRow row;
  for (size_t k = 0; k < texts; ++k) row.*text_columns[k].text = cells[k];
  for (size_t k = 0; k < found.size(); ++k)
    if (found[k] && !cells[texts + k].empty())
      row[found[k]->name] = reader.number(texts + k, found[k]->name);
  return row;
}

}  // namespace

std::span<const RunColumn> run_columns() { return columns; }

RunRow::RunRow() : numbers(std::size(columns), not_known) {}

RunRow::RunRow(const RunSummary& run) : solver(run.facts.solver) {
  for (const RunColumn& column : columns) numbers.push_back(column.value(run));
}

size_t RunRow::place_of(std::string_view column) {
  const auto* found = std::ranges::find(columns, column, &RunColumn::name);
  if (found == std::end(columns))
    throw std::invalid_argument("no column of runs is called " + std::string(column));
  return static_cast<size_t>(found - columns);
}

std::string runs_csv(std::span<const RunRow> rows) {
  CsvWriter csv;
  for (const TextColumn& column : text_columns) csv.add(column.name);
  for (const RunColumn& column : columns) csv.add(column.name);
  csv.end_row();
  for (size_t k = 0; k < texts; ++k) csv.add("text");
  for (const RunColumn& column : columns) csv.add(column.unit);
  csv.end_row();
  for (const RunRow& row : rows) {
    for (const TextColumn& column : text_columns) csv.add(row.*column.text);
    // what is not known is an empty cell
    for (const double value : row.numbers)
      if (std::isfinite(value))
        csv.add(value, 9);
      else
        csv.add("");
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

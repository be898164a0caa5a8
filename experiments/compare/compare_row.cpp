#include "experiments/compare/compare_row.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* measure_names[] = {"natural_map", "fclib"};
constexpr const char* start_names[] = {"cold", "warm"};

template <typename Enum, size_t count>
Enum by_name(const char* const (&names)[count], const std::string& name, const char* what) {
  for (size_t k = 0; k < count; ++k)
    if (name == names[k]) return static_cast<Enum>(k);
  throw std::invalid_argument("'" + name + "' is no " + what + "; there are: " + joined(names));
}

/// Calls f(name, member) for every column of the CSV, the JSON and the child's message.
template <typename Row, typename F>
void for_columns(Row& row, F&& f) {
  double seconds = row.seconds();     // a sum: a row that is read takes its parts
  f("case", row.case_name);           // problem
  f("family", row.family);            // problems of one kind
  f("solver", row.solver);            // backend
  f("law", row.law);                  // that the backend solves; each is judged on Coulomb's
  f("measure", row.measure);          // what the tolerance bounds
  f("tolerance", row.tolerance);      // relative
  f("start", row.start);              // cold: zero; warm: the run's
  f("repeat", row.repeat);            // from 0
  f("max_seconds", row.max_seconds);  // the limit
  f("verdict", row.verdict);          // solved: the backend says so and the judge agrees
  f("reason", row.reason);            // why the backend stopped
  f("error", row.error);              // in the measure
  f("seconds", seconds);              // prepare and solve, fastest run in the child
  f("prepare_seconds", row.prepare_seconds);
  f("solve_seconds", row.solve_seconds);
  f("startup_seconds", row.startup_seconds);  // not in the others
  f("runs", row.runs);                        // solves in the child
  f("iterations", row.iterations);
  f("natural_map_rms", row.judged.natural_map_rms);               // [m/s]
  f("natural_map_max", row.judged.natural_map_max);               // [m/s]
  f("fclib", row.judged.fclib);                                   // what Siconos prints
  f("cone_violation", row.judged.cone_violation);                 // [N s]
  f("min_normal_velocity", row.judged.min_normal_velocity);       // [m/s]
  f("worst", row.worst);                                          // contact of natural_map_max
  f("velocity_distance", row.distance.velocity);                  // of bodies; nan: none
  f("contact_velocity_distance", row.distance.contact_velocity);  // of contacts, rms
  f("body_impulse_distance", row.distance.body_impulse);  // of H^T r, as a part of the solution's
  f("wall_force_distance", row.distance.wall_force);      // on the driven wall; the same
  f("statuses_wrong", row.distance.statuses);             // of contacts; -1: no solution known
  f("peak_memory_MB", row.peak_memory_MB);                // of the child
  f("contacts", row.facts.contacts);
  f("rows", row.facts.rows);
  f("dofs", row.facts.dofs);  // unknowns of bodies in contact; 0: only W is known
  f("rank_deficiency", row.facts.rank_deficiency);  // 1 - rank(W)/rows
  f("mass_ratio", row.facts.mass_ratio);            // of bodies in contact
  f("velocity_scale", row.facts.velocity_scale);    // [m/s]
  f("note", row.note);
  f("content", row.facts.content);  // of problem, start and scale
  f("key", row.key);                // of problem, backend, options and binary
}

std::string text_of(const std::string& value) { return value; }
std::string text_of(int value) { return std::to_string(value); }
std::string text_of(double value) { return printed("%.6g", value); }
template <typename Enum>
std::string text_of(Enum value) {
  return name_of(value);
}

/// JSON has no NaN and no infinity: they become null.
Json json_of(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json json_of(int value) { return value; }
template <typename Value>
Json json_of(const Value& value) {
  return text_of(value);
}

void take(const Json& json, double& value) {
  value = json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}
/// The library's own conversion accepts fractions and numbers that no int can hold.
void take(const Json& json, int& value) {
  const double number = json.get<double>();
  if (number != std::floor(number) || std::abs(number) > std::numeric_limits<int>::max())
    throw std::invalid_argument(json.dump() + " is no whole number that fits");
  value = static_cast<int>(number);
}
void take(const Json& json, std::string& value) { value = json.get<std::string>(); }
void take(const Json& json, Measure& value) { value = measure_of(json.get<std::string>()); }
void take(const Json& json, StartKind& value) { value = start_of(json.get<std::string>()); }
void take(const Json& json, Verdict& value) {
  value = by_name<Verdict>(verdict_names, json.get<std::string>(), "verdict");
}

/// Throws std::invalid_argument if a number is out of its column's range.
void require_possible(const CompareRow& row) {
  const auto require = [](bool is_possible, const char* column) {
    if (!is_possible) throw std::invalid_argument(std::string(column) + " is out of range");
  };
  require(row.tolerance > 0.0, "tolerance");
  require(row.max_seconds > 0.0, "max_seconds");
  require(row.prepare_seconds >= 0.0, "prepare_seconds");
  require(row.solve_seconds >= 0.0, "solve_seconds");
  require(row.startup_seconds >= 0.0, "startup_seconds");
  require(std::min({row.repeat, row.runs, row.iterations}) >= 0, "repeat, runs or iterations");
  require(std::min({row.facts.contacts, row.facts.rows, row.facts.dofs}) >= 0,
          "contacts, rows or dofs");
}

}  // namespace

const char* name_of(Measure measure) { return measure_names[static_cast<size_t>(measure)]; }
const char* name_of(StartKind start) { return start_names[static_cast<size_t>(start)]; }
Measure measure_of(const std::string& name) {
  return by_name<Measure>(measure_names, name, "measure");
}
StartKind start_of(const std::string& name) {
  return by_name<StartKind>(start_names, name, "start");
}

std::vector<std::string> compare_columns() {
  std::vector<std::string> columns;
  const CompareRow row;
  for_columns(row, [&](const char* name, const auto&) { columns.emplace_back(name); });
  return columns;
}

std::vector<std::string> cells_of(const CompareRow& row) {
  std::vector<std::string> cells;
  for_columns(row, [&](const char*, const auto& value) { cells.push_back(text_of(value)); });
  return cells;
}

std::string compare_csv(std::span<const CompareRow> rows) {
  CsvWriter csv;
  csv.add_row(compare_columns());
  for (const CompareRow& row : rows) csv.add_row(cells_of(row));
  return csv.take();
}

std::string to_json(const CompareRow& row) {
  Json json = Json::object();
  for_columns(row, [&](const char* name, const auto& value) { json[name] = json_of(value); });
  Json& history = json["history"] = Json::array();
  for (const HistoryPoint& h : row.history)
    history.push_back({h.iteration, json_of(h.seconds), json_of(h.error)});
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

CompareRow compare_row_of_json(const std::string& text, const std::string& file, CompareRow row) {
  try {
    const Json json = Json::parse(text);
    row.history.clear();
    for_columns(row, [&](const char* name, auto& value) { take(json.at(name), value); });
    for (const Json& h : json.at("history")) {
      HistoryPoint& point = row.history.emplace_back();
      take(h.at(0), point.iteration);
      take(h.at(1), point.seconds);
      take(h.at(2), point.error);
    }
    require_possible(row);
    return row;
  } catch (const Json::exception&) {
    throw Error(file + ": is no row of a comparison: " + broken_json);
  } catch (const std::invalid_argument& error) {  // from a name or a number
    throw Error(file + ": is no row of a comparison: " + error.what());
  }
}

}  // namespace ballast

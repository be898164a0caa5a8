#include "experiments/compare/compare_row.hpp"

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

/// Calls f(name, member) for every member that the JSON keeps: written and read by the same list.
template <typename Row, typename F>
void for_members(Row& row, F&& f) {
  f("key", row.key);
  f("case", row.case_name);
  f("family", row.family);
  f("solver", row.solver);
  f("law", row.law);
  f("tolerance", row.tolerance);
  f("repeat", row.repeat);
  f("max_seconds", row.max_seconds);
  f("contacts", row.facts.contacts);
  f("rows", row.facts.rows);
  f("dofs", row.facts.dofs);
  f("rank_deficiency", row.facts.rank_deficiency);
  f("mass_ratio", row.facts.mass_ratio);
  f("velocity_scale", row.facts.velocity_scale);
  f("content", row.facts.content);
  f("reason", row.reason);
  f("note", row.note);
  f("error", row.error);
  f("natural_map_rms", row.natural_map_rms);
  f("natural_map_max", row.natural_map_max);
  f("fclib", row.fclib);
  f("cone_violation", row.cone_violation);
  f("min_normal_velocity", row.min_normal_velocity);
  f("own_residual", row.own_residual);
  f("worst_contact", row.worst_contact);
  f("worst", row.worst);
  f("velocity_distance", row.distance.velocity);
  f("contact_velocity_distance", row.distance.contact_velocity);
  f("body_impulse_distance", row.distance.body_impulse);
  f("wall_force_distance", row.distance.wall_force);
  f("statuses_wrong", row.distance.statuses);
  f("iterations", row.iterations);
  f("runs", row.runs);
  f("prepare_seconds", row.prepare_seconds);
  f("solve_seconds", row.solve_seconds);
  f("startup_seconds", row.startup_seconds);
  f("first_seconds", row.first_seconds);
  f("peak_memory_MB", row.peak_memory_MB);
}

/// JSON has no NaN: null.
Json json_of(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <typename Value>
Json json_of(const Value& value) {
  return value;
}

void take(const Json& json, double& value) {
  value = json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}
/// JSON's own conversion takes any number for a whole one, also what no int can hold.
void take(const Json& json, int& value) {
  const double number = json.get<double>();
  if (number != std::floor(number) || std::abs(number) > std::numeric_limits<int>::max())
    throw std::invalid_argument(json.dump() + " is no whole number that fits");
  value = static_cast<int>(number);
}
template <typename Value>
void take(const Json& json, Value& value) {
  value = json.get<Value>();
}

std::string six_digits(double value) { return printed("%.6g", value); }

/// The last columns: what the problem is.
std::vector<CompareColumn> problem_columns() {
  using R = const CompareRow&;
  return {
      {"peak_memory_MB", "of the child", [](R r) { return printed("%.4g", r.peak_memory_MB); }},
      {"contacts", "", [](R r) { return std::to_string(r.facts.contacts); }},
      {"rows", "", [](R r) { return std::to_string(r.facts.rows); }},
      {"dofs", "unknowns of bodies in contact; 0: only W is known",
       [](R r) { return std::to_string(r.facts.dofs); }},
      {"rank_deficiency", "1 - rank(W)/rows",
       [](R r) { return printed("%.4g", r.facts.rank_deficiency); }},
      {"mass_ratio", "of bodies in contact; where only W is known, of lambda_max(W_cc)",
       [](R r) { return printed("%.4g", r.facts.mass_ratio); }},
      {"velocity_scale", "[m/s]", [](R r) { return six_digits(r.facts.velocity_scale); }},
      {"note", "", [](R r) { return r.note; }},
      {"key", "of problem, backend, options and binary", [](R r) { return r.key; }},
  };
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

const std::vector<CompareColumn>& compare_columns() {
  using R = const CompareRow&;
  static const std::vector<CompareColumn> answer = {
      {"case", "problem", [](R r) { return r.case_name; }},
      {"family", "problems of one kind", [](R r) { return r.family; }},
      {"solver", "backend", [](R r) { return r.solver; }},
      {"law", "that the backend solves; each is judged on Coulomb's", [](R r) { return r.law; }},
      {"measure", "what the tolerance bounds", [](R r) { return std::string(name_of(r.measure)); }},
      {"tolerance", "relative", [](R r) { return printed("%g", r.tolerance); }},
      {"start", "cold: zero; warm: the run's", [](R r) { return std::string(name_of(r.start)); }},
      {"repeat", "from 0", [](R r) { return std::to_string(r.repeat); }},
      {"max_seconds", "the limit", [](R r) { return printed("%g", r.max_seconds); }},
      {"verdict", "solved: the backend says so and the judge agrees",
       [](R r) { return std::string(name_of(r.verdict)); }},
      {"reason", "why the backend stopped", [](R r) { return r.reason; }},
      {"error", "in the measure", [](R r) { return six_digits(r.error); }},
      {"seconds", "prepare and solve, fastest run in the child",
       [](R r) { return six_digits(r.seconds()); }},
      {"prepare_seconds", "", [](R r) { return six_digits(r.prepare_seconds); }},
      {"solve_seconds", "", [](R r) { return six_digits(r.solve_seconds); }},
      {"startup_seconds", "making the solver, processes, a foreign library's form: in no other",
       [](R r) { return six_digits(r.startup_seconds); }},
      {"first_seconds", "of the child's first run",
       [](R r) { return six_digits(r.first_seconds); }},
      {"runs", "solves in the child", [](R r) { return std::to_string(r.runs); }},
      {"iterations", "", [](R r) { return std::to_string(r.iterations); }},
      {"natural_map_rms", "[m/s]", [](R r) { return six_digits(r.natural_map_rms); }},
      {"natural_map_max", "[m/s]", [](R r) { return six_digits(r.natural_map_max); }},
      {"fclib", "what Siconos prints", [](R r) { return six_digits(r.fclib); }},
      {"cone_violation", "[N s]", [](R r) { return six_digits(r.cone_violation); }},
      {"min_normal_velocity", "[m/s]", [](R r) { return six_digits(r.min_normal_velocity); }},
      {"own_residual", "the backend's own: no evidence",
       [](R r) { return six_digits(r.own_residual); }},
      {"worst", "contact of natural_map_max", [](R r) { return r.worst; }},
      {"velocity_distance",
       "of bodies, from a solution at 1e-9, over the velocity scale; nan: none",
       [](R r) { return six_digits(r.distance.velocity); }},
      {"contact_velocity_distance", "of contacts, rms",
       [](R r) { return six_digits(r.distance.contact_velocity); }},
      {"body_impulse_distance", "of H^T r, as a part of the solution's",
       [](R r) { return six_digits(r.distance.body_impulse); }},
      {"wall_force_distance", "of the force on the driven wall, as a part of the solution's",
       [](R r) { return six_digits(r.distance.wall_force); }},
      {"statuses_wrong", "contacts that are open, stick or slip otherwise; -1: no solution known",
       [](R r) { return std::to_string(r.distance.statuses); }},
  };
  static const std::vector<CompareColumn> columns = [&] {
    std::vector<CompareColumn> all = answer;
    const std::vector<CompareColumn> rest = problem_columns();
    all.insert(all.end(), rest.begin(), rest.end());
    return all;
  }();
  return columns;
}

std::string compare_csv(const std::vector<CompareRow>& rows) {
  CsvWriter csv;
  for (const CompareColumn& column : compare_columns()) csv.add(column.name);
  csv.end_row();
  for (const CompareRow& row : rows) {
    for (const CompareColumn& column : compare_columns()) csv.add(column.text(row));
    csv.end_row();
  }
  return csv.take();
}

std::string to_json(const CompareRow& row) {
  Json json = Json::object();
  for_members(row, [&](const char* name, const auto& value) { json[name] = json_of(value); });
  json["measure"] = name_of(row.measure);
  json["start"] = name_of(row.start);
  json["verdict"] = name_of(row.verdict);
  Json& history = json["history"] = Json::array();
  for (const HistoryRow& h : row.history)
    history.push_back({h.iteration, json_of(h.seconds), json_of(h.error)});
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

CompareRow compare_row_of_json(const std::string& text, const std::string& file) {
  try {
    const Json json = Json::parse(text);
    CompareRow row;
    for_members(row, [&](const char* name, auto& value) { take(json.at(name), value); });
    row.measure = measure_of(json.at("measure").get<std::string>());
    row.start = start_of(json.at("start").get<std::string>());
    row.verdict = by_name<Verdict>(verdict_names, json.at("verdict").get<std::string>(), "verdict");
    for (const Json& h : json.at("history")) {
      HistoryRow point;
      take(h.at(0), point.iteration);
      take(h.at(1), point.seconds);
      take(h.at(2), point.error);
      row.history.push_back(point);
    }
    return row;
  } catch (const Json::exception&) {
    throw Error(file + ": is no row of a comparison: " + broken_json);
  } catch (const std::invalid_argument& error) {  // of a name
    throw Error(file + ": is no row of a comparison: " + error.what());
  }
}

}  // namespace ballast

#include "experiments/bench/measurement.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "experiments/measure/curve_fit.hpp"
#include "experiments/page/page.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

using Json = nlohmann::ordered_json;

std::string in_digits(double value) { return printed("%.4g", value); }

}  // namespace

Measurement measurement_of(const std::string& group, const std::string& name,
                           const std::string& unit, std::vector<double> values) {
  if (values.empty()) throw std::invalid_argument("no value of " + group + "/" + name);
  return {group,
          name,
          unit,
          quantile(values, 0.5),
          std::accumulate(values.begin(), values.end(), 0.0) / values.size(),
          quantile(values, 0.25),
          quantile(values, 0.75),
          static_cast<long>(values.size())};
}

void write_bench_result(const std::filesystem::path& folder, const std::string& kind,
                        const std::string& command, const std::vector<Measurement>& measurements) {
  create_folder(folder);
  // program, machine, time of day
  Json json = Json::parse(Manifest("bench " + kind, {command}, "").text());
  json.erase("resumed");
  json.erase("summary");
  json["kind"] = kind;
  json["command"] = command;
  json["measurements"] = Json::array();
  for (const Measurement& m : measurements)
    json["measurements"].push_back({{"group", m.group},
                                    {"name", m.name},
                                    {"unit", m.unit},
                                    {"median", m.median},
                                    {"mean", m.mean},
                                    {"low", m.low},
                                    {"high", m.high},
                                    {"samples", m.samples}});
  write_whole_file(folder / (kind + ".json"),
                   json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

BenchResult read_bench_result(const std::filesystem::path& file) {
  try {
    const Json json = Json::parse(read_whole_file(file));
    BenchResult result{json.at("kind"),
                       json.at("command"),
                       json.at("ballast").at("commit"),
                       json.at("machine").at("cpu"),
                       {}};
    // a number that was not finite was written as null
    const auto number = [](const Json& value) {
      return value.is_null() ? std::nan("") : value.get<double>();
    };
    for (const Json& m : json.at("measurements"))
      result.measurements.push_back({m.at("group"), m.at("name"), m.at("unit"),
                                     number(m.at("median")), number(m.at("mean")),
                                     number(m.at("low")), number(m.at("high")), m.at("samples")});
    return result;
  } catch (const Json::exception&) {
    throw Error(file.string() + ": is no result of ballast bench: " + broken_json);
  }
}

std::string bench_ratio_table(const BenchResult& a, const BenchResult& b) {
  const auto origin = [](const BenchResult& r) {
    return r.commit.substr(0, 12) + " (" + r.cpu + "), " + r.kind;
  };
  const auto find = [](const BenchResult& r, const Measurement& m) {
    return std::ranges::find_if(r.measurements, [&](const Measurement& other) {
      return other.full_name() == m.full_name() && other.unit == m.unit;
    });
  };
  page::Table table{.head = {"measurement", "unit", "A", "B", "B/A"},
                    .is_number = {false, false, true, true, true}};
  page::List alone;
  for (const Measurement& m : a.measurements) {
    const auto other = find(b, m);
    if (other == b.measurements.end()) {
      alone.items.push_back("only in A: " + m.full_name());
      continue;
    }
    const std::string ratio = m.median == 0.0 ? "" : in_digits(other->median / m.median);
    table.rows.push_back(
        {m.full_name(), m.unit, in_digits(m.median), in_digits(other->median), ratio});
  }
  for (const Measurement& m : b.measurements)
    if (find(a, m) == a.measurements.end()) alone.items.push_back("only in B: " + m.full_name());
  const page::List origins{{"A: " + origin(a), "B: " + origin(b)}};
  return markdown_of(page::Block(origins)) + markdown_of(page::Block(table)) +
         markdown_of(page::Block(alone));
}

std::string measurement_table(const std::vector<Measurement>& measurements) {
  std::string table;
  for (const Measurement& m : measurements)
    table += printed("%-58s %11.5g  mean %11.5g  [%.4g, %.4g] %s, %ld\n", m.full_name().c_str(),
                     m.median, m.mean, m.low, m.high, m.unit.c_str(), m.samples);
  return table;
}

}  // namespace ballast

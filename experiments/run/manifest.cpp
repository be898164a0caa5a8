#include "experiments/run/manifest.hpp"

#include <stdlib.h>
#include <unistd.h>

#include <cmath>
#include <ctime>
#include <fstream>
#include <limits>
#include <thread>

#include <nlohmann/json.hpp>

#include "experiments/run/build_info.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {

namespace {

using Json = nlohmann::ordered_json;

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

/// The program: version, commit, compiler, libraries.
Json build_json() {
  const BuildInfo& info = build_info();
  Json json = {{"version", info.version},       {"commit", info.commit},
               {"modified", info.modified},     {"compiler", info.compiler},
               {"build_type", info.build_type}, {"flags", info.flags},
               {"libraries", Json::object()}};
  for (const auto& [name, version] : info.libraries) json["libraries"][name] = version;
  return json;
}

/// The computer, and how busy it was when the run began.
Json machine_json() {
  Json json = {{"cpu", cpu_model()}, {"cores", std::thread::hardware_concurrency()}};
  const double memory =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  json["memory_GB"] = std::round(memory / 1e8) / 10.0;
  double load[3] = {0.0, 0.0, 0.0};
  const bool is_known = getloadavg(load, 3) == 3;
  for (double& one : load) one = std::round(100.0 * one) / 100.0;
  json["load_average"] = is_known ? Json(load) : Json(nullptr);
  // what changes the time or the bits of a threaded BLAS
  json["environment"] = Json::object();
  for (const char* name : {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"})
    if (const char* value = std::getenv(name)) json["environment"][name] = value;
  return json;
}

}  // namespace

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(':');
    if (line.starts_with("model name") && colon + 2 < line.size()) return line.substr(colon + 2);
  }
  return "unknown";
}

Manifest::Manifest(const std::string& scene, const std::vector<std::string>& overrides,
                   const std::string& key)
    : Manifest(Json{{"ballast", build_json()},
                    {"machine", machine_json()},
                    {"scene", scene},
                    {"overrides", Json(overrides)},
                    {"key", key},
                    {"started", utc_now()},
                    {"resumed", Json::array()},
                    {"summary", Json::object()}}) {}

Manifest::Manifest(nlohmann::ordered_json json) : json_(std::make_unique<Json>(std::move(json))) {}

Manifest::~Manifest() = default;
Manifest::Manifest(Manifest&&) noexcept = default;
Manifest& Manifest::operator=(Manifest&&) noexcept = default;

Manifest Manifest::read(const std::filesystem::path& file) {
  Json json;
  try {
    json = Json::parse(read_whole_file(file));
  } catch (const Json::parse_error& error) {
    throw Error(file.string() + ": is no JSON: it cannot be read on from byte " +
                std::to_string(error.byte));
  }
  // only what is read below is looked at: later programs may note more
  const auto has = [&](const char* name, Json::value_t type) {
    if (!json.is_object() || !json.contains(name) || json[name].type() != type)
      throw Error(file.string() + ": is no manifest of a run: '" + name +
                  "' is missing or of the wrong type");
  };
  for (const char* name : {"ballast", "machine", "summary"}) has(name, Json::value_t::object);
  for (const char* name : {"scene", "key", "started"}) has(name, Json::value_t::string);
  for (const char* name : {"overrides", "resumed"}) has(name, Json::value_t::array);
  return Manifest(std::move(json));
}

void Manifest::resumed(long step) {
  const BuildInfo& info = build_info();
  (*json_)["resumed"].push_back(Json{{"step", step},
                                     {"at", utc_now()},
                                     {"commit", info.commit},
                                     {"modified", info.modified},
                                     {"cpu", cpu_model()}});
}

void Manifest::summary(const std::string& name, double value) {
  (*json_)["summary"][name] = std::isfinite(value) ? Json(value) : Json(nullptr);
}

void Manifest::summary(const std::string& name, const std::string& value) {
  (*json_)["summary"][name] = value;
}

std::string Manifest::key() const { return json_->at("key").get<std::string>(); }

std::string Manifest::commit() const {
  const Json& ballast = json_->at("ballast");
  return ballast.value("commit", "") + (ballast.value("modified", false) ? "-dirty" : "");
}

std::string Manifest::machine() const {
  const Json& machine = json_->at("machine");
  if (!machine.contains("cpu") || !machine["cpu"].is_string()) return "unknown";
  std::string text = machine["cpu"].get<std::string>();
  if (machine.contains("cores")) text += ", " + machine["cores"].dump() + " cores";
  return one_line(text, ' ');
}

std::string Manifest::started() const { return json_->at("started").get<std::string>(); }

double Manifest::summary_number(const std::string& name) const {
  const Json& summary = json_->at("summary");
  const auto found = summary.find(name);
  if (found == summary.end() || !found->is_number())
    return std::numeric_limits<double>::quiet_NaN();
  return found->get<double>();
}

/// Names from a command line may be no UTF-8: such bytes are replaced, not refused.
std::string Manifest::text() const {
  return json_->dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void Manifest::write(const std::filesystem::path& file) const { write_whole_file(file, text()); }

}  // namespace ballast

#include "experiments/run/manifest.hpp"

#include <nlohmann/json.hpp>

#include "experiments/record/progress.hpp"
#include "experiments/run/build_info.hpp"
#include "tests/support/sample_run.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("the build knows what it is") {
  const BuildInfo& info = build_info();
  CHECK(std::count(info.version.begin(), info.version.end(), '.') == 2);
  CHECK((info.commit == "unknown" ||
         (info.commit.size() == 40 &&
          info.commit.find_first_not_of("0123456789abcdef") == std::string::npos)));
  CHECK_THAT(info.flags, Contains("-ffp-contract=off"));
  CHECK_FALSE(info.compiler.empty());
  for (const auto& [name, version] : info.libraries) {
    INFO(name << " " << version);
    CHECK((!name.empty() && !version.empty() &&
           version.find_first_not_of("0123456789.") == std::string::npos));
  }
  CHECK_THAT(build_line(), Contains(info.version) && Contains(info.commit.substr(0, 12)));
}

TEST_CASE("a manifest says what a run was made by and from, and is read back") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "manifest.json";
  Manifest manifest("vibrated_box", {"solver.name=\"pgs\"", "friction=0.5"}, "0123456789abcdef");
  manifest.summary("ms_per_step", 41.25);
  manifest.summary("packing", "cache/packing.bin");
  manifest.summary("nothing", std::nan(""));
  manifest.resumed(120);
  manifest.summary("ms_per_step", 40.5);
  manifest.write(file);
  CHECK(file_bytes(file) == manifest.text());

  const auto json = nlohmann::json::parse(file_bytes(file));
  CHECK(json["ballast"]["commit"] == build_info().commit);
  CHECK(json["ballast"]["libraries"].size() == build_info().libraries.size());
  CHECK(json["machine"]["cores"] >= 1);
  CHECK(json["overrides"][0] == "solver.name=\"pgs\"");
  CHECK(json["resumed"][0]["step"] == 120);
  CHECK(json["started"].get<std::string>().size() == 20);
  CHECK(json["summary"]["ms_per_step"] == 40.5);
  CHECK(json["summary"]["nothing"].is_null());

  Manifest read = Manifest::read(file);
  CHECK(read.text() == manifest.text());
  CHECK((read.scene() == "vibrated_box" && read.key() == "0123456789abcdef"));
  CHECK(read.summary_number("ms_per_step") == 40.5);
  CHECK(std::isnan(read.summary_number("packing")));
  CHECK(std::isnan(read.summary_number("no such name")));
}

TEST_CASE("text that is no UTF-8 does not break a manifest") {
  const Manifest manifest("s\xff", {}, "k");
  CHECK_NOTHROW(nlohmann::json::parse(manifest.text()));
}

TEST_CASE("a manifest that is none is refused with its name") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "manifest.json";
  const auto refusal = [&] { return run_error([&] { Manifest::read(file); }); };
  CHECK_THAT(refusal(), Contains(file.string()) && Contains("cannot open"));
  put_bytes(file, "{\"scene\": ");
  CHECK_THAT(refusal(), Contains(file.string()) && Contains("is no JSON"));
  put_bytes(file, "[1, 2]");
  CHECK_THAT(refusal(), Contains("is no manifest"));
  auto json = nlohmann::json::parse(Manifest("s", {}, "k").text());
  json["key"] = 5;
  put_bytes(file, json.dump());
  CHECK_THAT(refusal(), Contains("is no manifest") && Contains("'key'"));
}

namespace {

/// A run of `steps` steps of 1 ms each, told to a Progress.
std::string told(Progress::Style style, int steps, double seconds_per_step) {
  std::ostringstream out;
  double now = 100.0;
  {
    Progress progress(style, out, [&] { return now; });
    StepRecord record;
    record.contacts = 6312;
    record.error_rms = 1.96e-6;
    for (int step = 1; step <= steps; ++step) {
      now += seconds_per_step;
      progress.show("drive", 1e-3 * step, 1.0, record);
    }
    progress.finish();
  }
  return out.str();
}

}  // namespace

TEST_CASE("progress: quiet says nothing") {
  CHECK(told(Progress::Style::quiet, 1000, 0.05).empty());
}

TEST_CASE("progress: one plain line every ten seconds and one at the end") {
  const std::string text = told(Progress::Style::lines, 1000, 0.05);  // 50 s
  CHECK(std::count(text.begin(), text.end(), '\n') == 5);
  CHECK(text.find('\r') == std::string::npos);
  std::istringstream lines(text);
  std::string line;
  for (int k = 1; k <= 4; ++k) {
    REQUIRE(std::getline(lines, line));
    INFO(line);
    CHECK_THAT(line, Contains("drive ") && Contains(" 50.0 ms/step") && Contains("error 2.0e-06") &&
                         Contains("6312 contacts"));
    CHECK_THAT(line, Contains(std::to_string(20 * k) + " %") &&
                         Contains(std::to_string(50 - 10 * k) + " s left"));
  }
  REQUIRE(std::getline(lines, line));
  CHECK_THAT(line, Contains("100 %") && !Contains("left"));
  CHECK(told(Progress::Style::lines, 10, 0.01).find('\n') ==
        told(Progress::Style::lines, 10, 0.01).size() - 1);
}

TEST_CASE("progress: a bar rewrites its line, at most ten times a second, and ends it") {
  const std::string text = told(Progress::Style::bar, 1000, 0.01);  // 10 s
  CHECK(std::count(text.begin(), text.end(), '\n') == 1);
  CHECK(text.back() == '\n');
  const auto writes = std::count(text.begin(), text.end(), '\r');
  CHECK((writes >= 80 && writes <= 102));
  CHECK_THAT(text, Contains("[######......]") && Contains("[############] 100 %"));
  // each rewriting covers what the one before left
  size_t previous = 0;
  std::istringstream parts(text.substr(1, text.size() - 2));
  for (std::string part; std::getline(parts, part, '\r');) {
    CHECK(part.size() >= previous);
    previous = part.find_last_not_of(' ') + 1;
  }
}

TEST_CASE("progress: phases, resumed runs and silence") {
  std::ostringstream out;
  double now = 0.0;
  {
    Progress progress(Progress::Style::lines, out, [&] { return now; });
    progress.finish();  // nothing shown yet
    CHECK(out.str().empty());
    StepRecord record;
    for (int step = 1; step <= 30; ++step)
      progress.show("rain", 0.01 * step, 3.0, record, 0.5), now += 1.0;
    progress.restart();
    out.str("");
    // a phase that is entered in its middle: the rate counts from there
    for (int step = 1; step <= 12; ++step)
      progress.show("drive", 0.5 + 0.01 * step, 1.0, record), now += 1.0;
  }
  CHECK_THAT(out.str(), Contains("drive ") && Contains("39 s left") && Contains("1000.0 ms/step") &&
                            !Contains("rms"));
}

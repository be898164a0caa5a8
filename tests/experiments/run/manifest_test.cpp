#include "experiments/run/manifest.hpp"

#include <nlohmann/json.hpp>

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
  CHECK(read.key() == "0123456789abcdef");
  CHECK_THAT(read.text(), Catch::Contains("\"scene\": \"vibrated_box\""));
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

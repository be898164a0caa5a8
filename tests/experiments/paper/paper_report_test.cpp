// From folders of finished runs to the report: records with known exponents, and partial data,
// which are said and never an error.

#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "experiments/page/html.hpp"
#include "experiments/paper/campaign.hpp"
#include "experiments/paper/paper_report.hpp"
#include "experiments/paper/point_origins.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/paper/paper_runs.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("records that follow Eq. 3 and Eq. 5 are found to do so, from the folders to the table") {
  TemporaryFolder folder;
  CampaignSettings settings;
  settings.seeds = 1;
  const Campaign campaign = make_campaign(settings);
  for (const char* target : {"fig11", "fig13"})
    for (const size_t run : runs_for(campaign, target))
      if (!is_finished(folder.path(), campaign.runs[run].planned))
        write_run(folder.path(), campaign.runs[run].planned);
  PaperData data(campaign, folder.path());
  std::vector<PaperSection> sections;
  for (const char* target : {"fig9", "fig10", "fig11", "fig13"})
    sections.push_back(make_sections(data, target).front());
  for (const PaperSection& section : sections) CHECK(section.notes.empty());
  for (const char* claim :
       {"Δx_max ~ ν⁻²", "v_max ~ ν⁻¹", "Δx_max ~ f_max⁻¹", "Δx_max ~ g²", "Δx_max ~ m/(m + m_w)",
        "one line through all series", "maximum at ν_c ~ 10 Hz; both parameters free"})
    CHECK(row_of(sections, claim).agreement == Agreement::agrees);
  // one sample has no interval
  CHECK(row_of(sections, "Δρ_max/ρ₀ ~ 0.0025").agreement == Agreement::reported);
  CHECK_THAT(plain_words(row_of(sections, "Δx_max ~ ν⁻²").ballast), Catch::StartsWith("−2.0"));
  CHECK_THAT(plain_words(row_of(sections, "Δx_max ~ g²").ballast), Catch::StartsWith("2.0"));
  CHECK_THAT(plain_words(row_of(sections, "C ~ 0.01").ballast),
             Catch::StartsWith("C = 0.0") && Catch::Contains("m all grains"));
  const auto values = data.values(Varied::frequency);
  for (const VariedValue& value : values)
    CHECK(value.samples.front().rise / value.samples.front().eq3() ==
          Approx(PaperLaw{}.prefactor).epsilon(0.03));  // 41 steps in the fastest stroke
}

TEST_CASE("partial data give partial figures and a loud note; no data give a report as well") {
  TemporaryFolder folder;
  const Campaign campaign = make_campaign({});
  PaperData nothing(campaign, folder.path());
  const auto empty = make_sections(nothing, "all");
  CHECK(empty.size() == 27);
  for (const PaperSection& section : empty) {
    INFO(section.id);
    CHECK_FALSE(section.notes.empty());
    CHECK(section.rows.empty());
    CHECK(section.figures.empty());
  }
  int written = 0;
  for (const CampaignPoint& point : campaign.points) {
    if (point.varied != Varied::frequency || point.value < 5.0 || point.value > 10.0 ||
        point.seed > 2)
      continue;
    write_run(folder.path(), campaign.runs[point.run].planned);
    ++written;
  }
  REQUIRE(written == 6);
  PaperData data(campaign, folder.path());
  CHECK(data.finished() == 6);
  const PaperSection section = make_sections(data, "fig9").front();
  REQUIRE(section.notes.size() == 1);
  CHECK(section.notes.front() == "PARTIAL: 3 of 10 frequencies, 6 of 30 runs.");
  REQUIRE(section.figures.size() == 1);

  write_paper_report(data, make_sections(data, "all"), folder.path() / "report");
  const auto text = [&](const char* name) {
    std::ifstream file(folder.path() / "report" / name);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string markdown = text("README.md"), html = text("paper.html");
  CHECK_THAT(markdown, Catch::Contains("**PARTIAL: 3 of 10 frequencies, 6 of 30 runs.**") &&
                           Catch::Contains("figures/fig09.svg") &&
                           Catch::Contains("6 of " + std::to_string(campaign.runs.size()) +
                                           " runs are finished"));
  CHECK_THAT(html, Catch::Contains("PARTIAL: 3 of 10 frequencies"));
  // a point is the mean of two seeds; the page of one of them is there, of the other a command
  const VariedValue value = data.values(Varied::frequency).front();
  REQUIRE(value.runs.size() == 2);
  CHECK(section.figures[0].plot.panels[0].curves[0].origins.front() == value.origin());
  std::ofstream(data.folder(value.runs[1]) / "report.html") << "its page";
  const auto origins = nlohmann::json::parse(
      origins_of_points(data, {section}, folder.path() / "report"))["origins"];
  CHECK(origins.size() == 3);
  const auto& origin = origins[value.origin()];
  CHECK(origin["links"].size() == 1);
  CHECK(origin["links"][0][0] ==
        "../runs/" + data.folder(value.runs[1]).filename().string() + "/report.html");
  CHECK(origin["links"][0][1] == campaign.runs[value.runs[1]].planned.name);
  CHECK(origin["commands"][0][0] == "ballast report " + data.folder(value.runs[0]).string());
  for (const char* figure : {"fig11", "fig13"}) {
    INFO(figure);
    for (const PaperSection& other : make_sections(data, figure))
      for (const Curve& curve : other.figures.at(0).plot.panels[0].curves)
        CHECK((curve.mark == Mark::points) == (curve.origins.size() == curve.x.size()));
  }
  if (page::can_answer()) CHECK_THAT(html, Catch::Contains('"' + value.origin() + '"'));
  CHECK_THAT(text("data/fig09.csv"),
             Catch::StartsWith("panel,y_label,curve,x_label,x,y,y_error,y_low\n"));
}

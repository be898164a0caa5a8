// From folders of finished runs to the report: records with known exponents, and partial data,
// which the report states and which are never an error.

#include <fstream>

#include "experiments/paper/sections.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/paper/paper_runs.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("records that follow Eq. 3 and Eq. 5 are found to do so, from the folders to the table") {
  TemporaryFolder folder;
  PaperData data =
      written(folder.path(), {"frequency", "slowest", "force", "gravity", "mass"}, {},
              [](const PlannedRun&, const Scene& scene) { return scene.grains->seed == 1; });
  std::vector<PaperSection> sections;
  for (const char* target : {"fig9", "fig10", "fig11", "fig13"})
    sections.push_back(make_sections(data, target).front());
  for (const char* claim :
       {"Δx_max ~ ν⁻²", "v_max ~ ν⁻¹", "Δx_max ~ f_max⁻¹", "Δx_max ~ g²", "Δx_max ~ m/(m + m_w)",
        "one line through all series", "maximum at ν_c ~ 10 Hz; both parameters free"})
    CHECK_THAT(judged(sections, claim), Catch::StartsWith("agrees: "));
  // Below 10 Hz the made gain is constant: that is not looked at.
  CHECK_THAT(judged(sections, "Δρ₁ scales as Δx_max from 10 Hz on"),
             Catch::StartsWith("agrees: exponent of Δx_max: 0.99"));
  // One sample has no interval.
  CHECK_THAT(judged(sections, "Δρ_max/ρ₀ ~ 0.0025"), Catch::StartsWith("reported: "));
  CHECK_THAT(judged(sections, "Δx_max ~ ν⁻²"), Catch::StartsWith("agrees: −2.0"));
  CHECK_THAT(judged(sections, "Δx_max ~ g²"), Catch::StartsWith("agrees: 2.0"));
  CHECK_THAT(judged(sections, "C ~ 0.01"),
             Catch::Contains(": C = 0.0") && Catch::Contains("m all grains"));
  for (const RunRow& row : data.rows())
    CHECK(row["prefactor"] ==
          Approx(PaperLaw{}.prefactor).epsilon(0.03));  // 41 steps in the fastest stroke
}

TEST_CASE("partial data give partial figures and a loud note, no data give a report as well") {
  TemporaryFolder folder;
  PaperData nothing = written(folder.path(), {});
  const auto empty = make_sections(nothing, "all");
  CHECK(empty.size() == paper_sections().size());
  for (const PaperSection& section : empty) {
    INFO(section.id);
    CHECK_FALSE(section.notes.empty());
    CHECK(section.claims.empty());
    CHECK(section.figures.empty());
  }
  PaperData data =
      written(folder.path(), {"frequency"}, {}, [](const PlannedRun&, const Scene& scene) {
        return scene.drive.frequency >= 5.0 && scene.drive.frequency <= 10.0 &&
               scene.grains->seed <= 2;
      });
  CHECK(data.finished() == 6);
  const PaperSection section = make_sections(data, "fig9").front();
  REQUIRE(section.notes.size() == 2);
  CHECK(section.notes.front() == "PARTIAL: 6 of 27 runs of frequency.");
  CHECK(section.figures.size() == 2);

  write_paper_report(data, make_sections(data, "all"), folder.path() / "report");
  const auto text = [&](const char* name) {
    std::ifstream file(folder.path() / "report" / name);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string markdown = text("README.md");
  CHECK_THAT(markdown,
             Catch::Contains("**PARTIAL: 6 of 27 runs of frequency.**") &&
                 Catch::Contains("figures/fig09.svg") &&
                 Catch::Contains("6 of " + std::to_string(data.planned()) + " runs are finished") &&
                 Catch::Contains("No poses"));
  CHECK_THAT(text("paper.html"), Catch::Contains("PARTIAL: 6 of 27 runs of frequency"));
  CHECK_THAT(text("data/fig09.csv"),
             Catch::StartsWith("panel,y_label,curve,x_label,x,y,y_error,y_low\n"));
  // The written rows can be read again, all of them.
  const std::vector<RunRow> rows = read_runs_csv(folder.path() / "report/data/runs.csv");
  CHECK(rows.size() == data.rows().size());
}

TEST_CASE("where no run at 5 Hz has a whole period, the rates are partial and say so") {
  TemporaryFolder folder;
  PaperData made =
      written(folder.path(), {"frequency"}, {}, [](const PlannedRun&, const Scene& scene) {
        return scene.drive.frequency >= 5.0 && scene.drive.frequency <= 10.0 &&
               scene.grains->seed == 1;
      });
  std::vector<RunRow> rows = made.rows();
  for (RunRow& row : rows)
    if (row["frequency"] == 5.0) row["gain"] = not_known;
  PaperData data(made.campaign(), folder.path() / "no_runs", rows);
  const PaperSection section = section_named(data, "fig13");
  CHECK(std::ranges::count(section.notes,
                           page::Text("PARTIAL: no run at 5 Hz has a whole period.")) == 1);
  CHECK_FALSE(section.claims.empty());
}

TEST_CASE("both pages say the same words, and what was found stands before the sections") {
  PaperSection section;
  section.id = "fig9";
  section.heading = "Figure 9 <again>";
  section.notes = {"PARTIAL: 1 of 2"};
  section.text = {page::marked("About *x*.")};
  section.figures = {{.plot = {.name = "fig09", .title = "A title", .panels = {Panel{}}},
                      .caption = {"what the paper says", "falls | too"},
                      .files = page::Text("PDF", 0, "figures/fig09.pdf")}};
  section.tables = {{"Means", {"ν", "a|b"}, {{"1", page::with_error(1.5, 0.25)}}}};
  section.claims = {{"Fig. 9", "y", "DIFFERS", "no", "0.9 … 1.1", "−2.00 [−2.01, −1.99]"}};
  section.findings = {{"beyond", "something"}};
  PaperSection other = section;
  other.id = "fig10";
  other.figures.clear();
  const page::Page page = paper_page({section, other}, {"1 of 2 runs are finished."});
  const std::string html = html_of(page), markdown = markdown_of(page);
  check_page(html);
  for (const char* words :
       {"PARTIAL: 1 of 2", "1 of 2 runs are finished.", "Means:", "1.50 ± 0.25", "Azéma"}) {
    CHECK_THAT(html, Catch::Contains(words));
    CHECK_THAT(markdown, Catch::Contains(words));
  }
  CHECK_THAT(markdown,
             Catch::Contains("| Fig. 9 | y | DIFFERS | no | 0.9 … 1.1 | −2.00 [−2.01, −1.99"));
  for (const auto& [place, id] : {std::pair(1, "agreement"), {2, "beyond"}}) {
    REQUIRE(page.sections.at(place).id == id);
    CHECK(std::get<page::Table>(page.sections[place].blocks.back()).rows.size() == 2);
  }
}

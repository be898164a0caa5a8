// The table of the report's sections: what each is called, and which runs it needs.

#include "experiments/paper/sections.hpp"

#include <set>

#include "experiments/paper/campaign.hpp"
#include "experiments/paper/decisive_stages.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("each figure asks for its own runs, all for all of them") {
  const Campaign campaign = make_campaign({});
  CHECK(runs_for(campaign, "fig3") == campaign.motion);
  CHECK(runs_for(campaign, "fig8").size() == 6);
  CHECK(runs_for(campaign, "fig9").size() == 30);
  CHECK(runs_for(campaign, "all").size() == campaign.runs.size());
  for (const std::string& target : paper_targets()) {
    size_t runs = 0;
    std::set<std::string> stages;
    for (const Plan& stage : stages_of(PaperData(campaign, "nothing there"), target)) {
      runs += stage.runs.size();
      CHECK(stages.insert(stage.name).second);
    }
    CHECK(runs == runs_for(campaign, target).size());
  }
  CHECK_THROWS_WITH(runs_for(campaign, "fig2"),
                    Catch::Contains("'fig2'") && Catch::Contains("fig13"));
}

TEST_CASE("every run of the campaign is needed by a section, and every section by its name") {
  std::set<std::string> names;
  std::set<Varied> drawn;
  for (const ReportSection& section : paper_sections()) {
    INFO(section.name);
    CHECK(names.insert(section.name).second);
    CHECK(section.make != nullptr);
    CHECK_FALSE(page::words(section.name + std::string(".heading")).empty());
    CHECK((section.needs_motion || !section.needs.empty()));
    drawn.insert(section.needs.begin(), section.needs.end());
  }
  // what no section draws is in the table of all runs, and has its stage for a target
  const Campaign campaign = make_campaign({});
  std::set<std::string> stages;
  for (const DecisiveStage& stage : decisive_stages()) stages.insert(stage.name);
  for (const CampaignPoint& point : campaign.points)
    CHECK((drawn.contains(point.varied) || stages.contains(point.stage)));
  const std::vector<std::string> targets = paper_targets();
  names.insert(stages.begin(), stages.end());
  CHECK(targets.size() == names.size() + 1);
  CHECK(targets.front() == "curve");
  CHECK(targets.back() == "all");
}

TEST_CASE("the investigation has its own target, and the looser deposit stands in it alone") {
  const Campaign campaign = make_campaign({});
  std::set<size_t> runs;
  for (const size_t run : runs_for(campaign, "investigation")) runs.insert(run);
  for (const CampaignPoint& point : campaign.points)
    if (point.varied == Varied::loose_frequency || point.varied == Varied::time_step_fast)
      CHECK(runs.contains(point.run));
  CHECK(runs.size() < campaign.runs.size());
}

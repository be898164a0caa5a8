// Runs that are there, beside runs of which a row alone is known.

#include "experiments/paper/paper_data.hpp"

#include "experiments/paper/sections.hpp"
#include "tests/experiments/paper/paper_runs.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

Campaign one_sample() {
  CampaignSettings settings;
  settings.seeds = 1;
  return make_campaign(settings);
}

/// The rows of a campaign whose runs at these frequencies are in `folder`.
std::vector<RunObservables> rows_of(const std::filesystem::path& folder,
                                    std::initializer_list<double> frequencies) {
  const Campaign campaign = one_sample();
  for (const CampaignPoint& point : campaign.points)
    if (point.varied == Varied::frequency && std::ranges::count(frequencies, point.value) > 0)
      write_run(folder, campaign.runs[point.run].planned);
  return PaperData(campaign, folder).observables();
}

}  // namespace

TEST_CASE("a row stands for its run: it is drawn as if it were there, and not made again") {
  const TemporaryFolder there, here;
  const std::vector<RunObservables> rows = rows_of(there.path(), {5.0, 20.0});
  REQUIRE(rows.size() == 2);
  PaperData data(one_sample(), here.path(), rows);
  CHECK(data.finished() == 0);
  CHECK(data.known_by_row() == 2);
  CHECK(data.motion().empty());  // whole states stand in records alone
  const std::vector<VariedValue> values = data.values(Varied::frequency);
  REQUIRE(values.size() == 2);
  CHECK(values[1].value == 20.0);
  CHECK(values[1].samples.front().rise == rows[1].seen.rise);
  CHECK_THAT(data.missing(Varied::frequency), Catch::Contains("2 of 10 frequencies"));
  CHECK(data.knows(values[0].runs.front()));
  CHECK_FALSE(data.has(values[0].runs.front()));
  size_t planned = 0;
  for (const Plan& stage : stages_of(data, "fig9")) planned += stage.runs.size();
  CHECK(planned == runs_for(data.campaign(), "fig9").size() - 2);
}

TEST_CASE("a row counts all periods of its run, and serves no point that counts fewer") {
  const TemporaryFolder there, here;
  // 10 Hz for 1 s is the base of the other series too, which count 0.7 s of it
  PaperData data(one_sample(), here.path(), rows_of(there.path(), {10.0}));
  CHECK(data.values(Varied::frequency).size() == 1);
  CHECK(data.values(Varied::force).empty());
  CHECK_THAT(data.missing(Varied::force), Catch::Contains("0 of 5 runs"));
}

TEST_CASE("a run whose row was given and that was made here tells whether both are the same") {
  const TemporaryFolder there, here;
  std::vector<RunObservables> rows = rows_of(there.path(), {5.0, 20.0});
  rows_of(here.path(), {5.0, 20.0, 60.0});
  CHECK(PaperData(one_sample(), here.path()).repeats().made == 0);
  PaperData same(one_sample(), here.path(), rows);
  CHECK(same.known_by_row() == 0);
  CHECK(same.repeats().made == 2);
  CHECK(same.repeats().same == 2);
  rows.front().record[0] ^= 1;
  PaperData other(one_sample(), here.path(), rows);
  CHECK(other.repeats().made == 2);
  CHECK(other.repeats().same == 1);
}

TEST_CASE("rows of another campaign are named, not drawn") {
  const TemporaryFolder there, here;
  const std::vector<RunObservables> rows = rows_of(there.path(), {5.0, 20.0});
  CHECK(PaperData(one_sample(), here.path(), rows).foreign_rows().empty());
  CampaignSettings settings;
  settings.seeds = 1;
  settings.overrides = {"grains.count=300"};
  PaperData other(make_campaign(settings), here.path(), rows);
  CHECK(other.known_by_row() == 0);
  CHECK(other.foreign_rows().size() == 2);
  CHECK(std::ranges::count(other.foreign_rows(), rows.front().name) == 1);
}

// Runs of the campaign: equal settings are one run, and a run's scene says what was asked.

#include "experiments/paper/campaign_builder.hpp"

#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("equal settings are one run, whatever asks for them") {
  CampaignBuilder build(CampaignSettings{});
  const size_t first = build.run({});
  RunSettings other;
  other.friction = 0.8;
  const size_t second = build.run(other);
  CHECK(second != first);
  CHECK(build.run({}) == first);
  other.iterations = build.campaign.settings.iterations;  // the same as not given
  CHECK(build.run(other) == second);
  CHECK(build.campaign.runs.size() == 2);
  CHECK(build.campaign.packings == 1);  // the deposit's friction is its own
  other.deposit_friction = 0.8;
  build.run(other);
  CHECK(build.campaign.packings == 2);
}

TEST_CASE("a point is one run for each seed") {
  CampaignBuilder build(CampaignSettings{});
  build.stage = "first";
  build.point(Varied::force, 3.0, "3", {}, 2, {0.3, 0.7});
  REQUIRE(build.campaign.points.size() == 2);
  CHECK(build.campaign.points[1].seed == 2);
  CHECK(build.campaign.points[1].window.end == 0.7);
  CHECK(build.campaign.points[0].run != build.campaign.points[1].run);
  CHECK(build.campaign.runs[0].stage == "first");
}

TEST_CASE("a run's scene says what was asked") {
  CampaignBuilder build(CampaignSettings{});
  RunSettings asked;
  asked.frequency = 20.0;
  asked.duration = 0.5;
  asked.wall_mass = 2.0;
  asked.iterations = 33;
  asked.size = "diameter";
  asked.pressed = false;
  asked.seed = 4;
  const CampaignRun& run = build.campaign.runs[build.run(asked)];
  const Scene base = read_scene(find_scene(run.planned.scene));
  const Scene scene = read_scene(find_scene(run.planned.scene), run.planned.overrides);
  CHECK(scene.drive.frequency == 20.0);
  CHECK(scene.duration == 0.5);
  CHECK(scene.drive.wall_mass_over_grains == 2.0);
  CHECK(scene.solver.max_iterations == 33);
  CHECK(scene.grains->seed == 4);
  CHECK(scene.grains->size_convention == SizeConvention::diameter);
  CHECK(scene.box.length == Approx(0.5 * base.box.length));
  CHECK(scene.deposit.lid_pressure_weight == 0.0);
  CHECK(run.steps == 2500);
  CHECK(duration_at(1.0) == 3.0);
  CHECK(duration_at(60.0) == 1.0);
}

TEST_CASE("a scene without grains is no campaign") {
  CampaignSettings settings;
  settings.scene = "incline";
  CHECK_THROWS_WITH(CampaignBuilder(settings), Catch::Contains("has no [grains]"));
}

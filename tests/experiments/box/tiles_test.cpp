#include <cmath>
#include <set>
#include <tuple>

#include "experiments/box/packing.hpp"
#include "experiments/step/time_step.hpp"
#include "platform/text.hpp"
#include "tests/experiments/box/small_box.hpp"
#include "tests/support/sample_run.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// Three by two tiles of small_box().
Scene tiled_box(std::vector<std::string> more = {}) {
  const Scene tile = small_box();
  const auto set = [](const char* key, double value) {
    return key + std::string("=") + printed("%.17g", value);
  };
  more.insert(more.begin(),
              {"grains.count=30", "deposit.tiles_x=3", "deposit.tiles_y=2",
               set("box.length", 3 * tile.box.length), set("box.width", 2 * tile.box.width)});
  return small_box(more);
}

Packing taken(const Scene& scene, const fs::path& cache) {
  Packing packing;
  const PackingOptions order{cache, [] { return true; }, Progress::Style::quiet};
  REQUIRE(load_or_deposit(scene, make_rain(scene), order, packing));
  return packing;
}

double deepest_overlap(const Scene& scene, const Packing& packing) {
  MotionState state;
  const MechanicalSystem system = drive_system(scene, make_rain(scene), packing, state);
  StepMemory memory = packing.memory;
  return TimeStepper(system, scene, -1).step(state, memory).penetration_max;
}

}  // namespace

TEST_CASE("a tiled box is copies of a small one's grains and packing") {
  const TemporaryFolder folder;
  const Scene scene = tiled_box(), one = tile_of(scene);
  CHECK(one.grains->count == 5);
  CHECK(one.box.length == Approx(small_box().box.length));
  CHECK(one.box.width == Approx(small_box().box.width));
  const Rain rain = make_rain(scene), grains = make_rain(one);
  REQUIRE(rain.grains.size() == 30);
  const Packing tile = taken(one, folder.path());
  MotionState state;
  box_system(scene, rain, BoxStage::settle, tile.deposit.lid, &state);
  place_copies(rain, tile.state, state);
  // Each grain of the tile is once in each of the six, and all are numbered along x.
  std::set<std::tuple<size_t, double, double>> copies;
  for (size_t b = 0; b < 30; ++b) {
    const auto& [of, shift] = rain.copies[b];
    copies.emplace(of, std::round(shift.x() / one.box.length),
                   std::round(shift.y() / one.box.width));
    CHECK(rain.grains[b].name == "grain " + std::to_string(b));
    CHECK((rain.grains[b].pose.position - grains.grains[of].pose.position - shift).norm() < 1e-15);
    if (b > 0) CHECK(rain.grains[b - 1].pose.position.x() <= rain.grains[b].pose.position.x());
    CHECK(rain.grains[b].mass == grains.grains[of].mass);
    CHECK((state.pose[b].position - tile.state.pose[of].position - shift).norm() < 1e-15);
    CHECK(state.velocity[b] == tile.state.velocity[of]);
  }
  CHECK(copies.size() == 30);
  CHECK(std::get<1>(*copies.rbegin()) == 2.0);
  CHECK(std::get<2>(*copies.rbegin()) == 1.0);
}

TEST_CASE("a tiled box is deposited: its tile, then what is loose between the copies") {
  const TemporaryFolder folder;
  const Scene scene = tiled_box(), one = tile_of(scene);
  const Packing packing = taken(scene, folder.path());
  CHECK(fs::exists(packing_file(folder.path(), packing_key(one))));
  CHECK(fs::exists(packing_file(folder.path(), packing_key(scene))));
  // the copies' rain has a grain's width to fall, not the tile's whole height
  CHECK(packing.deposit.rain_time < 0.7 * taken(one, folder.path()).deposit.rain_time);
  CHECK(packing.deposit.rest_velocity < 10 * scene.deposit.rest_velocity);
  CHECK(deepest_overlap(scene, packing) <= deepest_overlap(one, taken(one, folder.path())) + 1e-5);
  CHECK(same_bits(packing, taken(scene, folder.path() / "again")));
  // as any deposit it can be stopped
  const Packing tile = taken(one, folder.path());
  const fs::path part = folder.path() / "part";
  const auto deposit_steps = [&](int steps, Packing& made) {
    const auto stop = [&](BoxStage, double, const StepRecord&) { return --steps > 0; };
    return deposit(scene, make_rain(scene), part, stop, made, &tile);
  };
  Packing made;
  CHECK_FALSE(deposit_steps(7, made));
  CHECK(read_checkpoint(part).phase == "rain");
  CHECK(deposit_steps(10000, made));
  CHECK(same_bits(made, packing));
}

TEST_CASE("tiles that do not divide the box are refused by name") {
  CHECK_THAT(run_error([] { tiled_box({"grains.count=31"}); }),
             Contains("deposit.tiles_x") && Contains("no multiple of 6 tiles"));
  CHECK_THAT(run_error([] {
               small_box({"grains.count=6", "deposit.tiles_y=3"});
             }),
             Contains("box.width") && Contains("narrower than the largest grain"));
}

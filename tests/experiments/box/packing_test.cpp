#include "experiments/box/packing.hpp"

#include <iostream>

#include "tests/experiments/box/small_box.hpp"
#include "tests/support/sample_run.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// Deposits without a stop and lists the stages that it reports in `stages`.
Packing deposited(const Scene& scene, const fs::path& part, std::vector<BoxStage>& stages) {
  Packing packing;
  const auto listen = [&](BoxStage stage, double, const StepRecord&) {
    if (stages.empty() || stages.back() != stage) stages.push_back(stage);
    return true;
  };
  REQUIRE(deposit(scene, make_rain(scene), part, listen, packing));
  return packing;
}

}  // namespace

TEST_CASE("a deposit rains, presses and settles, its grains then lie in the box at rest") {
  const TemporaryFolder folder;
  const Scene scene = small_box();
  std::vector<BoxStage> stages;
  const Packing packing = deposited(scene, folder.path() / "part", stages);
  CHECK(stages == std::vector<BoxStage>{BoxStage::rain, BoxStage::press, BoxStage::settle});
  CHECK(packing.deposit.lid == packing.deposit.top + scene.drive.lid_raise);
  CHECK(packing.deposit.rain_time > 0.0);
  CHECK(packing.deposit.rest_velocity < 10 * scene.deposit.rest_velocity);
  CHECK(packing.memory.contacts.size() == packing.memory.impulses.size());
  CHECK_FALSE(packing.memory.contacts.empty());
  MotionState state;
  const MechanicalSystem system = drive_system(scene, make_rain(scene), packing, state);
  CHECK((state.time == 0.0 && state.step == 0));
  CHECK(packing_top(system, state) < packing.deposit.lid);
  for (int b = 0; b < system.grain_count; ++b)
    for (const Vec3& vertex : system.bodies[b].shape.polyhedron->vertices())
      CHECK((state.pose[b] * vertex).minCoeff() > -1e-3);

  // Without pressure the lid is placed over the highest grain.
  const Scene unpressed = small_box({"deposit.lid_pressure_weight=0"});
  stages.clear();
  const DepositState free = deposited(unpressed, folder.path() / "free", stages).deposit;
  CHECK(stages == std::vector<BoxStage>{BoxStage::rain, BoxStage::settle});
  CHECK(free.lid == free.top + unpressed.drive.lid_raise);
}

TEST_CASE("a deposit stopped in every stage goes on to the same bits") {
  const TemporaryFolder folder;
  const Scene scene = small_box();
  std::vector<BoxStage> stages;
  const Packing whole = deposited(scene, folder.path() / "whole", stages);
  const fs::path part = folder.path() / "part";
  const int steps_each = GENERATE(37, 1);  // 1: also stops in the last step of every stage
  Packing packing;
  std::vector<std::string> phases;
  for (int calls = 0, stops = 0;; calls = 0) {
    REQUIRE(++stops < 5000);
    const auto stop = [&](BoxStage, double, const StepRecord&) { return ++calls < steps_each; };
    if (deposit(scene, make_rain(scene), part, stop, packing)) break;
    phases.push_back(read_checkpoint(part).phase);
  }
  for (const char* phase : {"rain", "press", "settle"})
    CHECK(std::count(phases.begin(), phases.end(), phase) > 0);
  CHECK(same_bits(packing, whole));
}

TEST_CASE("a part of another deposit is not gone on with") {
  const TemporaryFolder folder;
  const fs::path part = folder.path() / "part";
  const auto stop = [](BoxStage, double, const StepRecord&) { return false; };
  Packing packing;
  const Scene other = small_box({"grains.seed=5"}), scene = small_box();
  REQUIRE_FALSE(deposit(other, make_rain(other), part, stop, packing));
  CHECK(read_checkpoint(part).key == packing_key(other));
  std::vector<BoxStage> stages, unstopped;
  CHECK(same_bits(deposited(scene, part, stages),
                  deposited(scene, folder.path() / "none", unstopped)));
}

TEST_CASE("grains that do not come to rest in time are an error that says what to raise") {
  const TemporaryFolder folder;
  const Scene scene = small_box({"deposit.max_time=0.01"});
  const auto go_on = [](BoxStage, double, const StepRecord&) { return true; };
  Packing packing;
  CHECK_THAT(
      run_error([&] { deposit(scene, make_rain(scene), folder.path() / "part", go_on, packing); }),
      Contains("deposit.max_time = 0.01") && Contains("deposit.rest_velocity"));
}

TEST_CASE("a packing is given only to whom it belongs") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "packing.bin";
  Packing written{"key", "packing", sample_state(sample_system(), 3), {}, {}}, read;
  CHECK_FALSE(read_packing(file, "key", read));
  write_checkpoint(file, written);
  REQUIRE(read_packing(file, "key", read));
  CHECK(same_bits(read, written));
  const auto refusal = [&](const std::string& key) {
    return run_error([&] { read_packing(file, key, read); });
  };
  CHECK_THAT(refusal("other"), Contains("a packing of other settings"));
  // The state of an unfinished deposit is not a packing.
  written.phase = "settle";
  write_checkpoint(file, written);
  CHECK_THAT(refusal("key"), Contains("a packing of other settings"));
}

TEST_CASE("a noise at the start moves every grain a little, by its seed, and the packing stays") {
  const TemporaryFolder folder;
  const Scene quiet = small_box(),
              noisy = small_box({"drive.start_noise=1e-9", "drive.start_noise_seed=5"}),
              other = small_box({"drive.start_noise=1e-9", "drive.start_noise_seed=6"});
  CHECK(packing_key(quiet) == packing_key(noisy));
  std::vector<BoxStage> stages;
  const Packing packing = deposited(quiet, folder.path() / "part", stages);
  const Rain rain = make_rain(quiet);
  MotionState from, moved, again, differently;
  drive_system(quiet, rain, packing, from);
  drive_system(noisy, rain, packing, moved);
  drive_system(noisy, rain, packing, again);
  drive_system(other, rain, packing, differently);
  CHECK(same_bits(moved.pose, again.pose));
  CHECK_FALSE(same_bits(moved.pose, differently.pose));
  for (size_t b = 0; b < from.pose.size(); ++b) {
    const double way = (moved.pose[b].position - from.pose[b].position).cwiseAbs().maxCoeff();
    if (b < rain.grains.size())
      CHECK((way > 0.0 && way < 1.1e-9));
    else
      CHECK(way == 0.0);
  }
}

namespace {

/// Catches what is written to a stream during its lifetime.
class Heard {
 public:
  explicit Heard(std::ostream& stream) : stream_(stream), old_(stream.rdbuf(text_.rdbuf())) {}
  ~Heard() { stream_.rdbuf(old_); }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::ostream& stream_;
  std::streambuf* old_;
};

struct Taken {
  bool there = false;
  Packing packing;
  std::string said;
};

Taken take(const Scene& scene, const fs::path& cache, bool keep_going = true) {
  const Heard said(std::cout), shown(std::cerr);
  Taken taken;
  const PackingOptions order{cache, [&] { return keep_going; }, Progress::Style::lines};
  taken.there = load_or_deposit(scene, make_rain(scene), order, taken.packing);
  taken.said = said.text();
  return taken;
}

}  // namespace

TEST_CASE("a packing is deposited once and then taken from the cache, with the same bits") {
  const TemporaryFolder folder;
  const fs::path cache = folder.path() / "packings";
  const Scene scene = small_box();
  const Taken first = take(scene, cache);
  REQUIRE(first.there);
  CHECK_THAT(first.said, Contains("depositing 5 grains"));
  const fs::path file = packing_file(cache, packing_key(scene));
  CHECK(file == cache / ("packing-" + packing_key(scene) + ".bin"));
  CHECK(fs::exists(file));
  CHECK_FALSE(fs::exists(file.string() + ".part"));
  const std::string bytes = file_bytes(file);

  const Taken second = take(scene, cache);
  REQUIRE(second.there);
  CHECK_THAT(second.said, Contains("packing from the cache"));
  CHECK(same_bits(second.packing, first.packing));

  SECTION("a damaged packing is an error, not a new deposit") {
    put_bytes(file, bytes.substr(0, bytes.size() / 2));
    CHECK_THAT(run_error([&] { take(scene, cache); }), Contains("checkpoint is truncated"));
  }
  SECTION("another scene has another packing") {
    CHECK_THAT(take(small_box({"grains.seed=9"}), cache).said, Contains("depositing 5 grains"));
  }
}

TEST_CASE("a deposit that is stopped leaves its part, and the next order goes on with it") {
  const TemporaryFolder folder;
  const Scene scene = small_box();
  const fs::path file = packing_file(folder.path(), packing_key(scene));
  CHECK_FALSE(take(scene, folder.path(), false).there);
  CHECK_FALSE(fs::exists(file));
  CHECK(read_checkpoint(file.string() + ".part").state.step == 1);
  const Packing finished = take(scene, folder.path()).packing;
  CHECK(same_bits(finished, take(scene, folder.path() / "elsewhere").packing));
  CHECK_FALSE(fs::exists(file.string() + ".part"));
}

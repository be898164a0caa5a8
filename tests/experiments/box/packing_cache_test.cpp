#include "experiments/box/packing_cache.hpp"

#include <iostream>

#include "tests/experiments/box/small_box.hpp"
#include "tests/support/sample_run.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// What the cache says on stdout and stderr stays here.
class Swallowed {
 public:
  Swallowed() : out_(std::cout.rdbuf(said_.rdbuf())), error_(std::cerr.rdbuf(shown_.rdbuf())) {}
  ~Swallowed() {
    std::cout.rdbuf(out_);
    std::cerr.rdbuf(error_);
  }
  std::string said() const { return said_.str(); }

 private:
  std::ostringstream said_, shown_;
  std::streambuf *out_, *error_;
};

struct Taken {
  bool there = false;
  Packing packing;
  double seconds = -1.0;  ///< stays negative where nothing was deposited
  std::string said;
};

Taken take(const Scene& scene, const fs::path& cache, bool anew = false, bool goes_on = true) {
  const Swallowed swallowed;
  Taken taken;
  const PackingOrder order{cache, anew, [&] { return goes_on; }};
  taken.there = take_packing(scene, make_rain(scene), order, taken.packing, taken.seconds);
  taken.said = swallowed.said();
  return taken;
}

}  // namespace

TEST_CASE("a packing is deposited once and then taken from the cache, with the same bits") {
  const TemporaryFolder folder;
  const fs::path cache = folder.path() / "packings";
  const Scene scene = small_box();
  const Taken first = take(scene, cache);
  REQUIRE(first.there);
  CHECK(first.seconds > 0.0);
  CHECK_THAT(first.said, Contains("depositing 5 grains"));
  const fs::path file = packing_file(cache, packing_key(scene));
  CHECK(file == cache / ("packing-" + packing_key(scene) + ".bin"));
  CHECK(fs::exists(file));
  CHECK_FALSE(fs::exists(file.string() + ".part"));
  const std::string bytes = file_bytes(file);

  const Taken second = take(scene, cache);
  REQUIRE(second.there);
  CHECK(second.seconds < 0.0);
  CHECK_THAT(second.said, Contains("packing from the cache"));
  CHECK(same_bits(second.packing.state.pose, first.packing.state.pose));
  CHECK(same_bits(second.packing.memory.impulses, first.packing.memory.impulses));

  SECTION("anew: deposited again, to the same bytes") {
    const Taken again = take(scene, cache, true);
    CHECK(again.seconds > 0.0);
    CHECK(file_bytes(file) == bytes);
  }
  SECTION("a damaged packing is an error, not a new deposit") {
    put_bytes(file, bytes.substr(0, bytes.size() / 2));
    CHECK_THAT(run_error([&] { take(scene, cache); }), Contains("checkpoint is truncated"));
  }
  SECTION("another scene has another packing") {
    CHECK(take(small_box({"grains.seed=9"}), cache).seconds > 0.0);
  }
}

TEST_CASE("a deposit that is stopped leaves its part, and the next order goes on with it") {
  const TemporaryFolder folder;
  const Scene scene = small_box();
  const fs::path file = packing_file(folder.path(), packing_key(scene));
  CHECK_FALSE(take(scene, folder.path(), false, false).there);
  CHECK_FALSE(fs::exists(file));
  CHECK(read_checkpoint(file.string() + ".part").state.step == 1);
  const Taken finished = take(scene, folder.path());
  const TemporaryFolder elsewhere;
  CHECK(same_bits(finished.packing.state.pose, take(scene, elsewhere.path()).packing.state.pose));
  CHECK_FALSE(fs::exists(file.string() + ".part"));
}

#pragma once
// A deposited box of a dozen grains, which the tests of `ballast bench` measure.

#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/bench/measurement.hpp"
#include "experiments/bench/step_bench.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {

inline const std::vector<std::string> tiny = {"grains.count=12", "box.length=0.12",
                                              "box.width=0.12", "control_volume.margin_x=0.02"};

struct Silence {
  Silence() : old(std::cout.rdbuf(sink.rdbuf())) {}
  ~Silence() { std::cout.rdbuf(old); }
  std::ostringstream sink;
  std::streambuf* old;
};

/// The box that all tests of this program share.
inline const DepositedBox& tiny_box() {
  static const DepositedBox box = [] {
    const TemporaryFolder folder;
    const Silence silence;
    const Scene scene = bench_scene("vibrated_box_small", tiny);
    deposited_box(scene, folder.path());
    return deposited_box(scene, folder.path());  // from the cache
  }();
  return box;
}

inline double value_of(const std::vector<Measurement>& measurements, const std::string& name) {
  for (const Measurement& m : measurements)
    if (m.full_name() == name) return m.median;
  FAIL("no measurement " << name);
  return 0.0;
}

}  // namespace ballast

#pragma once
// Deposited packings, kept: each is made once, also by processes that want it at the same time.

#include <deque>
#include <filesystem>
#include <functional>
#include <string>

#include "experiments/box/deposit.hpp"
#include "experiments/record/progress.hpp"

namespace ballast {

/// After the grains have fallen their speed falls off about exponentially: the straight line
/// through the logarithms of its last values says when it will be small enough.
class RestForecast {
 public:
  /// `at_rest`: the speed that counts as rest [m/s]. Nothing rests before `earliest` [s].
  RestForecast(double at_rest, double earliest) : at_rest_(at_rest), earliest_(earliest) {}

  /// One step: simulated time [s], speed [m/s].
  void note(double time, double speed);
  /// The time of rest [s]; NaN while the speed does not fall.
  double end() const;

 private:
  struct Sample {
    double time, logarithm;
  };
  double at_rest_, earliest_;
  std::deque<Sample> samples_;
};

/// The packing of this key (packing_key of a scene) in the folder where packings are kept.
std::filesystem::path packing_file(const std::filesystem::path& cache, const std::string& key);

struct PackingOrder {
  std::filesystem::path cache;    ///< the folder; made if it isn't there
  bool anew = false;              ///< deposit again even if it is there
  std::function<bool()> goes_on;  ///< asked once per step, and while waiting; false stops, to be
                                  ///< continued another time
  Telling telling = Telling::reader;
};

/// The scene's packing from the cache; where it is missing it is deposited, or waited for when
/// another process is depositing it. Says on stdout which, on stderr how far. False: stopped.
/// `deposit_seconds`: set when this process deposited [s of wall clock]. Throws Error: it does
/// not come to rest, the file is broken or cannot be written.
bool take_packing(const Scene& scene, const Rain& rain, const PackingOrder& order, Packing& packing,
                  double& deposit_seconds);

}  // namespace ballast

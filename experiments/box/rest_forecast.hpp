#pragma once
// When falling grains will be at rest, from how their speed has fallen off so far.

#include <deque>

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

}  // namespace ballast

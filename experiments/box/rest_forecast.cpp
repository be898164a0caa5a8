#include "experiments/box/rest_forecast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ballast {
namespace {

constexpr double between = 5e-3;  // samples [s]
constexpr size_t most = 16, least = 4;

}  // namespace

void RestForecast::note(double time, double speed) {
  if (!(speed > 0.0) || (!samples_.empty() && time < samples_.back().time + between)) return;
  samples_.push_back({time, std::log(speed)});
  if (samples_.size() > most) samples_.pop_front();
}

double RestForecast::end() const {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  if (samples_.size() < least) return unknown;
  // Least squares through (time, logarithm).
  double time = 0.0, logarithm = 0.0;
  const auto count = static_cast<double>(samples_.size());
  for (const Sample& sample : samples_) {
    time += sample.time / count;
    logarithm += sample.logarithm / count;
  }
  double square = 0.0, product = 0.0;
  for (const Sample& sample : samples_) {
    square += (sample.time - time) * (sample.time - time);
    product += (sample.time - time) * (sample.logarithm - logarithm);
  }
  const double slope = product / square;
  if (!(slope < 0.0)) return unknown;
  // log speed falls along the line logarithm + slope (t - time), and meets that of rest there.
  const double rest = time + (std::log(at_rest_) - logarithm) / slope;
  return std::max({rest, earliest_, samples_.back().time});
}

}  // namespace ballast

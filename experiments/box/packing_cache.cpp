#include "experiments/box/packing_cache.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"

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

namespace fs = std::filesystem;
namespace {

void say(Telling telling, const std::string& words) {
  if (telling == Telling::reader) std::cout << words << std::endl;
}

bool find_packing(const fs::path& file, const std::string& key, Telling telling, Packing& packing) {
  if (!read_packing(file, key, packing)) return false;
  say(telling, "packing from the cache: " + file.string());
  return true;
}

/// deposit() with a line that says how far it is.
bool deposit_visibly(const Scene& scene, const Rain& rain, const fs::path& part,
                     const PackingOrder& order, Packing& packing) {
  Progress progress(order.telling);
  BoxStage last = BoxStage::rain;
  RestForecast rest(scene.deposit.rest_velocity,
                    std::sqrt(2.0 * rain.height / deposit_gravity(scene).norm()));
  const auto show = [&](BoxStage stage, double time, double velocity, const StepRecord& record) {
    if (stage != last) progress.restart();
    last = stage;
    // The rain ends when it rests: its limit says nothing of when that is.
    if (stage == BoxStage::rain) rest.note(time, velocity);
    const double end[] = {std::min(rest.end(), scene.deposit.max_time), scene.deposit.lid_time,
                          scene.deposit.settle_time};
    progress.show(name_of(stage), time, end[static_cast<int>(stage)], record, velocity);
    return order.goes_on();
  };
  const bool is_done = deposit(scene, rain, part, show, packing);
  progress.finish();
  return is_done;
}

}  // namespace

fs::path packing_file(const fs::path& cache, const std::string& key) {
  return (cache / ("packing-" + key + ".bin")).lexically_normal();
}

bool take_packing(const Scene& scene, const Rain& rain, const PackingOrder& order, Packing& packing,
                  double& deposit_seconds) {
  const std::string key = packing_key(scene);
  const fs::path file = packing_file(order.cache, key), part = file.string() + ".part";
  // without the lock: a packing that is there is whole
  if (!order.anew && find_packing(file, key, order.telling, packing)) return true;
  create_folder(order.cache);
  // one process deposits, the others wait for it
  const FileLock lock(file.string() + ".lock", [&](double waited) {
    if (waited == 0.0) say(order.telling, "waiting for the packing that another run deposits");
    return order.goes_on();
  });
  if (!lock.is_held()) return false;
  if (order.anew) {
    fs::remove(file);
    fs::remove(part);
  }
  if (find_packing(file, key, order.telling, packing))
    return true;  // made by whoever held the lock
  say(order.telling, "depositing " + std::to_string(rain.grains.size()) + " grains (kept in " +
                         file.string() + ")");
  const Stopwatch watch;
  if (!deposit_visibly(scene, rain, part, order, packing)) return false;
  write_packing(file, key, packing);
  fs::remove(part);
  deposit_seconds = watch.seconds();
  return true;
}

}  // namespace ballast

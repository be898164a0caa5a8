#include "experiments/bench/machine_facts.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "platform/clock.hpp"
#include "platform/for_each_cpu.hpp"

// Vectors stay inside inlined functions, so GCC's note about their calling convention does not
// apply.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace ballast {
namespace {

using Vector8 = double __attribute__((vector_size(64)));
/// A cache line, which std::vector aligns as one.
struct alignas(64) CacheLine {
  Vector8 lanes;
};

/// Keeps a result from being optimised away.
volatile double kept;

BALLAST_FOR_EACH_CPU double sum_of(const CacheLine* values, size_t count) {
  Vector8 sums[4] = {};  // four chains hide the latency
  for (size_t i = 0; i + 4 <= count; i += 4)
    for (size_t k = 0; k < 4; ++k) sums[k] += values[i + k].lanes;
  const Vector8 sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
  return sum[0] + sum[7];
}

/// a = b + s c: two streams are read and one is written.
BALLAST_FOR_EACH_CPU void triad(CacheLine* a, const CacheLine* b, const CacheLine* c, double s,
                                size_t count) {
  for (size_t i = 0; i < count; ++i) a[i].lanes = b[i].lanes + s * c[i].lanes;
}

/// A round multiplies and adds in ten vectors of eight: ten chains hide the latency.
constexpr int chains = 10;
constexpr double flops_of_round = 2.0 * 8.0 * chains;
BALLAST_FOR_EACH_CPU double multiply_and_add(long rounds) {
  const Vector8 start = {1, 2, 3, 4, 5, 6, 7, 8}, zero = {}, factor = zero + 0.999999,
                shift = zero + 1e-6;
  Vector8 x[chains];
#pragma GCC unroll 10
  for (Vector8& chain : x) chain = start;
  for (long i = 0; i < rounds; ++i)
#pragma GCC unroll 10
    for (int k = 0; k < chains; ++k) x[k] = x[k] * factor + shift;
  Vector8 sum = zero;
#pragma GCC unroll 10
  for (int k = 0; k < chains; ++k) sum += x[k];
  return sum[0] + sum[7];
}

/// Least time of one call among `passes`.
template <typename Work>
double best_seconds(int passes, const Work& work) {
  double best = 1e300;
  for (int pass = 0; pass < passes; ++pass) {
    const Stopwatch watch;
    work();
    best = std::min(best, watch.seconds());
  }
  return best;
}

std::vector<CacheSize> cache_sizes() {
  std::vector<CacheSize> caches;
  for (int index = 0; index < 8; ++index) {
    const std::filesystem::path folder =
        "/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(index);
    std::string level, type, size;
    if (!(std::ifstream(folder / "level") >> level && std::ifstream(folder / "type") >> type &&
          std::ifstream(folder / "size") >> size))
      continue;
    if (type == "Instruction") continue;
    caches.push_back({"L" + level + (type == "Data" ? "d" : ""), std::stod(size)});  // "32K"
  }
  return caches;
}

}  // namespace

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double read_bandwidth(std::size_t bytes) {
  const std::vector<CacheLine> values(std::max<size_t>(4, bytes / sizeof(CacheLine) / 4 * 4));
  const size_t size = values.size() * sizeof(CacheLine);
  // what is small is read often, so that a pass lasts long enough to be timed
  const size_t again = std::max<size_t>(1, (size_t{1} << 24) / size);
  const double seconds = best_seconds(10, [&] {
    for (size_t k = 0; k < again; ++k) kept = sum_of(values.data(), values.size());
  });
  return 1e-9 * static_cast<double>(size * again) / seconds;
}

MachineFacts measure_machine() {
  MachineFacts facts;
  facts.caches = cache_sizes();
  const double last = facts.caches.empty() ? 0.0 : facts.caches.back().kilobytes * 1024.0;
  const size_t bytes = static_cast<size_t>(std::max(256e6, 4.0 * last));
  facts.read_GB_s = read_bandwidth(bytes);
  std::vector<CacheLine> a(bytes / 3 / sizeof(CacheLine)), b = a, c = a;
  facts.triad_GB_s = 1e-9 * 3.0 * static_cast<double>(a.size() * sizeof(CacheLine)) /
                     best_seconds(5, [&] { triad(a.data(), b.data(), c.data(), 0.5, a.size()); });
  const long rounds = 200000;
  facts.gflops = 1e-9 * flops_of_round * static_cast<double>(rounds) /
                 best_seconds(10, [&] { kept = multiply_and_add(rounds); });
  return facts;
}

}  // namespace ballast

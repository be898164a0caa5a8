#include "experiments/bench/machine_facts.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "platform/clock.hpp"

// Vectors stay inside inlined functions, so GCC's note about their calling convention does not
// apply.
#pragma GCC diagnostic ignored "-Wpsabi"

#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__clang__)
#define BALLAST_FOR_EACH_CPU __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define BALLAST_FOR_EACH_CPU
#endif

namespace ballast {
namespace {

using Vector8 = double __attribute__((vector_size(64)));

/// Keeps a result from being optimised away.
volatile double kept;

BALLAST_FOR_EACH_CPU double sum_of(const double* values, size_t count) {
  Vector8 sums[4] = {};
  for (size_t i = 0; i + 32 <= count; i += 32)
    for (int k = 0; k < 4; ++k) sums[k] += *reinterpret_cast<const Vector8*>(values + i + 8 * k);
  double sum = 0.0;
  for (const Vector8& s : sums)
    for (int k = 0; k < 8; ++k) sum += s[k];
  return sum;
}

BALLAST_FOR_EACH_CPU void triad(double* a, const double* b, const double* c, double s,
                                size_t count) {
  for (size_t i = 0; i < count; ++i) a[i] = b[i] + s * c[i];
}

/// 2 * 8 * 10 flops a round: ten chains hide the latency.
BALLAST_FOR_EACH_CPU double multiply_and_add(long rounds) {
  Vector8 x0 = {1, 2, 3, 4, 5, 6, 7, 8}, x1 = x0, x2 = x0, x3 = x0, x4 = x0, x5 = x0, x6 = x0,
          x7 = x0, x8 = x0, x9 = x0;
  const Vector8 factor = x0 * 0.0 + 0.999999, shift = x0 * 0.0 + 1e-6;
  for (long i = 0; i < rounds; ++i) {
    x0 = x0 * factor + shift;
    x1 = x1 * factor + shift;
    x2 = x2 * factor + shift;
    x3 = x3 * factor + shift;
    x4 = x4 * factor + shift;
    x5 = x5 * factor + shift;
    x6 = x6 * factor + shift;
    x7 = x7 * factor + shift;
    x8 = x8 * factor + shift;
    x9 = x9 * factor + shift;
  }
  const Vector8 sum = x0 + x1 + x2 + x3 + x4 + x5 + x6 + x7 + x8 + x9;
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

/// Doubles on a cache line's border.
struct AlignedDoubles {
  explicit AlignedDoubles(size_t count) : storage(count + 8, 1.0) {
    first =
        reinterpret_cast<double*>((reinterpret_cast<size_t>(storage.data()) + 63) & ~size_t{63});
  }
  std::vector<double> storage;
  double* first;
};

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
  const size_t count = std::max<size_t>(bytes / sizeof(double) / 32 * 32, 32);
  const AlignedDoubles values(count);
  const int again =
      static_cast<int>(std::max<size_t>(1, (size_t{1} << 24) / (count * sizeof(double))));
  const double seconds = best_seconds(10, [&] {
    for (int k = 0; k < again; ++k) kept = sum_of(values.first, count);
  });
  return 1e-9 * static_cast<double>(count * sizeof(double)) * again / seconds;
}

MachineFacts measure_machine() {
  MachineFacts facts;
  facts.caches = cache_sizes();
  const double last = facts.caches.empty() ? 0.0 : facts.caches.back().kilobytes * 1024.0;
  const size_t bytes = static_cast<size_t>(std::max(256e6, 4.0 * last));
  facts.read_GB_s = read_bandwidth(bytes);
  const size_t count = bytes / 3 / sizeof(double);
  AlignedDoubles a(count), b(count), c(count);
  facts.triad_GB_s = 1e-9 * 3.0 * sizeof(double) * static_cast<double>(count) /
                     best_seconds(5, [&] { triad(a.first, b.first, c.first, 0.5, count); });
  const long rounds = 200000;
  facts.gflops = 1e-9 * 160.0 * static_cast<double>(rounds) /
                 best_seconds(10, [&] { kept = multiply_and_add(rounds); });
  return facts;
}

}  // namespace ballast

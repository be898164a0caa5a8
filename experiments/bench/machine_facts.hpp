#pragma once
// What this machine can do, measured on one core: the limits that kernels are held against.

#include <cstddef>
#include <string>
#include <vector>

namespace ballast {

struct CacheSize {
  std::string name;  ///< "L1d", "L2", "L3": as the kernel lists those of the first core
  double kilobytes = 0.0;
};

struct MachineFacts {
  std::vector<CacheSize> caches;
  double read_GB_s = 0.0;   ///< of an array four times the last cache, at least 256 MB
  double triad_GB_s = 0.0;  ///< a[i] = b[i] + s c[i] of such arrays; three transfers counted
  double gflops = 0.0;  ///< multiplications and additions apart, as our build makes them (no fused
                        ///< ones), widest vectors
};

/// Takes about half a second; best of several passes, because others may share the machine.
MachineFacts measure_machine();

/// GB/s at which one core reads again and again what has this size: of a working set's home.
double read_bandwidth(std::size_t bytes);

/// CPU seconds of this process, all threads.
double cpu_seconds();

}  // namespace ballast

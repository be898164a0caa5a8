#pragma once
// Deposited packings, kept: each is made once, also by processes that want it at the same time.

#include <filesystem>
#include <functional>
#include <string>

#include "experiments/box/deposit.hpp"
#include "experiments/record/progress.hpp"

namespace ballast {

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
/// `deposit_seconds`: set when this process deposited [s of wall clock]. Throws Error: it does not
/// come to rest, the file is broken or cannot be written.
bool take_packing(const Scene& scene, const Rain& rain, const PackingOrder& order, Packing& packing,
                  double& deposit_seconds);

}  // namespace ballast

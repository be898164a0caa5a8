#pragma once
// A collection of problems that everybody can make: the same files on every machine, a manifest of
// what is in each, and a reference solution of each where one is found.
//
//   collection.toml                     the list that it was made from
//   problems/<family>/<name>.hdf5       FCLIB, with a group /ballast where a run met the problem
//   held/<family>/...                   the held part, where it is kept apart
//   references/<family>/<name>.exact    the reference (reference_of); depends on the time it had
//   manifest.csv                        a line for each problem: the same on every machine
//   references.csv                      a line for each reference
//   runs/<name>, packings/              what the problems were taken from; may be removed

#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "experiments/compare/collection_list.hpp"
#include "platform/error.hpp"

namespace ballast {

struct CollectionOptions {
  std::filesystem::path folder;
  bool keeps_held_apart = false;   ///< in held/, away from those that a method is tuned on
  double reference_seconds = 3.0;  ///< for the reference of one problem; 0: none is looked for
  int threads = 1;                 ///< of the runs: the same bits
};

/// Makes what is missing of the folder. `told` is called before each run. The code is that of the
/// first run that did not come to its end; nothing of it is lost. Problems without contacts, made
/// problems of which only W is known, and what is equal to an earlier problem are left out. Throws
/// Error.
ExitCode make_collection(const CollectionOptions& options, std::span<const CollectedRun> runs,
                         const std::function<void(const CollectedRun&)>& told);

/// Whether the problem of this key (CaseFacts::content) is one of the held fifth: no method is
/// tuned on it, and its results are told apart. The same on every machine.
bool is_held(const std::string& content);

}  // namespace ballast

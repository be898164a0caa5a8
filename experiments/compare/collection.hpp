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
#include <vector>

#include "experiments/run/capture.hpp"
#include "platform/error.hpp"

namespace ballast {

// Which problems it holds: a list in TOML (collection.toml), in which a world is an entry.

/// One run of a scene of which some steps are kept, or one word that makes problems.
struct CollectedRun {
  std::string family;  ///< the entry's name: "shaken"
  std::string name;    ///< unique in its list; the family and the values that vary: "shaken-25-1"
  bool is_large = false;  ///< belongs to the part that takes hours
  // of a scene
  std::string scene;                     ///< name or path; empty: the problems are made
  std::vector<std::string> overrides{};  ///< "dotted.key=value"
  CaptureSettings capture{};
  int bodies = 0;  ///< grains, or bodies where the scene has no grains
  long steps = 0;  ///< that are kept
  // of made problems
  std::string made{};  ///< "pile:contacts=100,count=5", a word of `ballast compare`
};

/// The list that is built in: collection.toml.
std::string collection_list();

/// Reads a list: tables [[family]] with the keys
///   name   letters, digits and _, no digit last; several entries may share it
///   scene, set, steps   what is run, overrides, which steps are kept (CaptureSettings)
///   vary   lists of texts: one run for each combination; a text has overrides between blanks
///   made   instead of a scene: words that make problems
///   part   "small" (default) or "large"
///   like   an entry further up: its scene, set, steps and vary hold where this one has none, and
///          this one's `set` is added to that one's
/// Every scene is resolved. Throws Error naming file, key and value.
std::vector<CollectedRun> read_collection(const std::filesystem::path& file);

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

#pragma once
// A collection of problems that everybody can make: the same files on every machine, a manifest
// that describes each problem, and a reference solution of each where one is found.
//
//   collection.toml                     the list that it was made from
//   problems/<family>/<name>.hdf5       FCLIB, with a group /ballast where a run met the problem
//   held/<family>/...                   the held part, where it is kept apart
//   references/<family>/<name>.exact    the reference (reference_of); depends on its time limit
//   manifest.csv                        a line for each problem: the same on every machine
//   references.csv                      a line for each reference
//   runs/<name>, packings/              the sources of the problems; may be removed

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "experiments/run/capture.hpp"
#include "platform/error.hpp"

namespace ballast {

// The list of a collection's problems: a TOML file (collection.toml), in which a world is an entry.

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
  long steps = 0;  ///< number of kept steps
  // of made problems
  std::string made{};  ///< "pile:contacts=100,count=5", a word of `ballast compare`
};

/// Returns the built-in list: collection.toml.
std::string collection_list();

/// Reads a list: tables [[family]] with the keys
///   name   letters, digits and _, a letter last; several entries may share it
///   scene, set, steps   the scene, its overrides, which steps are kept (CaptureSettings)
///   vary   lists of texts: one run for each combination; a text has overrides between blanks
///   made   instead of a scene: words that make problems
///   part   "small" (default) or "large"
///   like   an entry further up: its scene, set, steps and vary hold where this entry has none, and
///          this entry's `set` is added to the other's
/// Resolves every scene. Throws Error naming file, key and value.
std::vector<CollectedRun> read_collection(const std::filesystem::path& file);

struct CollectionOptions {
  std::filesystem::path folder;
  bool keeps_held_apart = false;   ///< held problems go to held/, apart from those for tuning
  double reference_seconds = 3.0;  ///< limit for the reference of one problem; 0: no search
  int threads = 1;                 ///< of the runs; changes no bit
};

/// Makes the missing parts of the folder. `told` is called before each run. The first run that does
/// not reach its end stops the work: its code is returned, and nothing of it is lost. Leaves out
/// problems without contacts, equal to an earlier one, or made with W alone. Throws Error.
ExitCode make_collection(const CollectionOptions& options, std::span<const CollectedRun> runs,
                         const std::function<void(const CollectedRun&)>& told);

/// Returns whether the problem with this key (CaseFacts::content) belongs to the held fifth: no
/// method is tuned on it, and its results are reported apart. The same on every machine.
bool is_held(const std::string& content);

}  // namespace ballast

#pragma once
// Which problems a collection holds: a list in TOML (collection.toml). A world is an entry there.

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/run/capture.hpp"

namespace ballast {

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

}  // namespace ballast

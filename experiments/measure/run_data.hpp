#pragma once
// The contents of a run's folder, read for the report: rows, manifest, scene.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "experiments/measure/run_summary.hpp"
#include "experiments/step/step_record.hpp"
#include "problems/scene/scene.hpp"

namespace ballast {

struct RunData {
  std::filesystem::path folder;
  std::vector<StepRecord> steps;
  std::shared_ptr<const nlohmann::ordered_json> stored_manifest;  ///< an object, or null
  std::string manifest_text, scene_text;                          ///< as in the files
  std::optional<Scene> scene;  ///< none where it can't be used any more
  RunFacts facts;
  std::vector<std::string> notices;  ///< for the reader of the report, one line on each thing
                                     ///< that is not finite or not usable

  /// The manifest; an empty object when there is none.
  const nlohmann::ordered_json& manifest() const;
};

struct MeasuredRun {
  RunData data;
  RunSummary summary;  ///< of these data
};

/// Parses the JSON object in the text of a file. Throws Error naming the file.
nlohmann::ordered_json json_object(const std::string& text, const std::filesystem::path& file);

/// Reads a run: its rows from record.h5 or, while it goes on, from its logs. Throws Error naming
/// the file when there is no record, no row, no time, or when rows, manifest or scene.toml cannot
/// be read. A scene that is wrong becomes a notice.
RunData read_run_data(const std::filesystem::path& folder);

}  // namespace ballast

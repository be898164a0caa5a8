#pragma once
// What a run's folder says about itself, read for the report: rows, manifest, scene.

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
  std::shared_ptr<const nlohmann::ordered_json> stored_manifest;  ///< an object, or nothing
  std::string manifest_text, scene_text;                          ///< as in the files
  std::optional<Scene> scene;  ///< of a run; none where it can't be used any more
  RunFacts facts;
  std::vector<std::string> notices;  ///< what was not finite or not usable: one line each, for the
                                     ///< reader of the report

  /// An object; empty when there is none.
  const nlohmann::ordered_json& manifest() const;
};

/// The object in a file's text. Throws Error naming the file.
nlohmann::ordered_json json_object(const std::string& text, const std::filesystem::path& file);

/// record.h5, or the logs of a run still going. Throws Error naming the file when there is no
/// record, no row, no time, or one of the three cannot be read. A scene that is wrong becomes
/// a notice.
RunData read_run_data(const std::filesystem::path& folder);

}  // namespace ballast

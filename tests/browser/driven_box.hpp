#pragma once
// The page of a run, as the tests in a browser use it: a small driven box, and its controls.

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/record/recorder.hpp"
#include "experiments/run/run.hpp"
#include "experiments/run_page/report.hpp"
#include "tests/support/browser.hpp"

namespace ballast {

inline constexpr const char* is_ready = "window.ballastReplay || window.ballastReplayError";

/// A small box that was driven for 20 ms, with its page and its record. driven_box() makes it.
struct DrivenBox {
  DrivenBox() {
    RunOptions options;
    options.scene = "vibrated_box_small";
    options.overrides = {"scene.duration=0.02", "record.pose_rate=500", "record.forces=true",
                         "drive.f_max_over_weight=30"};
    options.output = place.path() / "run";
    run(options);
    write_report(options.output);
    folder = options.output;
    frames = read_poses(folder);
    steps = read_steps(folder);
  }
  std::filesystem::path page() const { return folder / "report.html"; }

  const TemporaryFolder place;
  std::filesystem::path folder;
  std::vector<MotionState> frames;
  std::vector<StepRecord> steps;
};

/// The box that all tests of a process share.
inline const DrivenBox& driven_box() {
  static const DrivenBox box;
  return box;
}

/// JavaScript: the picture of a stage as bytes (red, green, blue, alpha), the lowest row first.
inline std::string pixels_of(const std::string& stage = "ballastReplay.stages[0]") {
  return R"(((stage) => {
    const { gl, canvas } = stage, bytes = new Uint8Array(4 * canvas.width * canvas.height);
    ballastReplay.moving = false;
    ballastReplay.draw();
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return { width: canvas.width, height: canvas.height, bytes };
  })()" + stage +
         ")";
}

/// A checksum of the picture: different pictures give different numbers.
inline Browser::Json picture(Browser& browser) {
  return browser.js(pixels_of() + ".bytes.reduce((sum, v, k) => (sum + v * (k % 9973)) % 1e9, 0)");
}

inline std::string clicked(const std::string& id) {
  return "document.getElementById('replay-" + id + "').click()";
}

inline std::string chosen(const std::string& id, const std::string& value,
                          const std::string& event) {
  return "(() => { const e = document.getElementById('replay-" + id + "'); e.value = '" + value +
         "'; e.dispatchEvent(new Event('" + event + "')); })()";
}

}  // namespace ballast

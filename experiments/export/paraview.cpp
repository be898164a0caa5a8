#include "experiments/export/paraview.hpp"

#include <algorithm>
#include <string>

#include "experiments/export/vtp_file.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {

namespace fs = std::filesystem;

namespace {

/// Step of "<name>_<digits>.vtp", or -1.
long step_of_frame(const std::string& file, const std::string& name) {
  const std::string prefix = name + "_", suffix = ".vtp";
  if (file.size() <= prefix.size() + suffix.size() || file.rfind(prefix, 0) != 0 ||
      !file.ends_with(suffix))
    return -1;
  const size_t digits = file.size() - prefix.size() - suffix.size();
  return parsed<long>(std::string_view(file).substr(prefix.size(), digits)).value_or(-1);
}

}  // namespace

ParaviewSeries::ParaviewSeries(const fs::path& folder, const MechanicalSystem& system,
                               long last_step)
    : folder_(folder / "paraview"), system_(system) {
  create_folder(folder_);
  recover(grains_, last_step);
  recover(contacts_, last_step);
}

/// What the folder holds decides, not an old .pvd: a run may have died between a frame and its
/// entry.
void ParaviewSeries::recover(Series& series, long last_step) {
  std::vector<fs::path> obsolete;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    const long step = step_of_frame(entry.path().filename().string(), series.name);
    if (step < 0) continue;
    if (last_step > 0 && step <= last_step)
      series.frames.push_back({step, read_vtp_time(entry.path())});
    else
      obsolete.push_back(entry.path());
  }
  std::sort(series.frames.begin(), series.frames.end(),
            [](const Frame& a, const Frame& b) { return a.step < b.step; });
  write_collection(series);  // first: it must not name what is gone
  for (const fs::path& file : obsolete) {
    std::error_code error;
    fs::remove(file, error);
    if (error) throw Error(file.string() + ": cannot remove: " + error.message());
  }
}

fs::path ParaviewSeries::frame_file(const Series& series, long step) const {
  return folder_ / printed("%s_%08ld.vtp", series.name, step);
}

void ParaviewSeries::write_collection(const Series& series) const {
  const fs::path target = folder_ / (std::string(series.name) + ".pvd");
  if (series.frames.empty() && !is_there(target)) return;
  std::vector<std::pair<double, std::string>> frames;
  for (const Frame& frame : series.frames)
    frames.emplace_back(frame.time, frame_file(series, frame.step).filename().string());
  write_pvd(target, frames);
}

void ParaviewSeries::add(const MotionState& state) {
  write_grains_vtp(frame_file(grains_, state.step), system_, state);
  grains_.frames.push_back({state.step, state.time});
  write_collection(grains_);
}

void ParaviewSeries::add(const MotionState& state, std::span<const ContactPoint> contacts,
                         std::span<const Vec3> impulses, double h) {
  add(state);
  write_contacts_vtp(frame_file(contacts_, state.step), state.time, contacts, impulses, h);
  contacts_.frames.push_back({state.step, state.time});
  write_collection(contacts_);
}

}  // namespace ballast

#pragma once
// How the campaign's runs are put together: what may differ between them, their names, their
// scenes' overrides, what they cost.

#include <set>
#include <string>
#include <vector>

#include "experiments/paper/campaign.hpp"
#include "problems/scene/scene.hpp"

namespace ballast {

/// Everything in which runs of the campaign differ.
struct RunSettings {
  double frequency = varied_frequency, duration = varied_duration;  ///< [Hz], [s]
  double force = base_force;  ///< f_max/(m g) at the run's own g
  double gravity = base_gravity, wall_mass = base_wall_mass, step = base_step,
         friction = base_friction;
  std::string solver = "nncg", size = "radius";
  bool pressed = true;                      ///< the lid presses the deposit before it is raised
  double deposit_friction = base_friction;  ///< while the grains are deposited
  double lid_raise = base_lid_raise;        ///< [m]
  int iterations = 0;                       ///< 0: the campaign's
  double tolerance = 0.0;                   ///< of the solver [g h]; 0: the scene's
  std::string scene;                        ///< empty: the campaign's
  std::string variant;                      ///< what else differs: a word for the run's name
  std::vector<std::string> set;             ///< the variant's overrides, "dotted.key=value"
  int seed = 1;
  double pose_rate = 1.0;  ///< [1/s], without states
  bool states = false;     ///< keeps whole states
};

/// "%g"
std::string campaign_number(double value);
/// Simulated time of a run in which the frequency is varied: the paper's 1 s, at least three
/// periods [s].
double duration_at(double frequency);

/// Collects runs and points. Equal settings are one run.
class CampaignBuilder {
 public:
  /// Throws SceneFileError when the scene is none, or has no grains.
  explicit CampaignBuilder(const CampaignSettings& settings);

  /// Index of the run with these settings, added when it is not there yet.
  size_t run(RunSettings settings);
  /// One value of what is varied, for the first `seeds` samples.
  void point(Varied varied, double value, const std::string& label, RunSettings settings, int seeds,
             TimeWindow window = {});

  int seeds() const { return campaign.settings.seeds; }
  /// The scene that all runs vary.
  const Scene& scene() const { return scene_; }

  Campaign campaign;
  std::string stage;  ///< of the runs that come next

 private:
  std::vector<std::string> overrides_of(const RunSettings& settings) const;

  Scene scene_;
  std::set<std::string> packings_;
};

}  // namespace ballast

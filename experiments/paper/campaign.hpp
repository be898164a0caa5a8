#pragma once
// The runs from which the paper is reproduced: the one place that says which. Points (a value on an
// axis of a figure, for one seed) refer to runs; a run that serves several figures is made once.
// Runs are listed in the order of their importance, in stages: a campaign that is stopped by time
// has whole figures first.

#include <string>
#include <vector>

#include "experiments/measure/observables.hpp"
#include "experiments/plans/plan.hpp"

namespace ballast {

/// What is varied.
enum class Varied {
  frequency,
  force,
  gravity,
  wall_mass,
  iterations,
  iterations_fast,
  backend,
  time_step,
  size,
  lid,
  friction,
  deposit,
  loose_frequency,   ///< nu, from the loosest deposit
  rough_frequency,   ///< nu, with twice the friction
  strong_frequency,  ///< nu, under the largest load
  time_step_fast,
  // the stages of decisive_stages.cpp: three samples, 200 iterations a step or the tolerance
  box_length,               ///< L/H at 5 Hz
  box_length_fast,          ///< L/H at 20 Hz
  replica,                  ///< number of the perturbed start, 10 Hz
  replica_fast,             ///< the same at 60 Hz
  tight_frequency,          ///< nu, solver error at most 1e-2 g h
  tightest_frequency,       ///< nu, at most 1e-3 g h
  pressed_frequency,        ///< nu: lid pressed, mu 0.4 while depositing
  pressed_rough_frequency,  ///< nu: lid pressed, mu 0.8
  placed_frequency,         ///< nu: lid placed, mu 0.4
  placed_rough_frequency,   ///< nu: lid placed, mu 0.8
  light_frequency,          ///< nu: f_max = 6 m g, m_w = 0.1 m
  light_strong_frequency,   ///< nu: f_max = 12 m g, m_w = 0.1 m
  light_half_frequency,     ///< nu: f_max = 6 m g, m_w = 0.1 m, all at half scale
  shape,                    ///< number of the grains' kind at 5 Hz
  shape_fast,               ///< the same at 20 Hz
  size_similar,             ///< number of grains, the box growing in all directions, 5 Hz
  size_wide,                ///< number of grains, the box growing in y alone, 5 Hz
  reading_frequency,        ///< nu in vibrated_box_paper, the most probable reading of the paper
  exact_law,                ///< nu: 300 grains, ten samples, Coulomb's law (nncg)
  convex_law,               ///< nu: the same packings, its convex relaxation (sap)
  rule_frequency            ///< nu: plain sweeps stopped by LMGC90's rule
};

struct CampaignSettings {
  std::string scene = "vibrated_box";  ///< name or path
  std::vector<std::string> overrides;  ///< of every run, before the campaign's own
  int seeds = 3;        ///< samples of every scaling point: grains.seed = 1 ... seeds
  int iterations = 80;  ///< of the solver per step, where it is not what is varied
};

struct CampaignRun {
  PlannedRun planned;
  long steps = 0;        ///< of the drive
  double seconds = 0.0;  ///< estimate, one core, without the packing
  std::string stage;     ///< stages are run one after the other, the most important first
};

/// One place on an axis, for one seed.
struct CampaignPoint {
  Varied varied;
  double value = 0.0;  ///< nu [Hz], f_max/(m g0), g [m/s^2], m_w/m, iterations, h [s], mu; size,
                       ///< backend, deposit: number of the case
  std::string label;   ///< "10 Hz", "pgs", ...
  int seed = 1;
  size_t run = 0;     ///< index into Campaign::runs
  TimeWindow window;  ///< of the periods that count
  std::string stage;  ///< that asks for it; its run may be one of an earlier stage
};

struct Campaign {
  CampaignSettings settings;
  std::vector<CampaignRun> runs;
  std::vector<CampaignPoint> points;
  std::vector<size_t> motion;    ///< runs of Figs. 3-7 and 12: the paper's 5 Hz, one for each seed,
                                 ///< with stored states
  int packings = 0;              ///< different deposits
  double packing_seconds = 0.0;  ///< theirs, estimated

  long steps() const;
  double seconds() const;  ///< estimate, core-seconds, packings included
};

/// Which runs reproduce the paper. Throws SceneFileError when the scene is none, or no vibrated
/// box.
Campaign make_campaign(const CampaignSettings& settings);

/// f_max, g, m_w, solver and the rest are varied at this frequency: many periods in a short run
/// [Hz].
inline constexpr double varied_frequency = 10.0;
inline constexpr double varied_duration = 0.7;   ///< [s]
inline constexpr double motion_frequency = 5.0;  ///< the paper's Figs. 3-7, 12 [Hz]
inline constexpr double fast_frequency = 60.0;   ///< where a loose solver hurts most [Hz]
inline constexpr double fast_duration = 0.6;     ///< [s]
inline constexpr double base_force = 3.0;        ///< f_max/(m g) at g = 9.81 m/s^2
inline constexpr double base_gravity = 9.81;     ///< [m/s^2]; every packing is made under it
inline constexpr double base_wall_mass = 0.5;    ///< m_w/m
inline constexpr double base_step = 2e-4;        ///< the paper's h [s]
inline constexpr double base_friction = 0.4;

inline constexpr double fine_step = 5e-5;  ///< the finest h [s]
/// The frequencies at which another deposit, friction and load are driven too [Hz].
inline constexpr double compared_frequencies[] = {5.0, 10.0, 20.0, 60.0};
inline constexpr double half_scale_case =
    1.0;  ///< of Varied::size: everything at half scale but the lid's gap
inline constexpr double similar_case = 2.0;     ///< of Varied::size: the gap too
inline constexpr double base_lid_raise = 0.01;  ///< the paper's gap under the lid [m]

}  // namespace ballast

#pragma once
// The numbers of a run that its page, the rows of a campaign (paper_data.hpp) and the figures of
// the paper state. They are pure functions of the record, each computed in one place. NaN: not
// known. The table in docs/manual/paper.md defines them.
//
// Quantities of a period are means over the periods that count (defined in wall_cycles.hpp). Delta
// rho_1 is a mean of differences, not the slope of a line through the periods' means: it needs one
// period where a line needs two, and both ends of it are at the same phase of the load.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "experiments/measure/curve_fit.hpp"
#include "experiments/measure/wall_cycles.hpp"
#include "experiments/record/record_file.hpp"

namespace ballast {

// Roll of the grains: displacements over whole periods of the load, at the same phase, so that
// to-and-fro motion drops out, and their sense around a loop in the xz plane (paper, Fig. 6). Shear
// has a circulation, too; in a roll all four sides of a rectangle have the same sense.

/// The displacement of one grain.
struct Displacement {
  Vec3 place;  ///< mid-point of the way of its centre [m]
  Vec3 move;   ///< [m]
};

/// A rectangle in the xz plane; values are averaged over y.
struct XzRectangle {
  double x_lo, x_hi, z_lo, z_hi;  ///< [m]
};

/// The sense of the motion along the sides of a rectangle, positive clockwise with x to the right
/// (the driven wall) and z upwards: right along the top, down the right side, left along the
/// bottom, up the left side.
struct Roll {
  /// Mean displacement along top, right, bottom, left [m].
  std::array<double, 4> along{not_known, not_known, not_known, not_known};
  double circulation = not_known;  ///< its integral around the rectangle [m^2]
  /// The weakest side over the strongest, in the sense of the circulation. 1: all sides are alike.
  /// Negative: one side goes against it, and the grains do not go round.
  double side_ratio() const;
};
/// Grains within `reach` [m] of a side, about a grain's size, count for it. Where one side has no
/// grain the whole roll is not known.
Roll roll_of(std::span<const Displacement> displacements, const XzRectangle& rectangle,
             double reach);

/// Mean displacement on a grid over the rectangle, for a picture: places are the middles of the
/// cells, row by row from the lowest; cells without grains are left out.
std::vector<Displacement> cell_means(std::span<const Displacement> displacements,
                                     const XzRectangle& rectangle, int columns, int rows);

/// Facts that the record's rows do not contain (read_run_data finds them). Numbers that need an
/// unknown fact (NaN) are NaN.
struct RunFacts {
  double step = not_known;            ///< h [s]
  double velocity_scale = not_known;  ///< of errors [m/s]: g h, or 1 m/s without gravity
  /// The tolerance of the scene for the error of every step, over velocity_scale; not known without
  /// a scene or a tolerance.
  double tolerance = not_known;
  double gravity = not_known;                            ///< [m/s^2]
  double frequency = not_known;                          ///< nu of the load [Hz]
  double f_max = not_known, f_min = not_known;           ///< of the load [N]
  double grain_mass = not_known, wall_mass = not_known;  ///< m (all grains), m_w [kg]
  double solid_fraction_initial = not_known;             ///< before the drive
  bool has_wall = false, has_packing = false;            ///< a driven wall; a solid fraction
  // further settings of the scene
  std::uint64_t seed = 0;  ///< of the grains; it makes the sample
  std::string solver;
  double iterations_most = not_known;  ///< limit of the solver per step
  double seconds_most = not_known;     ///< the same limit by the clock [s]
  double slop = not_known;             ///< overlap that is not corrected [m]
  double grains = not_known;           ///< number of grains
  double length = not_known;           ///< L of the box [m]
  double height = not_known;           ///< H: top of the packing before the lid is raised [m]
  double lid_raise = not_known;        ///< [m]
  double volume_margin = not_known;    ///< from the wall's first place to the control volume [m]
  double largest_size = not_known;     ///< largest distance of a grain's centre to a vertex [m]
  double smallest_size = not_known;    ///< circumradius of the smallest body [m]
  double friction = not_known, deposit_friction = not_known;
  double lid_pressure = not_known;  ///< in grain weights while depositing; 0: the lid is placed

  double weight() const { return grain_mass * gravity; }  ///< m g [N]
};

/// X [m], the right side of Eq. 3 without C; m is the mass of all grains.
double eq3_displacement(const RunFacts& facts);

/// Targets for a run (docs: measures of the project), and values in the paper.
namespace target {
inline constexpr double penetration_max = 0.25e-3;  ///< [m]
inline constexpr double penetration_mean = 5e-6;    ///< [m]
inline constexpr double jammed_force = 1e-3;        ///< |f_g - f|/f_max
}  // namespace target
namespace paper {
inline constexpr double solid_fraction_initial = 0.50;
inline constexpr double solid_fraction_reference = 0.52;  ///< rho_0
inline constexpr double gain_per_period = 0.0025;  ///< Delta rho_1 / rho_0 below nu_c (Eq. 5)
inline constexpr double prefactor = 0.01;          ///< C of Eq. 3
}  // namespace paper

/// Wall clock by phase of the step.
struct PhaseCost {
  const char* name;
  double ms_per_step;
};

/// Sums over the run [J].
struct EnergyBalance {
  double residual = not_known;  ///< K_end - K_start - works + dissipation
  double relative = not_known;  ///< |residual| over the sum over steps of |a step's works|
  double gained = not_known;    ///< given by contacts, which no contact law does
  double moved = not_known;     ///< the sum of those works plus the largest kinetic energy
};

/// The fall of x at the start, to its least value within the first period, but at least 0.3 s.
struct FirstContraction {
  double size = not_known;    ///< [m]; 0 where x does not fall
  double time90 = not_known;  ///< when 90 % of it is reached [s]
};

/// Part of a run's time [s].
struct TimeWindow {
  double begin, end;
};
/// Where the paper measures compaction: from its time lag to the end of the run.
inline constexpr TimeWindow paper_window{0.2, 1e30};

/// The solid fraction rho and how it grows (paper, sec. 5, Eq. 4, Figs. 12 and 13). Of a run whose
/// wall enters the control volume it is not known: the wall displaces grains.
struct Compaction {
  bool has_wall_inside = false;      ///< the driven wall enters the control volume
  double reference = not_known;      ///< rho_0: at paper_window.begin
  double last = not_known;           ///< at the end of the run
  std::vector<double> gains;         ///< in each period that counts
  double gain = not_known;           ///< Delta rho_1: mean over them
  double relative_gain = not_known;  ///< Delta rho_1 / rho_0
  double rate = not_known;           ///< Eq. 4 over paper_window [1/s]
  double rate_common = not_known;    ///< Eq. 4 from 0.4 to 1 s [1/s]
  double rate_first = not_known;     ///< Eq. 4 from 0.2 to 1 s [1/s]
  double rate_late = not_known;      ///< Eq. 4 from 0.5 to 1.5 s [1/s]; NaN of a shorter run
};

struct RunSummary {
  RunFacts facts;
  long steps = 0;
  double duration = not_known;  ///< [s]

  std::vector<PhaseCost> cost;     ///< one per phase of the step, as step_phases()
  double ms_per_step = not_known;  ///< sum of the phases
  Statistics iterations, contacts, active_contacts;

  Statistics error_rms, error_max;                                         ///< [m/s]
  double error_mean_relative = not_known, error_max_relative = not_known;  ///< of error_rms over
                                                                           ///< velocity_scale
  double error_counted = not_known;  ///< mean relative error of the steps after the transient
  long missed = 0;  ///< steps that the judge does not call solved, where a tolerance is asked for

  double penetration_max = not_known;       ///< [m] in the whole run
  double penetration_max_time = not_known;  ///< [s]
  double penetration_mean = not_known;      ///< [m] over steps and active contact points

  EnergyBalance energy;

  // with a driven wall
  WallCycles wall;
  JammedState jammed;
  FirstContraction contraction;
  // over the periods that count
  Statistics rise, net, speed_in, speed_out, yield_load;  ///< as in WallPeriod
  double prefactor = not_known;                           ///< C of Eq. 3, m the mass of all grains
  ForceLaw law;  ///< f_g(xi) and f_g(f) while the wall moves

  // with a packing
  Compaction compaction;
  Roll roll;  ///< from stored poses (roll_of_periods); summarise has none and leaves it out
};

/// The displacements of grains over a summary's periods with a frame at both ends (to a step).
std::vector<Displacement> period_displacements(std::span<const MotionState> frames,
                                               const RunSummary& summary);
/// The roll around the middle half of the box over the periods of a summary. Not known where the
/// facts lack the box, or no period has frames at its ends.
Roll roll_of_periods(std::span<const MotionState> frames, const RunSummary& summary);

RunSummary summarise(std::span<const StepRecord> steps, const RunFacts& facts);

// Findings that a run's user must see unasked: steps that missed their tolerance, visible overlaps,
// energy that no contact law gives; and the remedy for each.

/// The unit of printed errors: g h, or m/s without gravity.
const char* error_unit(const RunSummary& run);

/// Returns whether there is no finding.
bool has_no_findings(const RunSummary& run);

/// One text for each finding: the finding, then its remedy. Without findings a single sentence says
/// so.
std::vector<std::string> run_findings(const RunSummary& run);

}  // namespace ballast

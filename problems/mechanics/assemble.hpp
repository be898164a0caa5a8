#pragma once
// Assembles a friction problem from bodies and contact points, with only what a scene needs: a
// fixed body has no unknown, a driven wall has one, and a frictionless contact has one row.

#include <span>
#include <vector>

#include "platform/worker_team.hpp"
#include "problems/algebra/friction_problem.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// Rows N, T1, T2 of a contact frame in the world frame. The tangents are a fixed function of the
/// normal.
Mat3 contact_frame(const Vec3& normal);

/// The input for one step's problem.
struct StepInput {
  const MotionState& state;  ///< poses at which the contacts were detected, velocities at the
                             ///< beginning of the step
  std::span<const ContactPoint> contacts;
  const Eigen::VectorXd& v_free;  ///< per unknown [m/s, rad/s]; copied unless it is the problem's
  double h;                       ///< length of the step [s]
  double end_time;  ///< of the step [s], which began at state.time; contacts are detected midway
};

struct ContactRows;

/// Turns the contacts of each step into a FrictionProblem, in the same buffers. The masses stay.
class ProblemAssembler {
 public:
  explicit ProblemAssembler(const MechanicalSystem& system);

  /// Shares the work from now on; null: one thread. No bit depends on it. `team` outlives the
  /// assembler.
  void use_team(WorkerTeam* team) { team_ = team; }

  /// Convert between unknowns and velocities. Bodies without freedom are skipped.
  int dof_count() const { return problem_.dynamics.dof_count(); }
  void pack(const MotionState& state, Eigen::VectorXd& v) const;
  void unpack(const Eigen::VectorXd& v, MotionState& state) const;
  /// First unknown of a body, or -1 without freedom.
  int first_dof(int body) const {
    return problem_body_[body] < 0 ? -1 : problem_.dynamics.dof_begin[problem_body_[body]];
  }

  /// Mass or moment of inertia of each unknown [kg, kg m^2]: the mass matrix is diagonal.
  const std::vector<double>& mass() const { return mass_; }

  /// Assembles one step's problem. A contact with restitution e > 0 is left out while it is open:
  /// Newton's law applies to closed contacts. Otherwise an open point acts only if it would close
  /// within the step, bias_N = gap / h.
  FrictionProblem& assemble(const StepInput& step) { return lay_out(step.contacts), fill(step); }
  /// The two halves of assemble(). lay_out() needs no team: it can run beside other work.
  void lay_out(std::span<const ContactPoint> contacts);
  FrictionProblem& fill(const StepInput& step);
  /// The problem assembled last; at first one without contacts.
  FrictionProblem& problem() { return problem_; }
  const FrictionProblem& problem() const { return problem_; }

  /// Index of each contact assembled last among the detected ones; points left out have none.
  std::span<const int> detected() const { return detected_; }

  /// e u_N- <= 0 of each contact assembled last [m/s], which is one term of the normal row of its
  /// bias, and e itself. Empty where nothing rebounds.
  std::span<const double> rebound() const { return rebound_; }
  std::span<const double> restitution() const { return restitution_; }

  /// The part of each row's velocity at the step's end that comes from imposed motions [m/s], for
  /// the problem assembled last; empty where nothing is imposed.
  const Eigen::VectorXd& imposed() const { return imposed_; }
  /// The part of r . u from imposed motions at the step's end [J], and at its beginning.
  double imposed_power(const Impulses& r) const {
    return imposed_.size() > 0 ? r.dot(imposed_) : 0.0;
  }
  double imposed_power_before(const Impulses& r) const {
    return imposed_.size() > 0 ? r.dot(imposed_before_) : 0.0;
  }

  /// Convert between world-frame impulses on body b and stacked rows of the problem assembled last.
  void to_rows(std::span<const Vec3> world, std::span<const ContactPoint> contacts,
               Impulses& r) const;
  void to_world(const Impulses& r, std::span<const ContactPoint> contacts,
                std::vector<Vec3>& world) const;

 private:
  /// Velocity by imposed motions at the contacts assembled last: the part of the relative velocity
  /// that is not H v. imposed_part() has it in contact frames, rows as in the problem.
  Vec3 imposed_velocity(const StepInput& step, int body, int other, const ContactPoint& contact,
                        double time) const;
  void imposed_part(const StepInput& step, double time, Eigen::VectorXd& rows) const;
  /// Call task(c) for the contacts assembled last, task(b, freedom) for bodies that have one, on
  /// any thread: each works on its own data.
  template <class Task>
  void for_contacts(const Task& task) const;
  template <class Task>
  void for_free_bodies(const Task& task) const;
  void write_rows(const StepInput& step);
  void take_contact(const ContactPoint& contact, std::span<const Pose> poses, int k,
                    ContactRows& block) const;
  template <int Rows>
  void write_contact(const ContactPoint& contact, const ContactRows& block, int k, double* h) const;
  void write_bias(const StepInput& step);

  const MechanicalSystem& system_;
  WorkerTeam* team_ = nullptr;
  /// The part of a body that a contact's rows need, kept together because bodies are large.
  struct Side {
    const Freedom* freedom;  // the same object for all bodies whose freedom is the same
    bool moves_freely;       // its unknowns are velocities along x, y, z, then the spin
    double wall_friction;    // below 0: no wall
    int material;            // its number; -1: none
  };
  PairLaw law_of(const ContactPoint& contact) const;
  std::vector<Side> sides_;
  std::vector<int> problem_body_;  // body -> index among bodies with freedom, or -1
  std::vector<double> mass_;
  bool some_motion_is_imposed_ = false;
  double highest_restitution_;
  std::vector<Mat3> rotations_;       // R_WB of the bodies that turn
  std::vector<Vec3> first_tangents_;  // T1 of the contacts assembled last
  std::vector<int> detected_;
  FrictionProblem problem_;
  Eigen::VectorXd v_before_, imposed_before_, imposed_;
  std::vector<double> restitution_, rebound_;
};

}  // namespace ballast

#include "experiments/step/time_step.hpp"

#include <algorithm>

#include "experiments/step/free_spin.hpp"
#include "geometry/contact/broad_phase.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "solvers/parts/local_change.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

/// Bound on how far any point of the body moves in h, with what gravity and forces of the order of
/// g may add. `radius`: its circumradius.
double reach_of(const RigidBody& body, double radius, const MotionState& state, int b, double h,
                double g) {
  if (body.imposed) {
    const Pose next = body.imposed->motion.pose_at(state.time + 1.5 * h, body.imposed->start);
    const MotionBound travel = step_bound(state.pose[b], next);
    return travel.shift + travel.turn * radius;
  }
  if (body.shape.fixed) return 0.0;
  // No point of the body is faster than |v| + |w| R; gravity adds g h, and forces like it as much.
  // The load of a driven wall is left out: it may open and close a gap of f h^2 / m unseen.
  const double pushed =
      body.is_wall() ? 0.0 : (body.force.constant.norm() + body.force.amplitude.norm()) / body.mass;
  return h *
         (state.velocity[b].norm() + state.spin[b].norm() * radius + (g + std::max(g, pushed)) * h);
}

/// Bodies overlap by the slop, and by little more.
DetectionSettings detection_settings(const Scene& scene) {
  DetectionSettings settings = scene.detection;
  double size = 0.0;
  for (const BodySpec& body : scene.bodies) size = std::max(size, body.shape->circumradius());
  settings.joint = std::max(2.0 * scene.correction.slop, 1e-7 * size);
  return settings;
}

}  // namespace

double velocity_scale(const Scene& scene) {
  const double g = scene.gravity.norm();
  return g > 0.0 ? g * scene.step : 1.0;
}

TimeStepper::TimeStepper(const MechanicalSystem& system, const Scene& scene, int driven_wall)
    : system_(system),
      h_(scene.step),
      velocity_scale_(velocity_scale(scene)),
      spec_(scene.solver),
      driven_wall_(driven_wall),
      detector_(contact_shapes(system), detection_settings(scene), system.period),
      assembler_(system),
      correction_(system, scene.correction),
      solver_(make_solver(spec_.name)),
      impact_law_(system.highest_restitution()),
      reach_(system.bodies.size(), 0.0),
      some_shape_is_fixed_(std::ranges::any_of(system.bodies, [](const RigidBody& body) {
        return body.shape.fixed && body.shape.polyhedron;
      })) {
  for (const RigidBody& body : system.bodies) {
    radius_.push_back(body.is_wall() ? 0.0 : body.shape.polyhedron->circumradius());
    // of what does not turn freely any
    inertia_.push_back(body.freedom.rotation ? body.inertia : Vec3::Ones());
  }
  if (spec_.change_tolerance > 0.0)
    solver_ = make_change_stopped(std::move(solver_), {spec_.change_tolerance, spec_.change_every});
  if (spec_.threads <= 1) return;
  // Detection, assembly, solution and judgement have the same bits whatever the number of threads.
  constexpr int parts_of_thread = 4;  // work of parts is known beforehand only roughly
  team_ = std::make_unique<WorkerTeam>();
  team_->resize(spec_.threads);
  solver_->use_team(team_.get());
  assembler_.use_team(team_.get());
  runner_.use_team(team_.get());
  detector_.use_team(team_.get(), parts_of_thread * spec_.threads);
}

/// Of one body, whose velocities have been packed and whose spin after the step is known.
void TimeStepper::free_motion(int b, const MotionState& state, double mid_time) {
  const int first = assembler_.first_dof(b);
  if (first < 0) return;
  const RigidBody& body = system_.bodies[b];
  Vec3 force = body.force.at(mid_time);
  if (body.is_wall()) force = body.wall.load.at(mid_time) * body.wall.normal;
  // M (v_free - v) = h f(t_mid) + h M g along the free axes; of a wall the load alone, h f.
  for (int d = first; d < first + body.freedom.translations; ++d) {
    const Vec3 axis = body.freedom.axes.col(d - first);
    force_[d] = h_ * axis.dot(force);
    const double gravity = body.is_wall() ? 0.0 : h_ * axis.dot(system_.gravity);
    v_free()[d] = v_before_[d] + (gravity + force_[d] / body.mass);
    gyroscopic_[d] = 0.0;
  }
  // The gyroscopic term is solved for here, once, and not with the contacts.
  if (!body.freedom.rotation) return;
  const int spin = first + body.freedom.translations;
  force_.segment<3>(spin).setZero();
  gyroscopic_.segment<3>(spin) = body.inertia.cwiseProduct(spin_after_[b] - state.spin[b]);
  v_free().segment<3>(spin) = spin_after_[b];
}

void TimeStepper::detect(const MotionState& mid, std::vector<ContactPoint>& contacts) {
  const double g = system_.gravity.norm();
  // Two bodies further apart than the sum of their reaches cannot touch within the step.
  for_bodies([&](int b) { reach_[b] = reach_of(system_.bodies[b], radius_[b], mid, b, h_, g); });
  ahead_.resize(some_shape_is_fixed_ ? mid.pose.size() : 0);
  if (some_shape_is_fixed_)
    for_bodies([&](int b) {
      const auto& imposed = system_.bodies[b].imposed;
      ahead_[b] = imposed ? imposed->motion.pose_at(mid.time + 1.5 * h_, imposed->start)
                          : moved(mid.pose[b], mid.velocity[b], mid.spin[b], h_);
    });
  detector_.detect(mid.pose, reach_, contacts, ahead_);
}

/// All that waits only for the contacts: carried impulses, the layout of the problem, and the
/// velocities that the bodies would have without contacts.
void TimeStepper::begin_problem(const MotionState& state, const StepMemory& memory,
                                double mid_time) {
  // unknowns: translations of bodies along their free axes, spins in the body frame, outward speeds
  // of driven walls
  assembler_.pack(state, v_before_);
  for (Eigen::VectorXd* unknowns : {&v_free(), &force_, &gyroscopic_})
    unknowns->resize(v_before_.size());
  spin_after_.resize(system_.bodies.size());
  const auto move = [&](int begin, int end) {
    const auto of = [&](auto& list) { return std::span(list).subspan(begin, end - begin); };
    free_spins(of(inertia_), of(state.spin), h_, of(spin_after_));
    for (int b = begin; b < end; ++b) free_motion(b, state, mid_time);
  };
  run_ranges(team_.get(), static_cast<int>(system_.bodies.size()), /*together=*/64, move,
             [&] { assembler_.lay_out(memory.contacts); });
  // A contact that was there in the last step begins with the impulse that it had then. After a
  // step that ended by an exception contacts have no impulses.
  if (spec_.warm_start && old_impulses_.size() == old_contacts_.size())
    carry_impulses(old_contacts_, old_impulses_, memory.contacts, carried_, team_.get());
  else
    carried_.assign(memory.contacts.size(), Vec3::Zero());
  // of the spins, only here: nothing may throw within the team
  if (v_free().allFinite()) return;
  for (size_t b = 0; b < system_.bodies.size(); ++b) {
    const RigidBody& body = system_.bodies[b];
    const int first = assembler_.first_dof(static_cast<int>(b));
    if (first < 0 || !body.freedom.rotation) continue;
    if (!v_free().segment<3>(first + body.freedom.translations).allFinite())
      throw Error(
          printed("t = %.6g s: body %zu (%s) turns by %.3g radians in a step, which is too "
                  "fast: a smaller scene.step is needed",
                  state.time, b, body.name.c_str(), h_ * state.spin[b].norm()));
  }
}

void require_finite(const SolverRun& run, const std::string& solver, double time) {
  if (run.solved.impulses.allFinite()) return;
  throw Error(
      printed("t = %.6g s: the solver's impulses are not finite (solver.name = %s, %s). "
              "Another may do: --set solver.name=auto",
              time, solver.c_str(), name_of(run.solved.reason)));
}

void TimeStepper::solve(StepMemory& memory, StepRecord& record) {
  assembler_.to_rows(carried_, memory.contacts, impulses_);
  const Budget budget{.tolerance = spec_.tolerance * velocity_scale_,
                      .max_iterations = spec_.max_iterations,
                      .max_seconds = spec_.max_seconds};
  // validates, solves and judges; the judge's error is what the record says
  SolverRun run = impact_law_.solve(runner_, *solver_, assembler_.problem(), assembler_.rebound(),
                                    assembler_.restitution(), std::move(impulses_), budget);
  require_finite(run, spec_.name, record.time);
  impulses_ = std::move(run.solved.impulses);
  record.iterations = run.solved.iterations;
  record.error_rms = run.error.natural_map_rms;
  record.error_max = run.error.natural_map_max;
  record.solved = run.error.within(budget.tolerance);
  record.restitution = impact_law_.least_restitution();
  record.seconds_solve = run.prepare_seconds + run.solve_seconds + run.startup_seconds;
  assembler_.to_world(impulses_, memory.contacts, memory.impulses);
}

/// Works on the mean of the velocities at the step's two ends, each on its own; u_mean = H v_mean +
/// that of the prescribed walls.
void TimeStepper::account_energy(StepRecord& record) {
  const Eigen::VectorXd& v0 = v_before_;
  const Eigen::VectorXd& v1 = runner_.body_velocity();
  const std::vector<double>& mass = assembler_.mass();
  const double contact_power =
      0.5 * runner_.body_impulse().dot(v0 + v1);  // r . H v_mean = H^T r . v_mean
  const double wall_power =
      0.5 * (assembler_.imposed_power_before(impulses_) + assembler_.imposed_power(impulses_));
  record.dissipated = -(contact_power + wall_power);
  // T' - T = (v' - v) . M v_mean: the work of each impulse of the step is its product with the mean
  // of the velocities before and after.
  double kinetic_before = 0.0;
  for (size_t b = 0; b < system_.bodies.size(); ++b) {
    const RigidBody& body = system_.bodies[b];
    for (int d = 0; d < body.freedom.count(); ++d) {
      const int dof = assembler_.first_dof(static_cast<int>(b)) + d;
      const double mean = 0.5 * (v0[dof] + v1[dof]);
      kinetic_before += 0.5 * mass[dof] * v0[dof] * v0[dof];
      record.kinetic_energy += 0.5 * mass[dof] * v1[dof] * v1[dof];
      record.work_gyroscopic += gyroscopic_[dof] * mean;
      (body.is_wall() ? record.work_load : record.work_prescribed) += force_[dof] * mean;
      if (d < body.freedom.translations && !body.is_wall())
        record.work_gravity +=
            mass[dof] * h_ * body.freedom.axes.col(d).dot(system_.gravity) * mean;
    }
  }
  record.work_prescribed -= wall_power;
  record.energy_residual = record.kinetic_energy - kinetic_before -
                           (record.work_load + record.work_gravity + record.work_prescribed) +
                           record.dissipated;
  // -L of impact_law.hpp, where without error L = r . W r / 2 - r . u >= 0.
  // -L = r . (u + u_f) / 2 = H^T r . (v' + v_free) / 2 + r . (velocity of the walls).
  const double given =
      0.5 * runner_.body_impulse().dot(v1 + v_free()) + assembler_.imposed_power(impulses_);
  record.energy_gained = std::max(0.0, given);
}

void TimeStepper::account_contacts(const StepMemory& memory, StepRecord& record) {
  for (int c = 0; c < problem().contact_count(); ++c)
    record.active_contacts += impulses_[problem().row_begin[c]] > 0.0;
  double overlap = 0.0;
  for (size_t c = 0; c < memory.contacts.size(); ++c) {
    const ContactPoint& contact = memory.contacts[c];
    const double depth = std::max(0.0, -contact.gap);
    record.penetration_max = std::max(record.penetration_max, depth);
    if (!memory.impulses[c].isZero(0.0)) overlap += depth;
    // An impulse over h is the mean force of the step.
    if (driven_wall_ >= 0 && (contact.body_a == driven_wall_ || contact.body_b == driven_wall_))
      record.wall_force += std::abs(memory.impulses[c].dot(contact.normal)) / h_;
  }
  record.contacts = problem().contact_count();
  if (record.active_contacts > 0) record.penetration_mean = overlap / record.active_contacts;
}

/// The second half of the motion, with the new velocities.
void TimeStepper::finish_motion(double end_time, MotionState& state) {
  assembler_.unpack(runner_.body_velocity(), state);
  for_bodies([&](int b) {
    const RigidBody& body = system_.bodies[b];
    if (body.imposed)
      follow(body, end_time, state.pose[b], state.velocity[b], state.spin[b]);
    else
      state.pose[b] = moved(state.pose[b], state.velocity[b], state.spin[b], 0.5 * h_);
    if (!body.is_wall()) state.pose[b].position = system_.period.wrapped(state.pose[b].position);
  });
  ++state.step;
  state.time = end_time;
}

StepRecord TimeStepper::step(MotionState& state, StepMemory& memory) {
  StepRecord record;
  Stopwatch clock;  // restart() ends a phase and begins the next
  const double mid_time = state.time + 0.5 * h_, end_time = (state.step + 1) * h_;
  record.time = end_time;
  // A step of Moreau and Jean, of which this is the first half:
  //
  //     q -- h/2 v --> q_m: contacts are found, impulses r and v' follow -- h/2 v' --> q'
  detect_pace_.begin(team_.get());
  for_bodies([&](int b) {
    if (const auto& imposed = system_.bodies[b].imposed)
      state.pose[b] = imposed->motion.pose_at(mid_time, imposed->start);
    else
      state.pose[b] = moved(state.pose[b], state.velocity[b], state.spin[b], 0.5 * h_);
  });
  record.seconds_other = clock.restart();
  memory.contacts.swap(old_contacts_);
  memory.impulses.swap(old_impulses_);
  memory.impulses.clear();
  detect(state, memory.contacts);
  record.seconds_detect = clock.restart();
  detect_pace_.took(record.seconds_detect);
  begin_problem(state, memory, mid_time);
  record.seconds_other += clock.restart();
  solve_pace_.begin(team_.get());  // assembled by those who solve, whose cores then have it
  assembler_.fill({state, memory.contacts, v_free(), h_, end_time});
  record.seconds_assemble = clock.restart();
  solve(memory, record);
  record.seconds_judge = clock.restart() - record.seconds_solve;
  // about so many iterations cost as much as what goes before and behind them
  constexpr double around = 30.0;
  solve_pace_.took(record.seconds_assemble + record.seconds_solve + record.seconds_judge,
                   record.iterations + around);

  finish_motion(end_time, state);
  Stopwatch finding;
  correction_.find_targets(team_.get(), assembler_, memory.contacts, runner_.body_velocity(), h_);
  record.seconds_correct = finding.seconds();
  // The books are of the velocities, the correction is of the poses.
  run_parts(team_.get(), 2, [&](int part) {
    if (part) {
      account_energy(record);
      account_contacts(memory, record);
      return;
    }
    Stopwatch own;
    record.work_correction = correction_.apply(assembler_, state);
    record.seconds_correct += own.seconds();
  });
  record.seconds_other += std::max(0.0, clock.restart() - record.seconds_correct);

  if (driven_wall_ >= 0) {
    record.wall_x = outward_displacement(system_, state, driven_wall_);
    record.wall_v = outward_velocity(system_, state, driven_wall_);
    record.load = system_.bodies[driven_wall_].wall.load.at(mid_time);
  }
  return record;
}

}  // namespace ballast

#include "problems/mechanics/assemble.hpp"

#include <algorithm>

#include "problems/mechanics/contact_rows.hpp"

namespace ballast {

namespace {

/// Lies in the plane of n and the world axis least along n, which is never near-parallel to n.
Vec3 first_tangent(const Vec3& n) {
  int axis = 0;
  n.cwiseAbs().minCoeff(&axis);
  return (Vec3::Unit(axis) - n[axis] * n).normalized();
}

Mat3 frame_of(const Vec3& n, const Vec3& first_tangent) {
  Mat3 frame;
  frame.row(0) = n;
  frame.row(1) = first_tangent;
  frame.row(2) = n.cross(first_tangent);
  return frame;
}

Vec3 column(const double (&numbers)[3][ContactRows::size], int k) {
  return Vec3(numbers[0][k], numbers[1][k], numbers[2][k]);
}

}  // namespace

Mat3 contact_frame(const Vec3& normal) { return frame_of(normal, first_tangent(normal)); }

ProblemAssembler::ProblemAssembler(const MechanicalSystem& system)
    : system_(system), highest_restitution_(system.highest_restitution()) {
  for (const RigidBody& body : system.bodies) {
    const bool is_like_last = !sides_.empty() && *sides_.back().freedom == body.freedom;
    sides_.push_back({is_like_last ? sides_.back().freedom : &body.freedom,
                      body.freedom == Freedom{}, body.is_wall() ? body.wall.friction : -1.0,
                      body.material});
    if (body.imposed) some_motion_is_imposed_ = true;
    const int dofs = body.freedom.count();
    if (dofs == 0) {
      problem_body_.push_back(-1);
      continue;
    }
    for (int d = 0; d < dofs; ++d) {
      const int turn = d - body.freedom.translations;
      mass_.push_back(turn < 0 ? body.mass : body.inertia[turn]);
    }
    // Bodies without unknowns are no bodies of the problem; the others are numbered through. Axes
    // are orthonormal and frames principal, so the blocks are diagonal.
    const Eigen::Map<const Eigen::VectorXd> diagonal(mass_.data() + mass_.size() - dofs, dofs);
    problem_body_.push_back(problem_.dynamics.add_body(diagonal.asDiagonal().toDenseMatrix()));
  }
  problem_.has_dynamics = true;
}

template <class Task>
void ProblemAssembler::for_contacts(const Task& task) const {
  run_each(team_, problem_.contact_count(), /*together=*/256, task);
}

template <class Task>
void ProblemAssembler::for_free_bodies(const Task& task) const {
  run_each(team_, static_cast<int>(sides_.size()), /*together=*/64, [&](int b) {
    if (problem_body_[b] >= 0) task(b, *sides_[b].freedom);
  });
}

/// The unknowns, body by body: velocities along the free axes, then the spin in the body frame.
void ProblemAssembler::pack(const MotionState& state, Eigen::VectorXd& v) const {
  v.resize(dof_count());
  for_free_bodies([&](int b, const Freedom& freedom) {
    double* out = v.data() + first_dof(b);
    for (int d = 0; d < freedom.translations; ++d)
      *out++ = freedom.axes.col(d).dot(state.velocity[b]);
    if (freedom.rotation) Eigen::Map<Vec3>{out} = state.spin[b];
  });
}

/// The inverse of pack().
void ProblemAssembler::unpack(const Eigen::VectorXd& v, MotionState& state) const {
  for_free_bodies([&](int b, const Freedom& freedom) {
    const double* in = v.data() + first_dof(b);
    state.velocity[b].setZero();
    for (int d = 0; d < freedom.translations; ++d) state.velocity[b] += freedom.axes.col(d) * *in++;
    if (freedom.rotation) state.spin[b] = Eigen::Map<const Vec3>(in);
  });
}

/// Copies the input of find_rows() for a contact to place k.
void ProblemAssembler::take_contact(const ContactPoint& contact, std::span<const Pose> poses, int k,
                                    ContactRows& block) const {
  for (int i = 0; i < 3; ++i) block.normal[i][k] = contact.normal[i];
  for (int side = 0; side < 2; ++side) {
    const int body = side == 0 ? contact.body_a : contact.body_b;
    if (!sides_[body].freedom->rotation) continue;
    const Vec3 arm = system_.period.nearest(contact.position - poses[body].position);
    for (int i = 0; i < 3; ++i) {
      block.arm[side][i][k] = arm[i];
      for (int j = 0; j < 3; ++j) block.rotation[side][i][j][k] = rotations_[body](i, j);
    }
  }
}

/// Writes both bodies' parts of a contact's rows of H, unknown after unknown.
template <int Rows>
void ProblemAssembler::write_contact(const ContactPoint& contact, const ContactRows& block, int k,
                                     double* h) const {
  for (int side = 0; side < 2; ++side) {
    const Side& body = sides_[side == 0 ? contact.body_a : contact.body_b];
    const double sign = side == 0 ? -1.0 : 1.0;
    if (body.moves_freely) {
      for (int d = 0; d < 3; ++d)
        for (int row = 0; row < Rows; ++row) *h++ = sign * block.line[row][d][k];
    } else {
      const Mat3 frame = frame_of(contact.normal, column(block.tangent[0], k));
      for (int d = 0; d < body.freedom->translations; ++d)
        for (int row = 0; row < Rows; ++row)
          *h++ = sign * frame.row(row).dot(body.freedom->axes.col(d));
    }
    if (!body.freedom->rotation) continue;
    for (int d = 0; d < 3; ++d)
      for (int row = 0; row < Rows; ++row) *h++ = block.turn[side][row][d][k];
  }
}

/// The law of the two materials, else with the wall's friction, else with the scene's.
PairLaw ProblemAssembler::law_of(const ContactPoint& contact) const {
  const Side &a = sides_[contact.body_a], &b = sides_[contact.body_b];
  if (a.material >= 0 && b.material >= 0) {
    const auto law = system_.material_laws.find(std::minmax(a.material, b.material));
    if (law != system_.material_laws.end()) return law->second;
  }
  return {a.wall_friction >= 0.0   ? a.wall_friction
          : b.wall_friction >= 0.0 ? b.wall_friction
                                   : system_.friction,
          system_.restitution};
}

/// Sets everything but numbers: which bodies touch, the rows of each contact, its places in H.
void ProblemAssembler::lay_out(std::span<const ContactPoint> contacts) {
  DynamicsForm& dynamics = problem_.dynamics;
  const auto set_size = [&](size_t count) {
    for (std::vector<int>* begins : {&problem_.row_begin, &dynamics.h_begin})
      begins->resize(count + 1);
    for (std::vector<int>* list : {&detected_, &dynamics.body_a, &dynamics.body_b})
      list->resize(count);
    problem_.friction.resize(count);
    restitution_.resize(highest_restitution_ > 0.0 ? count : 0);
  };
  set_size(contacts.size());
  int count = 0, row = 0, entry = 0;
  for (size_t c = 0; c < contacts.size(); ++c) {
    const ContactPoint& contact = contacts[c];
    const auto [mu, e] = law_of(contact);
    // With restitution only closed points are contacts: an open one has nothing to reflect.
    if (e > 0.0 && contact.gap > 0.0) continue;
    detected_[count] = static_cast<int>(c);
    if (highest_restitution_ > 0.0) restitution_[count] = e;
    const Side &a = sides_[contact.body_a], &b = sides_[contact.body_b];
    // One row, the normal, without friction; two more, the tangents, with it.
    const int rows = mu > 0.0 ? 3 : 1;
    row += rows;
    entry += rows * (a.freedom->count() + b.freedom->count());
    dynamics.body_a[count] = problem_body_[contact.body_a];
    dynamics.body_b[count] = problem_body_[contact.body_b];
    problem_.friction[count] = mu;
    ++count;
    dynamics.h_begin[count] = entry;
    problem_.row_begin[count] = row;
  }
  set_size(count);
  dynamics.h.resize(entry);
  first_tangents_.resize(detected_.size());
}

FrictionProblem& ProblemAssembler::fill(const StepInput& step) {
  if (&step.v_free != &problem_.dynamics.v_free) problem_.dynamics.v_free = step.v_free;
  write_rows(step);
  write_bias(step);
  return problem_;
}

/// Writes the frames and the blocks of H. Each contact writes only its own data, so that any thread
/// may take any part of the work.
void ProblemAssembler::write_rows(const StepInput& step) {
  DynamicsForm& dynamics = problem_.dynamics;
  rotations_.resize(step.state.pose.size());
  for_free_bodies([&](int b, const Freedom& freedom) {
    if (freedom.rotation) rotations_[b] = step.state.pose[b].rotation.toRotationMatrix();
  });
  run_ranges(team_, problem_.contact_count(), /*together=*/128, [&](int begin, int end) {
    ContactRows block{};
    for (int first = begin; first < end; first += ContactRows::size) {
      const int count = std::min(ContactRows::size, end - first);
      const auto contact = [&](int k) -> const ContactPoint& {
        return step.contacts[detected_[first + k]];
      };
      for (int k = 0; k < count; ++k) take_contact(contact(k), step.state.pose, k, block);
      find_rows(block);
      for (int k = 0; k < count; ++k) {
        first_tangents_[first + k] = column(block.tangent[0], k);
        double* h = dynamics.h.data() + dynamics.h_begin[first + k];
        if (problem_.contact_rows(first + k) == 3)
          write_contact<3>(contact(k), block, k, h);
        else
          write_contact<1>(contact(k), block, k, h);
      }
    }
  });
}

/// Writes the part of the contact velocity besides H v: imposed motions; open gaps or restitution.
void ProblemAssembler::write_bias(const StepInput& step) {
  DynamicsForm& dynamics = problem_.dynamics;
  imposed_part(step, step.end_time, dynamics.bias);
  if (some_motion_is_imposed_ || !restitution_.empty())
    imposed_part(step, step.state.time, imposed_before_);
  if (some_motion_is_imposed_) imposed_ = dynamics.bias;
  // Without restitution an open point may close its gap within the step: u_N + gap / h >= 0.
  for_contacts([&](int c) {
    if (restitution_.empty() || restitution_[c] == 0.0)
      dynamics.bias[problem_.row_begin[c]] +=
          std::max(step.contacts[detected_[c]].gap, 0.0) / step.h;
  });
  rebound_.clear();
  if (restitution_.empty()) return;
  // Newton's law: u_N+ + e u_N- >= 0 for approaching points
  rebound_.assign(problem_.contact_count(), 0.0);
  pack(step.state, v_before_);
  // The normal part of H v before the step.
  for (int c = 0; c < problem_.contact_count(); ++c) {
    double approach = imposed_before_[problem_.row_begin[c]];
    for_normal_row(problem_, c, [&](int dof, double h) { approach += h * v_before_[dof]; });
    if (!(approach < 0.0)) continue;
    rebound_[c] = restitution_[c] * approach;
    dynamics.bias[problem_.row_begin[c]] += rebound_[c];
  }
}

/// Zero for a body without imposed motion. From the detection until `time` the contact moves on
/// with the centre of the other body. This turns the surface's velocity within the tangent plane:
/// without that turn a body that sticks to a turning one would leave its circle along the tangent,
/// by w^2 h r / 2 a second.
Vec3 ProblemAssembler::imposed_velocity(const StepInput& step, int body, int other,
                                        const ContactPoint& contact, double time) const {
  const RigidBody& b = system_.bodies[body];
  if (!b.imposed) return Vec3::Zero();
  const ImposedMotion& motion = b.imposed->motion;
  const double detected = step.state.time + 0.5 * step.h;
  // The motion's centre is not wrapped into the period, but the contact's position is.
  const Vec3 centre = motion.centre + motion.shift.at(detected);
  const Vec3 position = motion.pose_at(detected, b.imposed->start).position;
  const Vec3 arm = position - centre + system_.period.nearest(contact.position - position);
  const Vec3 rate = motion.shift.rate_at(time), spin = motion.spin_at(time);
  Vec3 turned = Vec3::Zero();
  if (!system_.bodies[other].is_wall())
    turned = spin.cross((time - detected) * (step.state.velocity[other] - rate));
  turned -= contact.normal.dot(turned) * contact.normal;
  return rate + spin.cross(arm) + turned;
}

void ProblemAssembler::imposed_part(const StepInput& step, double time,
                                    Eigen::VectorXd& rows) const {
  rows.setZero(problem_.row_count());
  if (!some_motion_is_imposed_) return;
  for (size_t k = 0; k < detected_.size(); ++k) {
    const ContactPoint& contact = step.contacts[detected_[k]];
    const int a = contact.body_a, b = contact.body_b;
    const Vec3 velocity =
        imposed_velocity(step, b, a, contact, time) - imposed_velocity(step, a, b, contact, time);
    const int n = problem_.contact_rows(static_cast<int>(k));
    const Mat3 frame = frame_of(contact.normal, first_tangents_[k]);
    rows.segment(problem_.row_begin[k], n) = (frame * velocity).head(n);
  }
}

void ProblemAssembler::to_rows(std::span<const Vec3> world, std::span<const ContactPoint> contacts,
                               Impulses& r) const {
  r.resize(problem_.row_count());
  for_contacts([&](int k) {
    const int n = problem_.contact_rows(k);
    const Mat3 frame = frame_of(contacts[detected_[k]].normal, first_tangents_[k]);
    r.segment(problem_.row_begin[k], n) = (frame * world[detected_[k]]).head(n);
  });
}

void ProblemAssembler::to_world(const Impulses& r, std::span<const ContactPoint> contacts,
                                std::vector<Vec3>& world) const {
  world.assign(contacts.size(), Vec3::Zero());
  for_contacts([&](int k) {
    Vec3& given = world[detected_[k]];
    const Vec3& normal = contacts[detected_[k]].normal;
    if (problem_.contact_rows(k) == 3)
      given =
          frame_of(normal, first_tangents_[k]).transpose() * r.segment<3>(problem_.row_begin[k]);
    else
      given = normal * r[problem_.row_begin[k]];
  });
}

}  // namespace ballast

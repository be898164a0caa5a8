#include "experiments/bench/kernel_problem.hpp"

#include <cmath>
#include <numbers>

#include "geometry/shape/grain_shapes.hpp"
#include "geometry/shape/pose.hpp"

namespace ballast {
namespace {

constexpr double grain_radius = 0.0375;  // [m] the paper's middle size

/// Bodies of different pairs are this far apart [m].
constexpr double pair_spacing = 10.0 * grain_radius;

/// How far b stands from a along x when they begin to touch, by halving [m].
double touching_distance(const Polyhedron& a, const Polyhedron& b, const Quat& turn_a,
                         const Quat& turn_b) {
  const std::vector<ContactShape> shapes{{&a, {}, false}, {&b, {}, false}};
  ContactDetector detector(shapes, {});
  const double none[] = {0.0, 0.0};
  std::vector<ContactPoint> contacts;
  double apart = a.circumradius() + b.circumradius(), deep = 0.0;
  // Forty halvings leave 1e-12 of the range.
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (apart + deep);
    const Pose poses[] = {{Vec3::Zero(), turn_a}, {Vec3(middle, 0, 0), turn_b}};
    detector.detect(poses, none, contacts);
    (contacts.empty() ? apart : deep) = middle;
  }
  return deep;
}

}  // namespace

KernelProblem kernel_problem(const DepositedBox& box, int steps) {
  KernelProblem result;
  result.start = driven_start(box);
  const StepSettings settings = step_settings(box.scene);
  result.h = settings.h;
  TimeStepper stepper(result.start.system, settings, result.start.system.first_driven_wall());
  for (int k = 0; k < steps; ++k) stepper.step(result.start.state, result.start.memory);
  result.problem = stepper.problem();
  result.impulses = stepper.impulses();
  stepper.warm_start(result.warm);
  result.contacts = stepper.contacts();
  return result;
}

FrictionProblem repeated(const FrictionProblem& one, int copies) {
  FrictionProblem all;
  all.has_dynamics = true;
  DynamicsForm& d = all.dynamics;
  const DynamicsForm& from = one.dynamics;
  const auto append_begins = [](std::vector<int>& to, const std::vector<int>& begins) {
    const int base = to.back();
    for (size_t k = 1; k < begins.size(); ++k) to.push_back(base + begins[k]);
  };
  // Each copy's bodies follow the last one's; only the walls' "no body" (-1) is shared.
  for (int copy = 0; copy < copies; ++copy) {
    const int bodies = d.body_count();
    const auto shifted = [bodies](int body) { return body < 0 ? body : body + bodies; };
    for (const int body : from.body_a) d.body_a.push_back(shifted(body));
    for (const int body : from.body_b) d.body_b.push_back(shifted(body));
    append_begins(d.dof_begin, from.dof_begin);
    append_begins(d.mass_begin, from.mass_begin);
    append_begins(d.h_begin, from.h_begin);
    append_begins(all.row_begin, one.row_begin);
    d.mass.insert(d.mass.end(), from.mass.begin(), from.mass.end());
    d.h.insert(d.h.end(), from.h.begin(), from.h.end());
    all.friction.insert(all.friction.end(), one.friction.begin(), one.friction.end());
  }
  d.v_free = repeated(from.v_free, copies);
  d.bias = repeated(from.bias, copies);
  return all;
}

Impulses repeated(const Impulses& r, int copies) { return r.replicate(copies, 1); }

std::vector<ContactShape> GrainPairs::contact_shapes() const {
  std::vector<ContactShape> result;
  for (const auto& shape : shapes) result.push_back({shape.get(), {}, false});
  return result;
}

GrainPairs grain_pairs(int vertices, bool touching, int count) {
  GrainPairs pairs;
  pairs.reach = 1e-3 * grain_radius;
  pairs.skin = 0.5 * grain_radius;
  GrainShapeSettings settings;
  settings.min_vertices = settings.max_vertices = vertices;
  Random random(static_cast<std::uint64_t>(1000 * vertices + touching));
  std::vector<Pose> base;
  std::vector<Vec3> shake, spin;
  for (int k = 0; k < count; ++k) {
    Quat turn[2];
    for (int side = 0; side < 2; ++side) {
      pairs.shapes.push_back(std::make_shared<const Polyhedron>(
          make_grain(settings, grain_radius, 2 * std::uint64_t(k) + std::uint64_t(side) + 1)
              .shape));
      turn[side] = random_rotation(random);
      shake.push_back(random_rotation(random) * Vec3(grain_radius, 0, 0));
      spin.push_back(random_rotation(random) * Vec3::UnitZ());
    }
    // The pair is put as deep or as far apart as asked for, measured from where it just touches.
    const double touch =
        touching_distance(*pairs.shapes[2 * k], *pairs.shapes[2 * k + 1], turn[0], turn[1]);
    const Vec3 place(0.0, pair_spacing * k, 0.0);
    base.push_back({place, turn[0]});
    base.push_back({place + Vec3(touch + (touching ? -4e-3 : 0.1) * grain_radius, 0, 0), turn[1]});
  }
  constexpr int visits = 32;
  const double amplitude =
      4e-4 * visits /
      (2.0 * std::numbers::pi);  // the fastest step is 4e-4, half of it motion and half turn
  // All bodies swing about their places, back and forth, so that poses can be visited for ever.
  for (int visit = 0; visit < visits; ++visit) {
    const double at = 0.5 * amplitude * std::sin(2.0 * std::numbers::pi * visit / visits);
    std::vector<Pose> poses = base;
    for (size_t b = 0; b < base.size(); ++b) poses[b] = moved(base[b], shake[b], spin[b], at);
    pairs.poses.push_back(std::move(poses));
  }
  return pairs;
}

}  // namespace ballast

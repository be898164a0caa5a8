#pragma once
// What the kernels are measured on: the friction problem of a step of the driven box, and pairs of
// grains.

#include "experiments/bench/bench_packing.hpp"
#include "experiments/step/time_step.hpp"

namespace ballast {

/// The last of some steps of the driven box, with what belongs to it.
struct KernelProblem {
  BenchStart start;  ///< after those steps
  double h = 0.0;    ///< [s]
  FrictionProblem problem;
  Impulses impulses, warm;  ///< the step's answer, and what it was begun from
  std::vector<ContactPoint> contacts;
};
KernelProblem kernel_problem(const DepositedBox& box, int steps);

/// `copies` of the problem that know nothing of each other, as one (dynamics form): a working set
/// as large as one likes.
FrictionProblem repeated(const FrictionProblem& problem, int copies);
Impulses repeated(const Impulses& r, int copies);

/// Pairs of grains far from other pairs, and poses that follow one another as in a driven packing:
/// 4e-4 of the radius a step.
struct GrainPairs {
  std::vector<std::shared_ptr<const Polyhedron>> shapes;  ///< bodies 2 k and 2 k + 1 are pair k
  std::vector<std::vector<Pose>> poses;  ///< of all bodies, to be visited in turn, again and again
  double reach = 0.0;                    ///< of every body [m]
  double skin = 0.0;                     ///< [m]
  int count() const { return static_cast<int>(shapes.size() / 2); }
  std::vector<ContactShape> contact_shapes() const;
};

/// `touching`: 0.4 % of the radius deep; else 10 % of it apart, but in the broad phase's list.
/// Seeded.
GrainPairs grain_pairs(int vertices, bool touching, int count);

}  // namespace ballast

#pragma once
// The inner loops of the Gauss-Seidel sweep over bodies (sweep_record.hpp).

#include "solvers/gauss_seidel/search_step.hpp"
#include "solvers/gauss_seidel/sweep_record.hpp"
#include "solvers/gauss_seidel/sweep_variant.hpp"

namespace ballast {

/// Of a search that combines sweeps: where the last sweep began, and the direction. Lane 3 is zero.
struct alignas(64) ImpulseSearch {
  double before[4], direction[4];
};
struct OneRowSearch {
  double before = 0.0, direction = 0.0;
};

/// Every record once, in order.
void sweep_friction(const FrictionRecord* records, FrictionImpulse* impulses, int count,
                    BodyVelocity* velocity);
void sweep_one_row(const OneRowRecord* records, double* impulses, int count,
                   BodyVelocity* velocity);

/// The same; each impulse first moves along its search direction. The velocities must have moved
/// before: all of them, by the same step. Returns the sum over contacts of |impulse after - impulse
/// moved|^2.
double sweep_friction(const FrictionRecord* records, FrictionImpulse* impulses,
                      ImpulseSearch* search, SearchStep step, int count, BodyVelocity* velocity);
double sweep_one_row(const OneRowRecord* records, double* impulses, OneRowSearch* search,
                     SearchStep step, int count, BodyVelocity* velocity);

/// One record another way (sweep_variant.hpp).
void resolve_by_variant(const SweepVariant& variant, const FrictionRecord& record,
                        FrictionImpulse& impulse, double lambda_max, BodyVelocity* velocity);
void resolve_by_variant(const SweepVariant& variant, const OneRowRecord& record, double& impulse,
                        BodyVelocity* velocity);

}  // namespace ballast

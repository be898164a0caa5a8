#pragma once
// The rotation of a body that nothing touches.

#include <span>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// Angular velocity after a torque-free flight of h: implicit mid-point rule of Euler's equations
/// in the body frame, which conserves energy and |angular momentum| exactly. `inertia`: principal
/// [kg m^2]; `spin`: body frame [rad/s]. NaN where h |spin| is above a thousand.
Vec3 free_spin(const Vec3& inertia, const Vec3& spin, double h);

/// free_spin() of many bodies, each with the same bits. All spans have the same size.
void free_spins(std::span<const Vec3> inertia, std::span<const Vec3> spin, double h,
                std::span<Vec3> after);

}  // namespace ballast

#pragma once
// Fig. 5: the paper's phenomenological model, the wall's equation (Eq. 2) with f_g(x) from the fits
// of Fig. 4, integrated over one period.

#include <vector>

#include "experiments/measure/curve_fit.hpp"
#include "problems/scene/scene.hpp"

namespace ballast {

struct WallModel {
  ExponentialFit active;  ///< f_g [N] against the outward displacement from the jamming position
                          ///< before the rise [m], wall moving out
  LineFit passive;  ///< f_g [N] against the displacement from the jamming position after it [m],
                    ///< wall moving in
  double contraction = 0;  ///< how much further in the second jamming position is [m]
  double wall_mass = 1.0;  ///< m_w [kg]
  HarmonicLoad load;
};

/// One period from the load's falling mean, at which the wall is jammed at x = 0.
struct ModelMotion {
  std::vector<double> time, x, v, force;  ///< [s], [m] outward, [m/s], f_g [N]
  double rise = 0.0;                      ///< Delta x_max [m]
  double speed_in = 0.0;                  ///< v_max [m/s]
};

/// m_w dv/dt = f_g - f(t) by Heun's rule, `parts` steps a period: out while f_g = active(x), in
/// while f_g = passive; at rest while f lies between the two; jammed (f_g = f) where it started or
/// came back to. Begins jammed.
ModelMotion integrate(const WallModel& model, int parts = 20000);

}  // namespace ballast

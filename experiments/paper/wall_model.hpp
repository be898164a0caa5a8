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

/// One period, which begins where the falling load has its mean; the wall is then jammed at x = 0.
struct ModelMotion {
  std::vector<double> time, x, v, force;  ///< [s], [m] outward, [m/s], f_g [N]
  double rise = 0.0;                      ///< Delta x_max [m]
  double speed_in = 0.0;                  ///< v_max [m/s]
};

/// Integrates m_w dv/dt = f_g - f(t) by Heun's rule, `parts` steps a period. f_g is active(x) while
/// the wall moves out, and passive while it moves in. The wall rests while f lies between the two.
/// It is jammed (f_g = f) at the beginning, and where it comes back to its jamming position.
ModelMotion integrate(const WallModel& model, int parts = 20000);

}  // namespace ballast

// The model of the wall (Eq. 2) against closed-form motions.

#include "experiments/paper/wall_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/catch.hpp"

using namespace ballast;

namespace {

WallModel model_of(const ExponentialFit& active, double passive_offset, double passive_slope,
                   double wall_mass, const HarmonicLoad& load) {
  WallModel model;
  model.active = active;
  model.passive.offset = passive_offset;
  model.passive.slope = passive_slope;
  model.wall_mass = wall_mass;
  model.load = load;
  return model;
}

}  // namespace

TEST_CASE("Eq. 2 with a constant force of the packing has the motion that can be written down") {
  const WallModel model = model_of({100.0, 0.0}, 100.0, 0.0, 50.0, {0.0, 1000.0, 5.0});
  const ModelMotion motion = integrate(model);
  // m x'' = F - A + A sin wt from rest at t0 (A sin wt0 = A - F): v = ((F - A)(t - t0) - A (cos wt
  // - cos wt0)/w)/m
  const double force = 100.0, half = 500.0, w = 10.0 * std::numbers::pi,
               t0 = std::asin((half - force) / half) / w;
  double worst = 0.0;
  int compared = 0;
  for (size_t k = 0; k < motion.time.size() && !(motion.x[k] < 0.0); ++k) {
    const double t = motion.time[k];
    if (t < t0 || (compared > 10 && motion.x[k] <= 0.0)) continue;
    const double dt = t - t0, cosine = std::cos(w * t0);
    const double v =
        ((force - half) * dt - half / w * (std::cos(w * t) - cosine)) / model.wall_mass;
    const double x = ((force - half) * 0.5 * dt * dt -
                      half / w * ((std::sin(w * t) - std::sin(w * t0)) / w - cosine * dt)) /
                     model.wall_mass;
    worst = std::max({worst, std::abs(motion.x[k] - x) / motion.rise,
                      std::abs(motion.v[k] - v) / motion.speed_in});
    ++compared;
  }
  CHECK(compared > 1000);
  CHECK(worst < 1e-3);
  CHECK(motion.x.back() == 0.0);
  CHECK(motion.force.back() == Approx(model.load.at(motion.time.back())));
}

TEST_CASE("a wall under a load that never falls below the packing's force stays jammed") {
  const ModelMotion motion =
      integrate(model_of({10.0, 50.0}, 30.0, -1e4, 5.0, {20.0, 100.0, 10.0}), 2000);
  CHECK(motion.rise == 0.0);
  CHECK(motion.speed_in == 0.0);
}

TEST_CASE("the model comes back further in when the packing contracts") {
  WallModel model = model_of({100.0, 20.0}, 300.0, -1e4, 50.0, {0.0, 1000.0, 5.0});
  model.contraction = 1e-3;
  const ModelMotion motion = integrate(model);
  CHECK(motion.x.back() == Approx(-1e-3));
  CHECK(motion.rise > 0.0);
}

#include "solvers/backends/interior_jump.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ballast {

void InteriorJump::prepare(const UnitMassContacts& contacts, UnitMassSystem& system) {
  contacts_ = &contacts;
  point_.prepare(contacts, system);
  // Scales of contacts differ by powers of ten: their geometric mean.
  double sum = 0.0;
  int counted = 0;
  for (int c = 0; c < contacts.contact_count(); ++c) {
    if (!(contacts[c].lambda_max > 0.0)) continue;
    sum += std::log(contacts[c].lambda_max);
    ++counted;
  }
  mean_lambda_ = counted > 0 ? std::exp(sum / counted) : 1.0;
}

double InteriorJump::run(Course& course, ContactColumns& r, int number, double scale, double near) {
  // How far from the boundary it begins, in units of `scale`.
  static constexpr double distances[] = {10.0, 20.0, 5.0, 40.0, 14.0, 7.0, 30.0};
  constexpr double to_boundary = 0.9, short_step = 0.05;
  constexpr int most_steps = 60, most_short_steps = 3, most_slow_steps = 10;
  const double distance = distances[number % std::size(distances)] * scale;
  // Impulse times velocity is nu: velocities of size `distance`,
  // impulses of size distance / lambda.
  point_.begin(r, distance * distance / mean_lambda_);
  double best = std::numeric_limits<double>::max(), halved = best;
  int short_steps = 0, slow_steps = 0;
  for (int k = 0; k < most_steps && !course.over(); ++k) {
    course.factored();
    const double length = point_.step(to_boundary);
    if (length == 0.0) break;
    const double error = point_.round(rounded_);
    contacts_->to_impulses(rounded_, impulses_);
    course.offer(impulses_, error);
    if (error < best) {
      best = error;
      r = rounded_;
    }
    // It ends near a solution, or where its steps shrink and the error no longer falls.
    short_steps = length < short_step ? short_steps + 1 : 0;
    ++slow_steps;
    if (best < 0.5 * halved) {
      halved = best;
      slow_steps = 0;
    }
    if (best < near * scale || short_steps >= most_short_steps || slow_steps >= most_slow_steps)
      break;
  }
  return best;
}

}  // namespace ballast

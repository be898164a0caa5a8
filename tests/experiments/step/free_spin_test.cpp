// Free flight: Euler's equations by the mid-point rule.

#include "experiments/step/free_spin.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("the mid-point rule keeps energy and angular momentum of a tumbling body") {
  const Vec3 inertia(1.0, 2.0, 2.5);
  Vec3 spin(0.1, 5.0, 0.2);
  const double energy = spin.dot(inertia.cwiseProduct(spin)),
               momentum = inertia.cwiseProduct(spin).norm();
  for (int k = 0; k < 10000; ++k) spin = free_spin(inertia, spin, 1e-3);
  CHECK(spin.dot(inertia.cwiseProduct(spin)) == Approx(energy).epsilon(1e-12));
  CHECK(inertia.cwiseProduct(spin).norm() == Approx(momentum).epsilon(1e-12));
}

TEST_CASE("the intermediate axis flips over (Dzhanibekov), to second order in h") {
  const auto spin_at = [](double h) {
    Vec3 spin(0.01, 5.0, 0.0);
    for (long k = 0; k < std::lround(4.0 / h); ++k) spin = free_spin(Vec3(1.0, 2.0, 3.0), spin, h);
    return spin;
  };
  const Vec3 reference = spin_at(1e-5);
  const double coarse = (spin_at(2e-3) - reference).norm(),
               fine = (spin_at(1e-3) - reference).norm();
  CHECK(reference.y() < 4.0);  // has left the unstable axis
  CHECK(coarse / fine == Approx(4.0).margin(0.1));
}

TEST_CASE("however far a body turns within a step, energy and angular momentum are kept") {
  const Vec3 inertia(1.0, 2.0, 2.5);
  for (const double radians : {0.5, 2.0, 3.0, 30.0, 300.0}) {
    const Vec3 spin = radians * Vec3(0.3, 0.9, 0.3), end = free_spin(inertia, spin, 1.0);
    INFO(radians << " radians");
    CHECK(end.dot(inertia.cwiseProduct(end)) ==
          Approx(spin.dot(inertia.cwiseProduct(spin))).epsilon(1e-9));
    CHECK(inertia.cwiseProduct(end).norm() ==
          Approx(inertia.cwiseProduct(spin).norm()).epsilon(1e-9));
  }
}

TEST_CASE("many bodies' spins have the bits of one's") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double h = 2e-4, infinite = std::numeric_limits<double>::infinity();
  for (const size_t bodies : {0, 1, 7, 8, 9, 2000}) {
    std::vector<Vec3> inertia, spin, after(bodies);
    for (size_t b = 0; b < bodies; ++b) {
      // At rest, slow, fast, too fast for the step, and not finite.
      const double size = b % 11 == 0   ? 0.0
                          : b % 97 == 5 ? infinite
                                        : std::exp(15.0 * unit(random));
      inertia.push_back(1e-4 * Vec3(2.0 + unit(random), 2.0 + unit(random), 2.0 + unit(random)));
      spin.push_back(size * Vec3(unit(random), unit(random), unit(random)));
    }
    free_spins(inertia, spin, h, after);
    for (size_t b = 0; b < bodies; ++b) {
      const Vec3 alone = free_spin(inertia[b], spin[b], h);
      INFO(b << ": " << spin[b].transpose());
      for (int i = 0; i < 3; ++i)
        CHECK((after[b][i] == alone[i] || (std::isnan(after[b][i]) && std::isnan(alone[i]))));
    }
  }
}

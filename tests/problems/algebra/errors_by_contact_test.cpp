#include "problems/algebra/errors_by_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"

namespace ballast {
namespace {

TEST_CASE("the judge's rms and worst contact are those of the errors contact by contact") {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const KnownSolution known = make_known_solution({.seed = seed});
    const FrictionProblem& problem = known.problem;
    Impulses r = known.r;
    for (int k = 0; k < r.size(); ++k) r[k] += 0.01 * std::sin(3.0 * k + 1.0);
    const ContactError whole = contact_error(problem, r);
    const std::vector<double> each = errors_by_contact(problem, r);
    REQUIRE(each.size() == static_cast<size_t>(problem.contact_count()));
    double square = 0.0;
    for (const double error : each) square += error * error;
    const double rms = std::sqrt(square / static_cast<double>(each.size()));
    CHECK(std::abs(rms - whole.natural_map_rms) <= 1e-12 * (1.0 + rms));
    const auto worst = std::max_element(each.begin(), each.end());
    CHECK(std::abs(*worst - whole.natural_map_max) <= 1e-12 * (1.0 + *worst));
  }
}

TEST_CASE("an answer that is no number is infinitely wrong") {
  const KnownSolution known = make_known_solution({});
  Impulses r = known.r;
  r[0] = std::nan("");
  CHECK(errors_by_contact(known.problem, r)[0] == std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace ballast

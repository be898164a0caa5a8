#include "experiments/compare/compare_figures.hpp"

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("No two of twenty-four backends look alike") {
  for (size_t a = 0; a < 24; ++a)
    for (size_t b = 0; b < a; ++b) {
      const Curve p = backend_curve(a, "p"), q = backend_curve(b, "q");
      CHECK((p.ink != q.ink || p.dashed != q.dashed || p.width != q.width));
    }
}

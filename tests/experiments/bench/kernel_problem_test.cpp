// What kernels are measured on: copies of a problem, and pairs of grains.

#include "experiments/bench/kernel_problem.hpp"

#include "problems/algebra/contact_error.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/bench/tiny_box.hpp"

using namespace ballast;

TEST_CASE("A repeated problem is its copies") {
  const KernelProblem problem = kernel_problem(tiny_box(), 3);
  REQUIRE(problem.problem.contact_count() > 0);
  const FrictionProblem three = repeated(problem.problem, 3);
  three.validate();
  CHECK(three.contact_count() == 3 * problem.problem.contact_count());
  const ContactError one = contact_error(problem.problem, problem.warm),
                     all = contact_error(three, repeated(problem.warm, 3));
  CHECK(one.natural_map_rms > 0.0);
  CHECK(all.natural_map_rms == Approx(one.natural_map_rms).epsilon(1e-12));
  CHECK(all.natural_map_max == one.natural_map_max);
}

TEST_CASE("Pairs for the pair test touch or do not") {
  for (const int vertices : {8, 37})
    for (const bool touching : {true, false}) {
      const GrainPairs pairs = grain_pairs(vertices, touching, 6);
      REQUIRE(pairs.count() == 6);
      for (const auto& shape : pairs.shapes) CHECK(shape->vertex_count() == vertices);
      DetectionSettings cold;
      cold.skin = pairs.skin;
      cold.use_cache = false;
      DetectionSettings cached = cold;
      cached.use_cache = true;
      ContactDetector a(pairs.contact_shapes(), cold), b(pairs.contact_shapes(), cached);
      const std::vector<double> reach(pairs.shapes.size(), pairs.reach);
      std::vector<ContactPoint> found, again;
      for (const auto& poses : pairs.poses) {
        a.detect(poses, reach, found);
        b.detect(poses, reach, again);
        CHECK(a.counters().candidate_pairs == 6);
        CHECK(a.counters().manifolds == (touching ? 6 : 0));
        CHECK(again.size() == found.size());
      }
    }
}

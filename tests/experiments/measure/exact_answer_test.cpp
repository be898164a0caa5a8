#include "experiments/measure/exact_answer.hpp"

#include "platform/atomic_file.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/unsolvable.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("An exact answer is found, kept and judged anew") {
  const KnownSolution known = make_known_solution({.bodies = 10, .contacts = 15, .seed = 2});
  const TemporaryFolder folder;
  const ExactSearch search{1.0, 10.0, folder.path() / "exact", "case"};
  const auto found = find_exact_answer(known.problem, {}, search);
  REQUIRE(found);
  CHECK(found->error <= 1e-9);
  Eigen::VectorXd u;
  contact_velocity(known.problem, found->impulses, u);
  CHECK((u - known.u).norm() < 1e-6 * known.u.norm());

  const auto file = folder.path() / "exact" / "case.exact";
  const std::string bytes = read_whole_file(file);
  CHECK(find_exact_answer(known.problem, {}, search)->impulses == found->impulses);
  // Damaged, or of another problem: it is found again.
  for (const std::string& damaged : {bytes.substr(0, 20), std::string(bytes.size(), '\1')}) {
    write_whole_file(file, damaged);
    CHECK(find_exact_answer(known.problem, {}, search)->impulses == found->impulses);
    CHECK(read_whole_file(file) == bytes);
  }
}

TEST_CASE("An exact answer is found where W alone is known") {
  const KnownSolution known = make_known_solution({.bodies = 10, .contacts = 15, .seed = 2});
  CHECK(find_exact_answer(only_delassus(known.problem), {}, {}));
}

TEST_CASE("No exact answer where none is looked for, or none exists") {
  const KnownSolution known = make_known_solution({});
  CHECK_FALSE(find_exact_answer(known.problem, {}, {1.0, 0.0}));
  CHECK_FALSE(find_exact_answer(squeezed_contacts(), {}, {1.0, 0.2}));
}

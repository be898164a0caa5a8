// Words of the command line -> cases from files, folders and patterns.

#include "experiments/compare/compare_case.hpp"

#include <cmath>

#include "platform/error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("Cases from files: families, names, and what is refused") {
  CHECK(family_of_file("Capsules-i101-404.dat") == "Capsules");
  CHECK(family_of_file("Rover1039.dat") == "Rover");
  CHECK(family_of_file("NESpheres_30_1.dat") == "NESpheres");
  const TemporaryFolder folder;
  CHECK_THROWS_AS(compare_cases({"/no/such/*.dat"}), Error);
  CHECK_THROWS_AS(compare_cases({"known"}), Error);
  CHECK_THROWS_AS(compare_cases({folder.path().string()}), Error);
  CHECK_THROWS_AS(compare_cases({folder.write("notes.txt", "").string()}), Error);
  folder.write("b.dat", "3 0 0 0 0");
  folder.write("a.dat", "3 0 0 0 0");
  const std::vector<CompareCase> cases =
      compare_cases({(folder.path() / "*.dat").string(), folder.path().string()});
  REQUIRE(cases.size() == 4);
  CHECK(cases[0].name == "a.dat");
  CHECK(cases[2].name == "a.dat (2)");
  CHECK(cases[1].word == (folder.path() / "b.dat").string());
}

TEST_CASE("Folders are searched to the bottom, and only for problems") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "deep" / "deeper");
  folder.write("deep/deeper/Rover2.dat", "");
  folder.write("deep/Rover1.dat", "");
  folder.write("deep/readme.md", "");
  const std::vector<CompareCase> cases = compare_cases({folder.path().string()});
  REQUIRE(cases.size() == 2);
  CHECK(cases[0].family == "Rover");
  CHECK(cases[0].name == "Rover1.dat");
  CHECK(cases[1].name == "Rover2.dat");
}

TEST_CASE("A file that is missing or broken is a case, and says why when it is loaded") {
  const TemporaryFolder folder;
  const std::string broken = folder.write("broken.hdf5", "no HDF5 at all").string();
  const std::string missing = (folder.path() / "missing.dat").string();
  const std::vector<CompareCase> cases = compare_cases({missing, broken});
  REQUIRE(cases.size() == 2);
  CHECK(cases[0].name == "missing.dat");
  CHECK(cases[1].name == "broken.hdf5");
  CHECK_THROWS_WITH(cases[0].load(), Catch::Contains(missing) && Catch::Contains("no such file"));
  CHECK_THROWS_WITH(cases[1].load(), Catch::Contains(broken));
}

TEST_CASE("What is measured of a case") {
  KnownSolutionSettings settings;
  settings.bodies = 3;
  settings.contacts = 40;
  settings.frictionless_fraction = 0.0;
  const KnownSolution known = make_known_solution(settings);
  const CaseFacts facts = case_facts(known.problem, {}, 2.0);
  CHECK(facts.contacts == 40);
  CHECK(facts.rows == 120);
  CHECK(facts.dofs == 18);
  CHECK(facts.rank_deficiency == Approx(1.0 - 18.0 / 120.0));
  CHECK(facts.mass_ratio == Approx(1.0));
  FrictionProblem stored = known.problem;  // W alone
  add_delassus_form(stored);
  stored.has_dynamics = false;
  CHECK(case_facts(stored, {}, 2.0).dofs == 0);
  CHECK(case_facts(stored, {}, 2.0).rank_deficiency == Approx(facts.rank_deficiency));
  CHECK(case_facts(stored, {}, 2.0).mass_ratio > 1.0);
  CHECK(case_facts(known.problem, known.r, 2.0).content != facts.content);
  CHECK(case_facts(known.problem, {}, 3.0).content != facts.content);
  CHECK(case_facts(known.problem, {}, 2.0).content == facts.content);
}

TEST_CASE("Bodies that no contact touches count for nothing") {
  KnownSolutionSettings settings;
  settings.bodies = 4;
  settings.contacts = 6;
  const FrictionProblem problem = make_known_solution(settings).problem;
  const CaseFacts facts = case_facts(problem, {}, 1.0);
  FrictionProblem larger = problem;
  DynamicsForm& d = larger.dynamics;
  const int first = d.mass_begin[d.body_count() - 1], last = d.mass_begin[d.body_count()];
  d.mass.insert(d.mass.end(), d.mass.begin() + first, d.mass.begin() + last);
  for (int k = first; k < last; ++k) d.mass[static_cast<size_t>(last + k - first)] *= 1e6;
  d.mass_begin.push_back(2 * last - first);
  d.dof_begin.push_back(2 * d.dof_begin.back() - *(d.dof_begin.end() - 2));
  const Eigen::Index before = d.v_free.size();
  d.v_free.conservativeResize(d.dof_begin.back());
  d.v_free.tail(d.v_free.size() - before).setZero();
  const CaseFacts same = case_facts(larger, {}, 1.0);
  CHECK(same.dofs == facts.dofs);
  CHECK(same.mass_ratio == facts.mass_ratio);
  CHECK(same.rank_deficiency == Approx(facts.rank_deficiency));
  CHECK(same.content != facts.content);
}

TEST_CASE("A case at rest has a scale of one, and a moving one the rms of q") {
  KnownSolutionSettings settings;
  FrictionProblem problem = make_known_solution(settings).problem;
  Eigen::VectorXd q;
  free_contact_velocity(problem, q);
  CHECK(load_case(problem).facts.velocity_scale ==
        Approx(std::sqrt(q.squaredNorm() / static_cast<double>(q.size()))));
  CHECK(load_case(problem, 0.5).facts.velocity_scale == 0.5);
  problem.dynamics.v_free.setZero();
  problem.dynamics.bias.setZero();
  CHECK(load_case(problem).facts.velocity_scale == 1.0);
}

// Words of the command line become cases: files, folders and patterns.

#include "experiments/compare/compare_case.hpp"

#include <cmath>

#include "platform/error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/files/problem_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("Cases from files: families, names, and what is refused") {
  CHECK(family_of_file("Capsules-i101-404.dat") == "Capsules");
  CHECK(family_of_file("Rover1039.dat") == "Rover");
  CHECK(family_of_file("NESpheres_30_1.dat") == "NESpheres");
  const TemporaryFolder folder;
  const std::string notes = folder.write("notes.txt", "").string(), empty = folder.path().string();
  for (const std::string& word :
       {std::string("/no/such/*.dat"), std::string("known"), notes, empty})
    CHECK_THROWS_AS(compare_cases({word}), Error);
  folder.write("b.dat", "3 0 0 0 0");
  folder.write("a.dat", "3 0 0 0 0");
  const std::vector<CompareCase> cases =
      compare_cases({(folder.path() / "*.dat").string(), folder.path().string()});
  REQUIRE(cases.size() == 4);
  CHECK(cases[0].name == "a.dat");
  CHECK(cases[2].name == "a.dat (2)");
  CHECK(cases[1].word == (folder.path() / "b.dat").string());
  // Folders are searched recursively, for problems only.
  std::filesystem::create_directories(folder.path() / "deep" / "deeper");
  folder.write("deep/deeper/Rover2.dat", "");
  folder.write("deep/Rover1.dat", "");
  folder.write("deep/readme.md", "");
  const std::vector<CompareCase> deep = compare_cases({(folder.path() / "deep").string()});
  REQUIRE(deep.size() == 2);
  CHECK(deep[0].family == "Rover");
  CHECK(deep[0].name + deep[1].name == "Rover1.datRover2.dat");
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

TEST_CASE("A file's reference comes with its case, and a broken one is named") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "problems/hand/a.hdf5",
                              reference = folder.path() / "references/hand/a.exact";
  CHECK(reference_of(file) == reference);
  for (const auto& path : {file, reference})
    std::filesystem::create_directories(path.parent_path());
  const KnownSolution known = make_known_solution({.bodies = 4, .contacts = 6});
  write_problem(file, known.problem);
  const auto exact = [&] { return compare_cases({file.string()})[0].load().exact; };
  CHECK(exact().size() == 0);
  write_solution(reference, known.problem, {known.r, {}, {}});
  CHECK(exact().size() == 18);
  write_solution(reference, make_known_solution({.bodies = 4, .contacts = 7}).problem,
                 {make_known_solution({.bodies = 4, .contacts = 7}).r, {}, {}});
  CHECK_THROWS_WITH(exact(), Catch::Contains("a.exact"));
}

TEST_CASE("What is measured of a case") {
  const KnownSolution known =
      make_known_solution({.bodies = 3, .contacts = 40, .frictionless_fraction = 0.0});
  const auto facts_of = [](const FrictionProblem& problem, const Impulses& start = {},
                           double scale = 2.0) { return load_case(problem, scale, start).facts; };
  const CaseFacts facts = facts_of(known.problem);
  CHECK(facts.contacts == 40);
  CHECK(facts.rows == 120);
  CHECK(facts.dofs == 18);
  CHECK(facts.rank_deficiency == Approx(1.0 - 18.0 / 120.0));
  CHECK(facts.mass_ratio == Approx(1.0));
  FrictionProblem stored = known.problem;  // with W alone
  add_delassus_form(stored);
  stored.has_dynamics = false;
  CHECK(facts_of(stored).dofs == 0);
  CHECK(facts_of(stored).rank_deficiency == Approx(facts.rank_deficiency));
  CHECK(facts_of(stored).mass_ratio > 1.0);
  CHECK(facts_of(known.problem, known.r).content != facts.content);
  CHECK(facts_of(known.problem, {}, 3.0).content != facts.content);
  CHECK(facts_of(known.problem).content == facts.content);
}

TEST_CASE("Bodies that no contact touches count for nothing") {
  const FrictionProblem problem = make_known_solution({.bodies = 4, .contacts = 6}).problem;
  const CaseFacts facts = load_case(problem, 1.0).facts;
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
  const CaseFacts same = load_case(larger, 1.0).facts;
  CHECK(same.dofs == facts.dofs);
  CHECK(same.mass_ratio == facts.mass_ratio);
  CHECK(same.rank_deficiency == Approx(facts.rank_deficiency));
  CHECK(same.content != facts.content);
}

TEST_CASE("A case at rest has a scale of one, and a moving one the rms of q") {
  FrictionProblem problem = make_known_solution({}).problem;
  Eigen::VectorXd q;
  free_contact_velocity(problem, q);
  CHECK(load_case(problem).facts.velocity_scale ==
        Approx(std::sqrt(q.squaredNorm() / static_cast<double>(q.size()))));
  CHECK(load_case(problem, 0.5).facts.velocity_scale == 0.5);
  problem.dynamics.v_free.setZero();
  problem.dynamics.bias.setZero();
  CHECK(load_case(problem).facts.velocity_scale == 1.0);
}

TEST_CASE("Made cases are what their words say") {
  CHECK(compare_cases({"known:count=3"}).size() == 3);
  const std::vector<CompareCase> made = compare_cases({"stress:all"});
  CHECK(made.size() > 10);
  for (const CompareCase& c : made) CHECK_NOTHROW(c.load());
}

TEST_CASE("Settings of a made case are in its name, and in the problem") {
  const std::vector<CompareCase> known =
      compare_cases({"known:bodies=5,contacts=7,copies=2,seed=4,count=2,frictionless=0"});
  REQUIRE(known.size() == 2);
  CHECK(known[0].name == "known-b5-c7x2-R1-s4");
  CHECK(known[1].name == "known-b5-c7x2-R1-s5");
  CHECK(known[0].family == "known");
  const LoadedCase first = known[0].load();
  CHECK(first.facts.contacts == 14);
  CHECK(first.facts.rows == 42);
  CHECK(first.facts.content != known[1].load().facts.content);
  CHECK(first.facts.content == known[0].load().facts.content);
  CHECK(first.describe_contact(3) == "contact 3");
  CHECK(first.describe_contact(-1).empty());
}

TEST_CASE("A made case has a word that makes it alone") {
  for (const char* words : {"known:", "known:count=3,seed=7,bodies=5", "pile:family,count=2",
                            "pile:contacts=30,count=2,seed=3"})
    for (const CompareCase& made : compare_cases({words})) {
      INFO(made.word);
      const std::vector<CompareCase> again = compare_cases({made.word});
      REQUIRE(again.size() == 1);
      CHECK(again[0].name == made.name);
      CHECK(again[0].load().facts.content == made.load().facts.content);
    }
}

TEST_CASE("Words that make no case are refused by name") {
  for (const std::string word :
       {"known:bodies=x", "known:colour=3", "known:contacts=0", "known:bodies", "known:bodies=-1",
        "known:bodies=1e10", "known:count=1e8", "known:copies=1e9", "stress:", "stress:pile",
        "stress:all,weight=3", "stress:all,chain", "known:open=2", "known:open=0.7,slip=0.7",
        "known:friction_min=0.5,friction_max=0.1"})
    CHECK_THROWS_WITH(compare_cases({word}), Catch::StartsWith(word + ": "));
}

TEST_CASE("Piles are made as their words say, and a family from its seeds") {
  const std::vector<CompareCase> piles = compare_cases(
      {"pile:contacts=40,redundancy=.5,mass_ratio=100,friction_min=.2,active=.6,stored=1,seed=3,"
       "count=2"});
  REQUIRE(piles.size() == 2);
  CHECK(piles[0].name == "pile-c40-d0.5-R1e+02-f0.2..0.3-a0.6-s3-w");
  CHECK(piles[0].family == "pile, mid");
  const LoadedCase loaded = piles[0].load();
  CHECK(loaded.facts.contacts == 40);
  CHECK(loaded.facts.dofs == 0);  // only W is known
  CHECK(loaded.facts.rank_deficiency == Approx(0.5).margin(0.1));
  const std::vector<CompareCase> family = compare_cases({"pile:family,contacts=50,seed=4,count=9"});
  REQUIRE(family.size() == 9);
  for (const CompareCase& c : family) CHECK(c.load().facts.contacts <= 50);
  for (const std::string word : {"pile:redundancy=1", "pile:active=2", "pile:tower",
                                 "pile:friction_min=.5,friction_max=.4", "pile:family,active=1"})
    CHECK_THROWS_AS(compare_cases({word}), Error);
}

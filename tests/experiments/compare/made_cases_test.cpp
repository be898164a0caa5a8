// Cases that are made on the spot: known:... and stress:...

#include "experiments/compare/compare_case.hpp"

#include "platform/error.hpp"
#include "tests/catch.hpp"

using namespace ballast;

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
        "stress:all,weight=3", "stress:all,chain"})
    CHECK_THROWS_WITH(compare_cases({word}), Catch::StartsWith(word + ": "));
  CHECK_FALSE(is_made_case("unknown:bodies=3"));
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

// Problems of a comparison that are made on the spot: manufactured ones with known solutions, and
// those that break solvers.

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/compare/compare_case.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/pile_problems.hpp"
#include "problems/algebra/stress_problems.hpp"

namespace ballast {
namespace {

/// "kind:what,name=value,...". Every setting must be asked for by finish().
class MadeWord {
 public:
  explicit MadeWord(const std::string& word) : word_(word) {
    const std::string settings = word.substr(word.find(':') + 1);
    if (settings.empty()) return;
    for (const std::string& item : split(settings, ',')) {
      const size_t equals = item.find('=');
      if (equals == std::string::npos) {
        if (!what_.empty()) fail(item + ": expected name=value");
        what_ = item;
      } else {
        values_[item.substr(0, equals)] = number_of(item, item.substr(equals + 1));
      }
    }
  }

  /// The word without a value; empty: none.
  const std::string& what() const { return what_; }

  double take(const char* name, double otherwise, double least = 0.0) {
    const auto found = values_.find(name);
    if (found == values_.end()) return otherwise;
    const double value = found->second;
    if (!(value >= least)) fail(std::string(name) + ": too small");
    values_.erase(found);
    return value;
  }
  /// Of what takes memory there may be a million.
  int take_count(const char* name, int otherwise, int least, int most = 1'000'000) {
    const double value = take(name, otherwise, least);
    if (value > most) fail(name + (": at most " + std::to_string(most)));
    return static_cast<int>(std::lround(value));
  }
  /// Of the first case; the others follow one by one.
  std::uint64_t take_seed() {
    return static_cast<std::uint64_t>(take_count("seed", 1, 0, 1'000'000'000));
  }

  void finish() const {
    if (!values_.empty())
      fail(values_.begin()->first + ": no such setting; see ballast compare --help");
  }
  [[noreturn]] void fail(const std::string& what) const { throw Error(word_ + ": " + what); }

 private:
  double number_of(const std::string& item, const std::string& text) const {
    const double value = parsed<double>(text).value_or(-1.0);
    if (!(value >= 0.0 && value <= 1e9)) fail(item + ": expected a number from 0 to 1e9");
    return value;
  }

  std::string word_, what_;
  std::map<std::string, double> values_;
};

void add_known_cases(MadeWord& word, std::vector<CompareCase>& cases) {
  if (!word.what().empty()) word.fail(word.what() + ": expected name=value");
  KnownSolutionSettings settings;
  settings.bodies = word.take_count("bodies", settings.bodies, 2);
  settings.contacts = word.take_count("contacts", settings.contacts, 1);
  settings.mass_ratio = word.take("mass_ratio", settings.mass_ratio, 1.0);
  settings.friction_min = word.take("friction_min", settings.friction_min);
  settings.friction_max = word.take("friction_max", settings.friction_max);
  settings.open_fraction = word.take("open", settings.open_fraction);
  settings.slip_fraction = word.take("slip", settings.slip_fraction);
  settings.frictionless_fraction = word.take("frictionless", settings.frictionless_fraction);
  settings.copies = word.take_count("copies", settings.copies, 1);
  settings.seed = word.take_seed();
  const int count = word.take_count("count", 1, 1);
  word.finish();
  for (int k = 0; k < count; ++k, ++settings.seed) {
    const std::string name =
        printed("known-b%d-c%dx%d-R%g-s%llu", settings.bodies, settings.contacts, settings.copies,
                settings.mass_ratio, static_cast<unsigned long long>(settings.seed));
    cases.push_back(
        {name, "known", [settings] { return load_case(make_known_solution(settings).problem); }});
  }
}

/// "pile-c120-d0.4-R1000-f0.2..0.7-a0.8-s3", "-w" behind where only W is stored.
std::string name_of_pile(const PileSettings& s) {
  return printed("pile-c%d-d%.2g-R%.2g-f%.2g..%.2g-a%.2g-s%llu%s", s.contacts, s.redundancy,
                 s.mass_ratio, s.friction_min, s.friction_max, s.active,
                 static_cast<unsigned long long>(s.seed), s.is_stored ? "-w" : "");
}

void add_pile(const PileSettings& settings, std::vector<CompareCase>& cases) {
  const char* size = settings.contacts < 20 ? "small" : settings.contacts < 150 ? "mid" : "large";
  cases.push_back({name_of_pile(settings), std::string("pile, ") + size,
                   [settings] { return load_case(make_pile(settings)); }});
}

/// pile: with every setting given. pile:family: all drawn from seeds one after the other.
void add_piles(MadeWord& word, std::vector<CompareCase>& cases) {
  PileSettings settings;
  settings.seed = word.take_seed();
  const int count = word.take_count("count", 1, 1);
  const bool is_family = word.what() == "family";
  if (is_family) {
    const int most = word.take_count("contacts", 1000, 2);
    word.finish();
    for (int k = 0; k < count; ++k)
      add_pile(random_pile(settings.seed + static_cast<std::uint64_t>(k), most), cases);
    return;
  }
  if (!word.what().empty()) word.fail(word.what() + ": expected family or name=value");
  settings.contacts = word.take_count("contacts", settings.contacts, 1);
  settings.redundancy = word.take("redundancy", settings.redundancy);
  if (settings.redundancy >= 1.0) word.fail("redundancy: expected a number below 1");
  settings.mass_ratio = word.take("mass_ratio", settings.mass_ratio, 1.0);
  settings.friction_min = word.take("friction_min", settings.friction_min);
  settings.friction_max =
      word.take("friction_max", std::max(settings.friction_min, settings.friction_max));
  if (settings.friction_max < settings.friction_min)
    word.fail("friction_max: expected at least friction_min");
  settings.active = word.take("active", settings.active);
  if (settings.active > 1.0) word.fail("active: expected a number from 0 to 1");
  settings.slenderness = word.take("slenderness", settings.slenderness, 1e-3);
  settings.shear = word.take("shear", settings.shear);
  settings.mass_unit = word.take("mass_unit", settings.mass_unit, 1e-9);
  settings.is_stored = word.take("stored", 0.0) > 0.0;
  word.finish();
  for (int k = 0; k < count; ++k, ++settings.seed) add_pile(settings, cases);
}

void add_stress_case(const std::string& name, const std::string& family,
                     const std::function<StressProblem()>& make, std::vector<CompareCase>& cases) {
  cases.push_back(
      {name, family, [make] { return load_case(make().problem, stress_gravity_step); }});
}

/// Every small problem that is valid; broken ones are for tests.
void add_all_stress_cases(std::vector<CompareCase>& cases) {
  for (const StressProblem& stress : stress_problems()) {
    if (!stress.refused.empty()) continue;
    // the manufactured ones have no gravity
    const double scale = stress.family == "manufactured" ? 0.0 : stress_gravity_step;
    cases.push_back({"stress-" + stress.name, "stress " + stress.family,
                     [problem = stress.problem, scale] { return load_case(problem, scale); }});
  }
}

/// stack: n boxes of 1 kg, the uppermost of `ratio` kg. chain: grains between walls. table: four
/// legs.
void add_stress_cases(MadeWord& word, std::vector<CompareCase>& cases) {
  if (word.what() == "all") {
    word.finish();
    add_all_stress_cases(cases);
  } else if (word.what() == "stack") {
    const int n = word.take_count("n", 2, 1), rows = word.take_count("rows", 3, 1);
    const double ratio = word.take("ratio", 1.0, 1e-9);
    if (rows != 1 && rows != 3) word.fail("rows: expected 1 or 3");
    word.finish();
    std::vector<double> masses(static_cast<size_t>(n), 1.0);
    masses.back() = ratio;
    add_stress_case(
        printed("stack-n%d-R%g-rows%d", n, ratio, rows), "stack",
        [masses, rows] { return mass_stack(masses, rows); }, cases);
  } else if (word.what() == "chain") {
    const int grains = word.take_count("grains", 20, 1);
    const double force = word.take("force", 1e3);
    word.finish();
    add_stress_case(
        printed("chain-n%d-F%g", grains, force), "chain",
        [grains, force] { return jammed_chain(grains, force); }, cases);
  } else if (word.what() == "table") {
    const int copies = word.take_count("copies", 1, 1);
    const double mu = word.take("mu", 0.5), speed = word.take("speed", 0.0);
    word.finish();
    add_stress_case(
        printed("table-x%d-mu%g-v%g", copies, mu, speed), "table",
        [mu, speed, copies] { return four_legged_table(mu, speed, copies); }, cases);
  } else {
    word.fail("expected stress:all, stress:stack, stress:chain or stress:table");
  }
}

bool begins_with(const std::string& text, const char* beginning) {
  return text.rfind(beginning, 0) == 0;
}

}  // namespace

bool is_made_case(const std::string& word) {
  return begins_with(word, "known:") || begins_with(word, "pile:") || begins_with(word, "stress:");
}

void add_made_cases(const std::string& word, std::vector<CompareCase>& cases) {
  MadeWord made(word);
  const size_t before = cases.size();
  if (begins_with(word, "known:"))
    add_known_cases(made, cases);
  else if (begins_with(word, "pile:"))
    add_piles(made, cases);
  else
    add_stress_cases(made, cases);
  // of settings that stand twice the later one holds
  const bool has_seeds = !begins_with(word, "stress:");
  std::uint64_t seed = has_seeds ? MadeWord(word).take_seed() : 0;
  for (size_t k = before; k < cases.size(); ++k, ++seed)
    cases[k].word =
        has_seeds ? word + (word.ends_with(':') ? "" : ",") + "count=1,seed=" + std::to_string(seed)
                  : word;
}

}  // namespace ballast

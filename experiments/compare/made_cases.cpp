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
        continue;
      }
      const double value = parsed<double>(item.substr(equals + 1)).value_or(-1.0);
      if (!(value >= 0.0 && value <= 1e9)) fail(item + ": expected a number from 0 to 1e9");
      values_[item.substr(0, equals)] = value;
    }
  }

  /// The word without a value; empty: none.
  const std::string& what() const { return what_; }

  /// Sets `value` where the word does.
  void take(const char* name, double& value, double least = 0.0, double most = 1e9) {
    const auto found = values_.find(name);
    if (found == values_.end()) return;
    if (!(found->second >= least)) fail(std::string(name) + ": too small");
    if (!(found->second <= most)) fail(name + printed(": at most %.0f", most));
    value = found->second;
    values_.erase(found);
  }
  /// Of what takes memory there may be a million.
  template <typename Whole>
  void take_count(const char* name, Whole& value, int least, int most = 1'000'000) {
    double number = static_cast<double>(value);
    take(name, number, least, most);
    value = static_cast<Whole>(std::llround(number));
  }
  /// Of the first case; the others follow one by one.
  std::uint64_t take_seed() {
    std::uint64_t seed = 1;
    take_count("seed", seed, 0, 1'000'000'000);
    return seed;
  }
  /// How many cases there are to be; nothing may be left that nobody asked for.
  int finish() {
    int count = 1;
    if (!word_.starts_with("stress:")) take_count("count", count, 1);
    if (!values_.empty())
      fail(values_.begin()->first + ": no such setting; see ballast compare --help");
    return count;
  }
  [[noreturn]] void fail(const std::string& what) const { throw Error(word_ + ": " + what); }

 private:
  std::string word_, what_;
  std::map<std::string, double> values_;
};

void add_known_cases(MadeWord& word, std::vector<CompareCase>& cases) {
  if (!word.what().empty()) word.fail(word.what() + ": expected name=value");
  KnownSolutionSettings settings;
  word.take_count("bodies", settings.bodies, 2);
  word.take_count("contacts", settings.contacts, 1);
  word.take("mass_ratio", settings.mass_ratio, 1.0);
  word.take("friction_min", settings.friction_min);
  word.take("friction_max", settings.friction_max);
  word.take("open", settings.open_fraction);
  word.take("slip", settings.slip_fraction);
  word.take("frictionless", settings.frictionless_fraction);
  word.take_count("copies", settings.copies, 1);
  settings.seed = word.take_seed();
  for (int left = word.finish(); left > 0; --left, ++settings.seed) {
    const std::string name =
        printed("known-b%d-c%dx%d-R%g-s%llu", settings.bodies, settings.contacts, settings.copies,
                settings.mass_ratio, static_cast<unsigned long long>(settings.seed));
    cases.push_back(
        {name, "known", [settings] { return load_case(make_known_solution(settings).problem); }});
  }
}

/// "pile-c120-d0.4-R1000-f0.2..0.7-a0.8-s3", "-w" behind where only W is stored.
void add_pile(const PileSettings& s, std::vector<CompareCase>& cases) {
  const char* size = s.contacts < 20 ? "small" : s.contacts < 150 ? "mid" : "large";
  cases.push_back({printed("pile-c%d-d%.2g-R%.2g-f%.2g..%.2g-a%.2g-s%llu%s", s.contacts,
                           s.redundancy, s.mass_ratio, s.friction_min, s.friction_max, s.active,
                           static_cast<unsigned long long>(s.seed), s.is_stored ? "-w" : ""),
                   std::string("pile, ") + size, [s] { return load_case(make_pile(s)); }});
}

/// pile: with every setting given. pile:family: all drawn from seeds one after the other.
void add_piles(MadeWord& word, std::vector<CompareCase>& cases) {
  PileSettings settings;
  settings.seed = word.take_seed();
  if (word.what() == "family") {
    int most = 1000;
    word.take_count("contacts", most, 2);
    for (int left = word.finish(); left > 0; --left, ++settings.seed)
      add_pile(random_pile(settings.seed, most), cases);
    return;
  }
  if (!word.what().empty()) word.fail(word.what() + ": expected family or name=value");
  word.take_count("contacts", settings.contacts, 1);
  word.take("redundancy", settings.redundancy);
  if (settings.redundancy >= 1.0) word.fail("redundancy: expected a number below 1");
  word.take("mass_ratio", settings.mass_ratio, 1.0);
  word.take("friction_min", settings.friction_min);
  settings.friction_max = std::max(settings.friction_min, settings.friction_max);
  word.take("friction_max", settings.friction_max);
  if (settings.friction_max < settings.friction_min)
    word.fail("friction_max: expected at least friction_min");
  word.take("active", settings.active, 0.0, 1.0);
  word.take("slenderness", settings.slenderness, 1e-3);
  word.take("shear", settings.shear);
  word.take("mass_unit", settings.mass_unit, 1e-9);
  word.take_count("stored", settings.is_stored, 0, 1);
  for (int left = word.finish(); left > 0; --left, ++settings.seed) add_pile(settings, cases);
}

/// all: every small problem that is valid; broken ones are for tests. stack: n boxes of 1 kg, the
/// uppermost of `ratio` kg. chain: grains between walls. table: four legs.
void add_stress_cases(MadeWord& word, std::vector<CompareCase>& cases) {
  const auto add = [&](const std::string& name, const std::function<StressProblem()>& make) {
    word.finish();
    cases.push_back(
        {name, word.what(), [make] { return load_case(make().problem, stress_gravity_step); }});
  };
  if (word.what() == "all") {
    word.finish();
    for (const StressProblem& stress : stress_problems()) {
      if (!stress.refused.empty()) continue;
      // the manufactured ones have no gravity
      const double scale = stress.family == "manufactured" ? 0.0 : stress_gravity_step;
      cases.push_back({"stress-" + stress.name, "stress " + stress.family,
                       [problem = stress.problem, scale] { return load_case(problem, scale); }});
    }
  } else if (word.what() == "stack") {
    int n = 2, rows = 3;
    double ratio = 1.0;
    word.take_count("n", n, 1);
    word.take_count("rows", rows, 1);
    word.take("ratio", ratio, 1e-9);
    if (rows != 1 && rows != 3) word.fail("rows: expected 1 or 3");
    std::vector<double> masses(static_cast<size_t>(n), 1.0);
    masses.back() = ratio;
    add(printed("stack-n%d-R%g-rows%d", n, ratio, rows), [=] { return mass_stack(masses, rows); });
  } else if (word.what() == "chain") {
    int grains = 20;
    double force = 1e3;
    word.take_count("grains", grains, 1);
    word.take("force", force);
    add(printed("chain-n%d-F%g", grains, force), [=] { return jammed_chain(grains, force); });
  } else if (word.what() == "table") {
    int copies = 1;
    double mu = 0.5, speed = 0.0;
    word.take_count("copies", copies, 1);
    word.take("mu", mu);
    word.take("speed", speed);
    add(printed("table-x%d-mu%g-v%g", copies, mu, speed),
        [=] { return four_legged_table(mu, speed, copies); });
  } else {
    word.fail("expected stress:all, stress:stack, stress:chain or stress:table");
  }
}

}  // namespace

bool is_made_case(const std::string& word) {
  return word.starts_with("known:") || word.starts_with("pile:") || word.starts_with("stress:");
}

void add_made_cases(const std::string& word, std::vector<CompareCase>& cases) {
  MadeWord made(word);
  const size_t before = cases.size();
  const bool has_seeds = !word.starts_with("stress:");
  if (!has_seeds)
    add_stress_cases(made, cases);
  else if (word.starts_with("known:"))
    add_known_cases(made, cases);
  else
    add_piles(made, cases);
  // of settings that stand twice the later one holds
  std::uint64_t seed = has_seeds ? MadeWord(word).take_seed() : 0;
  for (size_t k = before; k < cases.size(); ++k, ++seed)
    cases[k].word =
        has_seeds ? word + (word.ends_with(':') ? "" : ",") + "count=1,seed=" + std::to_string(seed)
                  : word;
}

}  // namespace ballast

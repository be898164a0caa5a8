// Problems of a comparison that are made on the spot: manufactured ones with known solutions, and
// those that break solvers.

#include <algorithm>
#include <cmath>
#include <map>
#include <type_traits>

#include "experiments/compare/compare_case.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/made_problems.hpp"

namespace ballast {
namespace {

/// "kind:what,name=value,...". Every setting must be asked for before finish().
class MadeWord {
 public:
  explicit MadeWord(const std::string& word) : word_(word) {
    for (const std::string& item : split(word.substr(word.find(':') + 1), ',')) {
      const size_t equals = item.find('=');
      if (equals == std::string::npos) {
        if (!what_.empty()) fail(item + ": expected name=value");
        what_ = item;
        continue;
      }
      const double value = parsed<double>(item.substr(equals + 1)).value_or(-1.0);
      if (!(value >= 0.0 && value <= 1e9)) fail(item + ": expected a number from 0 to 1e9");
      values_[item.substr(0, equals)] = value;  // of settings that stand twice the later one holds
    }
  }

  const std::string& text() const { return word_; }
  /// The word without a value; empty: none.
  const std::string& what() const { return what_; }

  /// Sets `value` where the word does. Of what is counted there may be a million.
  template <typename Number>
  void take(const char* name, Number& value, double least = 0.0,
            double most = std::is_integral_v<Number> ? 1e6 : 1e9) {
    const auto found = values_.find(name);
    if (found == values_.end()) return;
    if (!(found->second >= least)) fail(std::string(name) + ": too small");
    if (!(found->second <= most)) fail(name + printed(": at most %.0f", most));
    value =
        static_cast<Number>(std::is_integral_v<Number> ? std::round(found->second) : found->second);
    values_.erase(found);
  }
  /// Nothing may be left that nobody asked for.
  void finish() const {
    if (!values_.empty())
      fail(values_.begin()->first + ": no such setting; see ballast compare --help");
  }
  [[noreturn]] void fail(const std::string& what) const { throw Error(word_ + ": " + what); }

 private:
  std::string word_, what_;
  std::map<std::string, double> values_;
};

/// As many cases as the word says, each of the next seed and with a word that makes it alone.
template <typename Settings, typename Make>
void add_seeded(MadeWord& word, Settings settings, const Make& make,
                std::vector<CompareCase>& cases) {
  int count = 1;
  settings.seed = 1;
  word.take("count", count, 1);
  word.take("seed", settings.seed, 0.0, 1e9);
  word.finish();
  for (; count > 0; --count, ++settings.seed) {
    cases.push_back(make(settings));
    cases.back().word = word.text() + (word.text().ends_with(':') ? "" : ",") +
                        "count=1,seed=" + std::to_string(settings.seed);
  }
}

void add_known_cases(MadeWord& word, std::vector<CompareCase>& cases) {
  if (!word.what().empty()) word.fail(word.what() + ": expected name=value");
  KnownSolutionSettings settings;
  word.take("bodies", settings.bodies, 2);
  word.take("contacts", settings.contacts, 1);
  word.take("mass_ratio", settings.mass_ratio, 1.0);
  word.take("friction_min", settings.friction_min);
  word.take("friction_max", settings.friction_max);
  word.take("open", settings.open_fraction);
  word.take("slip", settings.slip_fraction);
  word.take("frictionless", settings.frictionless_fraction);
  word.take("copies", settings.copies, 1);
  const auto make = [](const KnownSolutionSettings& s) {
    return CompareCase{printed("known-b%d-c%dx%d-R%g-s%llu", s.bodies, s.contacts, s.copies,
                               s.mass_ratio, static_cast<unsigned long long>(s.seed)),
                       "known", [s] { return load_case(make_known_solution(s).problem); }};
  };
  add_seeded(word, settings, make, cases);
}

/// "pile-c120-d0.4-R1000-f0.2..0.7-a0.8-s3", "-w" behind where only W is stored.
CompareCase pile_case(const PileSettings& s) {
  const char* size = s.contacts < 20 ? "small" : s.contacts < 150 ? "mid" : "large";
  return {printed("pile-c%d-d%.2g-R%.2g-f%.2g..%.2g-a%.2g-s%llu%s", s.contacts, s.redundancy,
                  s.mass_ratio, s.friction_min, s.friction_max, s.active,
                  static_cast<unsigned long long>(s.seed), s.is_stored ? "-w" : ""),
          std::string("pile, ") + size, [s] { return load_case(make_pile(s)); }};
}

/// pile: with every setting given. pile:family: all drawn from seeds one after the other.
void add_piles(MadeWord& word, std::vector<CompareCase>& cases) {
  if (word.what() == "family") {
    struct Family {
      int most = 1000;
      std::uint64_t seed = 1;
    } family;
    word.take("contacts", family.most, 2);
    const auto make = [](const Family& f) { return pile_case(random_pile(f.seed, f.most)); };
    add_seeded(word, family, make, cases);
    return;
  }
  if (!word.what().empty()) word.fail(word.what() + ": expected family or name=value");
  PileSettings settings;
  word.take("contacts", settings.contacts, 1);
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
  word.take("stored", settings.is_stored, 0, 1);
  add_seeded(word, settings, pile_case, cases);
}

/// Every small problem.
void add_stress_cases(MadeWord& word, std::vector<CompareCase>& cases) {
  if (word.what() != "all") word.fail("expected stress:all");
  word.finish();
  for (const StressProblem& stress : stress_problems()) {
    // the manufactured ones have no gravity
    const double scale = stress.family == "manufactured" ? 0.0 : made_gravity_step;
    const auto load = [problem = stress.problem, scale] { return load_case(problem, scale); };
    cases.push_back({"stress-" + stress.name, "stress " + stress.family, load, word.text()});
  }
}

}  // namespace

bool is_made_case(const std::string& word) {
  return word.starts_with("known:") || word.starts_with("pile:") || word.starts_with("stress:");
}

void add_made_cases(const std::string& word, std::vector<CompareCase>& cases) {
  MadeWord made(word);
  if (word.starts_with("known:"))
    add_known_cases(made, cases);
  else if (word.starts_with("pile:"))
    add_piles(made, cases);
  else
    add_stress_cases(made, cases);
}

}  // namespace ballast

#include "solvers/solver_list.hpp"

#include <iterator>
#include <vector>

#include "platform/text.hpp"
#include "solvers/backends/backends.hpp"
#include "solvers/parts/sparse_factor.hpp"

namespace ballast {
namespace {

constexpr const char *suitesparse = "libsuitesparse-dev", *ipopt = "coinor-libipopt-dev",
                     *nlopt = "libnlopt-dev", *siconos = "libsiconos-numerics-dev";

/// Every backend, as if all libraries were there: name, description, law, maker, library, limit.
/// The description ends with the property that sets this row apart.
constexpr SolverEntry rows[] = {
    {"auto", "ours, recommended: sweeps where they are enough, Newton where not",
     ContactLaw::coulomb, [] { return make_auto(); }, suitesparse},
    {"pgs", "projected Gauss-Seidel, each contact solved exactly (Jean 1999): the field's default",
     ContactLaw::coulomb, [] { return make_gauss_seidel(); }},
    {"nncg",
     "pgs with nonlinear conjugate gradients (Silcowitz-Hansen 2010): the published acceleration",
     ContactLaw::coulomb, [] { return make_nncg(); }},
    {"nesterov_pgs",
     "pgs with Nesterov's momentum, restarted (O'Donoghue, Candes 2015): our fastest sweeps",
     ContactLaw::coulomb, [] { return make_nesterov_pgs(); }},
    {"apgd", "accelerated projected gradient with s-update (Mazhar 2015): all contacts at once",
     ContactLaw::coulomb, [] { return make_apgd(); }},
    {"admm",
     "alternating directions with s-update (Acary, Bremond, Huber 2018): one sparse factorisation",
     ContactLaw::coulomb, [] { return make_admm(); }, suitesparse},
    {"interior_point",
     "primal-dual, second-order cones, with s-update (Acary et al. 2023): insensitive to masses",
     ContactLaw::coulomb, [] { return make_interior_point(); }, suitesparse},
    {"sap", "unconstrained convex problem in velocities (Castro 2022): Drake's law, the relaxation",
     ContactLaw::convex_relaxation, [] { return make_sap(); }, suitesparse},
    {"newton_ac",
     "semismooth Newton on Alart and Curnier's function (1991): Newton alone, fast or lost",
     ContactLaw::coulomb, [] { return make_newton(ContactEquation::alart_curnier); }, suitesparse},
    {"newton_fb",
     "semismooth Newton on Fischer-Burmeister (Fukushima, Luo, Tseng 2002): another function",
     ContactLaw::coulomb, [] { return make_newton(ContactEquation::fischer_burmeister); },
     suitesparse},
    {"prox_newton",
     "proximal steps, each by Newton (Acary, Bremond, Huber 2018): regular whatever W's rank",
     ContactLaw::coulomb,
     [] {
       return make_proximal_newton(
           {.start_sweeps = 400, .accelerated = true, .mending_sweeps = 200});
     },
     suitesparse},
    {"newton_burst",
     "ours: active-set Newton between bursts of sweeps, own LU: tight errors of large packings",
     ContactLaw::coulomb, [] { return make_newton_burst(); }, suitesparse},
    {"ipopt",
     "cone program with s-update by Ipopt (Waechter, Biegler 2006): a general interior point",
     ContactLaw::coulomb, [] { return make_ipopt(); }, ipopt},
    {"nlopt_slsqp",
     "cone program with s-update by NLopt's SLSQP (Kraft 1994): a general quadratic program",
     ContactLaw::coulomb, [] { return make_nlopt(); }, nlopt, nlopt_limit},
    {"siconos_nsgs", "Siconos: nonsmooth Gauss-Seidel, hybrid local Newton", ContactLaw::coulomb,
     [] { return make_siconos(SiconosMethod::nsgs); }, siconos},
    {"siconos_nsgs_full", "Siconos: nonsmooth Gauss-Seidel, its true error after every sweep",
     ContactLaw::coulomb, [] { return make_siconos(SiconosMethod::nsgs_full); }, siconos},
    {"siconos_prox", "Siconos: proximal point around a nonsmooth Newton", ContactLaw::coulomb,
     [] { return make_siconos(SiconosMethod::prox); }, siconos},
    {"siconos_admm", "Siconos: ADMM, penalty by residual balancing", ContactLaw::coulomb,
     [] { return make_siconos(SiconosMethod::admm); }, siconos},
    {"siconos_nsn_ac", "Siconos: nonsmooth Newton on Alart-Curnier's function", ContactLaw::coulomb,
     [] { return make_siconos(SiconosMethod::nsn_ac); }, siconos},
};

std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const SolverEntry& entry : solver_list()) names.emplace_back(entry.name);
  return names;
}

}  // namespace

std::span<const SolverEntry> solver_list() {
  // A backend whose library this build lacks has no maker.
  static const std::vector<SolverEntry> list = [] {
    std::vector<SolverEntry> found(std::begin(rows), std::end(rows));
    for (SolverEntry& entry : found)
      if (std::string_view(entry.package) == suitesparse ? !has_sparse_factors() : !entry.make())
        entry.make = nullptr;
    return found;
  }();
  return list;
}

const SolverEntry& find_solver(std::string_view name) {
  for (const SolverEntry& entry : solver_list())
    if (name == entry.name) return entry;
  const std::vector<std::string> names = all_names();
  throw UnknownSolver("no solver is called '" + std::string(name) + "'" +
                      did_you_mean(name, names) + "; there are: " + joined(names));
}

std::unique_ptr<Solver> make_solver(std::string_view name) {
  const SolverEntry& entry = find_solver(name);
  if (!entry.make)
    throw MissingSolver("solver '" + std::string(name) +
                        "' was built without its library; install " + entry.package +
                        " and build again. There are: " + joined(all_names()));
  return entry.make();
}

}  // namespace ballast

#include "solvers/solver_list.hpp"

#include <iterator>
#include <string>
#include <vector>

#include "platform/text.hpp"
#include "solvers/backends/admm.hpp"
#include "solvers/backends/anderson_pgs.hpp"
#include "solvers/backends/apgd.hpp"
#include "solvers/backends/auto.hpp"
#include "solvers/backends/gauss_seidel.hpp"
#include "solvers/backends/interior_point.hpp"
#include "solvers/backends/ipopt.hpp"
#include "solvers/backends/jacobi.hpp"
#include "solvers/backends/nesterov_pgs.hpp"
#include "solvers/backends/newton.hpp"
#include "solvers/backends/newton_burst.hpp"
#include "solvers/backends/nlopt.hpp"
#include "solvers/backends/nncg.hpp"
#include "solvers/backends/pyramid_lemke.hpp"
#include "solvers/backends/sap.hpp"
#include "solvers/backends/siconos.hpp"
#include "solvers/backends/spg.hpp"
#include "solvers/parts/sparse_factor.hpp"

namespace ballast {
namespace {

constexpr Library suitesparse{"libsuitesparse-dev", has_sparse_factors};
constexpr Library ipopt{"coinor-libipopt-dev", has_ipopt};
constexpr Library nlopt{"libnlopt-dev", has_nlopt};
constexpr Library siconos{"libsiconos-numerics-dev", has_siconos};

/// Every backend, as if all libraries were there: name, description, law, maker, library, limit.
constexpr SolverEntry rows[] = {
    {"auto", "ours, recommended: sweeps where they are enough, proximal Newton where not",
     ContactLaw::coulomb, [] { return make_auto(); }, suitesparse},
    {"pgs", "projected Gauss-Seidel, each contact solved exactly (Jean 1999)", ContactLaw::coulomb,
     [] { return make_gauss_seidel(); }},
    {"pgs_projection", "pgs, each contact by one projection (De Saxce, Feng 1998)",
     ContactLaw::coulomb,
     [] { return make_gauss_seidel({.variant = {.rule = LocalRule::projection}}); }},
    {"pgs_newton", "pgs, each contact by Newton on Alart-Curnier's function (1991)",
     ContactLaw::coulomb,
     [] { return make_gauss_seidel({.variant = {.rule = LocalRule::newton}}); }},
    {"psor", "pgs over-relaxed by 1.3", ContactLaw::coulomb,
     [] { return make_gauss_seidel({.variant = {.relaxation = 1.3}}); }},
    {"pgs_symmetric", "pgs, contacts forward and backward by turns", ContactLaw::coulomb,
     [] { return make_gauss_seidel({.variant = {.order = SweepOrder::symmetric}}); }},
    {"pgs_random", "pgs, contacts in another seeded order every sweep", ContactLaw::coulomb,
     [] { return make_gauss_seidel({.variant = {.order = SweepOrder::random}}); }},
    {"nncg", "pgs accelerated by nonlinear conjugate gradients (Silcowitz-Hansen 2010)",
     ContactLaw::coulomb, [] { return make_nncg(); }},
    {"nesterov_pgs", "pgs with Nesterov's momentum, restarted (O'Donoghue, Candes 2015)",
     ContactLaw::coulomb, [] { return make_nesterov_pgs(); }},
    {"jacobi", "damped block Jacobi, each contact solved exactly: the parallel baseline",
     ContactLaw::coulomb, [] { return make_jacobi(); }},
    {"anderson_pgs", "pgs with safeguarded Anderson acceleration (Walker, Ni 2011)",
     ContactLaw::coulomb, [] { return make_anderson_pgs(); }},
    {"apgd", "accelerated projected gradient with s-update (Mazhar 2015)", ContactLaw::coulomb,
     [] { return make_apgd(); }},
    {"spg", "spectral projected gradient with s-update (Birgin, Martinez, Raydan 2000)",
     ContactLaw::coulomb, [] { return make_spg(); }},
    {"admm",
     "alternating directions on one sparse factorisation, with s-update (Acary, Bremond, Huber "
     "2018)",
     ContactLaw::coulomb, [] { return make_admm(); }, suitesparse},
    {"interior_point",
     "primal-dual for second-order cones, Nesterov-Todd scaling, with s-update (Acary et al. "
     "2023)",
     ContactLaw::coulomb, [] { return make_interior_point(); }, suitesparse},
    {"sap", "unconstrained convex problem in velocities (Castro 2022), proximal steps",
     ContactLaw::convex_relaxation, [] { return make_sap(); }, suitesparse},
    {"newton_ac",
     "semismooth Newton on Alart and Curnier's function, sparse LU (Alart, Curnier 1991)",
     ContactLaw::coulomb, [] { return make_newton({.equation = ContactEquation::alart_curnier}); },
     suitesparse},
    {"newton_nm", "semismooth Newton on the natural map, sparse LU", ContactLaw::coulomb,
     [] { return make_newton({.equation = ContactEquation::natural_map}); }, suitesparse},
    {"newton_fb",
     "semismooth Newton on Fischer and Burmeister's function, sparse LU (Fukushima, Luo, Tseng "
     "2002)",
     ContactLaw::coulomb,
     [] { return make_newton({.equation = ContactEquation::fischer_burmeister}); }, suitesparse},
    {"prox_newton", "proximal-point steps, each by semismooth Newton (Acary, Bremond, Huber 2018)",
     ContactLaw::coulomb,
     [] {
       return make_proximal_newton(
           {.start_sweeps = 400, .accelerated = true, .mending_sweeps = 200});
     },
     suitesparse},
    {"newton_burst",
     "ours: regularised active-set Newton between bursts of sweeps, then proximal steps, own LU",
     ContactLaw::coulomb, [] { return make_newton_burst(); }, suitesparse},
    {"ipopt",
     "convex cone program with s-update by Ipopt's interior point (Waechter, Biegler 2006)",
     ContactLaw::coulomb, [] { return make_ipopt(); }, ipopt},
    {"ipopt_mpcc",
     "program with complementarity constraints, relaxed towards zero (Scholtes 2001), by Ipopt",
     ContactLaw::coulomb, [] { return make_ipopt_mpcc(); }, ipopt},
    {"nlopt_slsqp", "convex cone program with s-update by NLopt's SLSQP (Kraft 1994)",
     ContactLaw::coulomb, [] { return make_nlopt(NloptMethod::slsqp); }, nlopt, nlopt_slsqp_limit},
    {"nlopt_mma", "convex cone program with s-update by NLopt's MMA (Svanberg 2002)",
     ContactLaw::coulomb, [] { return make_nlopt(NloptMethod::mma); }, nlopt, nlopt_mma_limit},
    {"nlopt_ccsaq", "convex cone program with s-update by NLopt's CCSAQ (Svanberg 2002)",
     ContactLaw::coulomb, [] { return make_nlopt(NloptMethod::ccsaq); }, nlopt, nlopt_ccsaq_limit},
    {"pyramid_lemke",
     "friction on an 8-sided pyramid by Lemke's pivoting (Stewart, Trinkle 1996)",
     ContactLaw::pyramid,
     [] { return make_pyramid_lemke(); },
     {},
     PyramidLemkeSettings{}.limit()},
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

/// The rows; without a maker where this build lacks the library.
const std::vector<SolverEntry>& entries() {
  static const std::vector<SolverEntry> list = [] {
    std::vector<SolverEntry> found(std::begin(rows), std::end(rows));
    for (SolverEntry& entry : found)
      if (entry.needs.is_built_in && !entry.needs.is_built_in()) entry.make = nullptr;
    return found;
  }();
  return list;
}

std::string all_names() {
  std::string names;
  for (const SolverEntry& entry : entries()) add_to_list(names, entry.name);
  return names;
}

}  // namespace

std::span<const SolverEntry> solver_list() { return entries(); }

const SolverEntry& find_solver(std::string_view name) {
  for (const SolverEntry& entry : entries())
    if (name == entry.name) return entry;
  std::vector<std::string> names;
  for (const SolverEntry& entry : entries()) names.emplace_back(entry.name);
  throw UnknownSolver("no solver is called '" + std::string(name) + "'" +
                      did_you_mean(name, names) + "; there are: " + joined(names));
}

std::unique_ptr<Solver> make_solver(std::string_view name) {
  const SolverEntry& entry = find_solver(name);
  if (!entry.make)
    throw MissingSolver("solver '" + std::string(name) +
                        "' was built without its library; install " + entry.needs.package +
                        " and build again. There are: " + all_names());
  return entry.make();
}

}  // namespace ballast

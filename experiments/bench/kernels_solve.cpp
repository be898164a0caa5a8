// Assembly, judge, sweeps, single contacts and the factorisation.

#include <memory>
#include <stdexcept>

#include "experiments/bench/kernels.hpp"
#include "platform/random.hpp"
#include "problems/algebra/contact_error.hpp"
#include "solvers/gauss_seidel/any_sweep.hpp"
#include "solvers/parts/contact_operator.hpp"
#include "solvers/parts/shifted_delassus.hpp"
#include "solvers/parts/sparse_factor.hpp"

namespace ballast {
namespace {

struct ProblemWork {
  KernelProblem at;
  ProblemAssembler assembler;
  Eigen::VectorXd v_free;
  FrictionProblem problem;
  ContactJudge judge;
  std::vector<Vec3> world;
  Impulses rows;

  explicit ProblemWork(const KernelProblem& problem_) : at(problem_), assembler(at.start.system) {
    assembler.pack(at.start.state, v_free);
    assemble();
    assembler.to_world(rows = at.impulses.head(problem.row_count()), at.contacts, world);
  }
  void assemble() {
    const MotionState& state = at.start.state;
    assembler.assemble({state, at.contacts, v_free, at.h, state.time + at.h}, problem);
  }
};

struct SweepWork {
  FrictionProblem problem;
  Impulses start, end;
  AnySweep sweep;

  enum class Precision { in_double, single };
  /// Single precision where groups are swept (WideSweep::allow_single), refreshed by error().
  SweepWork(const KernelProblem& from, int copies, Precision precision = Precision::in_double)
      : problem(repeated(from.problem, copies)),
        start(repeated(from.warm, copies)),
        end(start.size()) {
    sweep.prepare(problem);
    sweep->allow_single(precision == Precision::single);
    sweep->load(problem, start);
    sweep->start_search();
  }
};

/// Contacts that all end in one status, each with the velocity that others give it.
struct OneContactWork {
  struct Case {
    PrincipalContact contact;
    TangentTurn turn;
    double u[3];
  };
  std::vector<Case> cases;
  double sum = 0.0;

  explicit OneContactWork(ContactStatus wanted) {
    Random random(7);
    constexpr size_t count = 256;
    while (cases.size() < count) {
      Eigen::Matrix3d root;
      for (int k = 0; k < 9; ++k) root(k) = random.uniform(-0.5, 0.5);
      // I + R R^T is positive definite whatever R is.
      const Eigen::Matrix3d w = Eigen::Matrix3d::Identity() + root * root.transpose();
      const double mu = 0.4, reach = wanted == ContactStatus::stick ? 0.2 : 2.0;
      Case one;
      make_principal(w, mu, one.contact, one.turn);
      one.u[0] = wanted == ContactStatus::open ? 1.0 : -1.0;
      for (int k = 1; k < 3; ++k) one.u[k] = random.uniform(-reach, reach);
      Eigen::Vector3d r = Eigen::Vector3d::Zero();
      double lambda = 0.0;
      if (solve_one_contact(w, Eigen::Vector3d(one.u[0], one.u[1], one.u[2]), mu, r, lambda) ==
          wanted)
        cases.push_back(one);
    }
  }
  void all() {
    for (const Case& one : cases) {
      double r[3] = {0.0, 0.0, 0.0}, slip = 0.0;
      resolve_contact(one.contact, one.turn, one.u, r, slip);
      sum += r[0] + r[1] + r[2];
    }
  }
};

/// CHOLMOD on M + H^T Sigma H of the packing.
struct FactorWork {
  ContactOperator w;
  ShiftedDelassus shifted;
  std::vector<Eigen::Matrix3d> shift, sigma;
  Eigen::VectorXd b, x;
};

}  // namespace

void add_problem_kernels(const KernelProblem& problem, std::vector<Kernel>& kernels) {
  const auto work = std::make_shared<ProblemWork>(problem);
  const double contacts = work->problem.contact_count();
  const auto add = [&](const char* name, std::function<void()> call) {
    kernels.push_back({"problem", name, "ns/contact", contacts, std::move(call)});
  };
  add("assembly", [work] { work->assemble(); });
  add("validation", [work] { work->problem.validate(); });
  add("judge", [work] { work->judge.judge(work->problem, work->rows); });
  add("rows to world",
      [work] { work->assembler.to_world(work->rows, work->at.contacts, work->world); });
  add("world to rows", [work] { work->assembler.to_rows(work->world, work->rows); });
}

void add_sweep_kernels(const KernelProblem& problem, int streaming_copies,
                       std::vector<Kernel>& kernels) {
  constexpr auto single = SweepWork::Precision::single;
  const auto cached = std::make_shared<SweepWork>(problem, 1),
             streaming = std::make_shared<SweepWork>(problem, streaming_copies),
             float_lanes = std::make_shared<SweepWork>(problem, 1, single);
  const auto add = [&](const char* name, const std::shared_ptr<SweepWork>& work,
                       std::function<void()> call) {
    kernels.push_back({"sweep", name, "ns/contact",
                       static_cast<double>(work->problem.contact_count()), std::move(call)});
  };
  add("sweep, the packing alone", cached, [cached] { cached->sweep->sweep(); });
  add("sweep, streaming copies of it", streaming, [streaming] { streaming->sweep->sweep(); });
  // What an iteration of nncg does between two looks at the error.
  const SearchStep step{0.1, 1.0};
  add("sweep along a search, the packing alone", cached,
      [cached, step] { cached->sweep->sweep_along(step); });
  add("sweep along a search, streaming", streaming,
      [streaming, step] { streaming->sweep->sweep_along(step); });
  add("sweep in float lanes, the packing alone", float_lanes,
      [float_lanes] { float_lanes->sweep->sweep(); });
  add("sweep in float lanes along a search", float_lanes,
      [float_lanes, step] { float_lanes->sweep->sweep_along(step); });
  add("error in float lanes, with the refresh in double", float_lanes,
      [float_lanes] { float_lanes->sweep->error(); });
  add("error", cached, [cached] { cached->sweep->error(); });
  add("prepare", cached, [cached] { cached->sweep.prepare(cached->problem); });
  add("load", cached, [cached] { cached->sweep->load(cached->problem, cached->start); });
  add("store", cached, [cached] { cached->sweep->store(cached->problem, cached->end); });
}

void add_one_contact_kernels(std::vector<Kernel>& kernels) {
  const std::pair<const char*, ContactStatus> statuses[] = {
      {"take-off", ContactStatus::open},
      {"stick", ContactStatus::stick},
      {"slip, cold root", ContactStatus::slip}};
  for (const auto& [name, status] : statuses) {
    const auto work = std::make_shared<OneContactWork>(status);
    kernels.push_back({"one contact", name, "ns/contact", static_cast<double>(work->cases.size()),
                       [work] { work->all(); }});
  }
}

void add_factor_kernels(const KernelProblem& problem, std::vector<Kernel>& kernels) {
  if (!has_sparse_factors()) return;
  const auto work = std::make_shared<FactorWork>();
  work->w.prepare(problem.problem);
  work->shifted.prepare(work->w);
  for (const double rho : work->w.rho()) {  // P_c = lambda_max(W_cc): ADMM's penalty
    const double penalty = rho > 0.0 ? 1.0 / rho : 1.0;
    work->shift.push_back(penalty * Eigen::Matrix3d::Identity());
    work->sigma.push_back(Eigen::Matrix3d::Identity() / penalty);
  }
  if (!work->shifted.factor(work->shift, work->sigma))
    throw std::runtime_error("bench kernels: W + P of the packing is not definite");
  free_contact_velocity(problem.problem, work->b);
  const double contacts = problem.problem.contact_count();
  kernels.push_back({"factor", "factorisation of the packing", "ns/contact", contacts,
                     [work] { work->shifted.factor(work->shift, work->sigma); }});
  kernels.push_back({"factor", "solve with it", "ns/contact", contacts,
                     [work] { work->shifted.solve(work->b, work->x); }});
}

}  // namespace ballast

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include <siconos/numerics/FrictionContactProblem.h>
#include <siconos/numerics/Friction_cst.h>
#include <siconos/numerics/NonSmoothDrivers.h>
#include <siconos/numerics/NumericsMatrix.h>
#include <siconos/numerics/SolverOptions.h>
#include <siconos/numerics/SparseBlockMatrix.h>

#include "platform/clock.hpp"
#include "solvers/backends/backends.hpp"
#include "solvers/seam/rounds.hpp"

extern "C" void numerics_set_verbose(int);  // in no header that C++ can read

namespace ballast {
namespace {

struct SiconosRecipe {
  int solver;
  double contact_visits;  ///< iterations x contacts of the first round; the next has twice as many
  void (*adjust)(SolverOptions&);
  bool factorises = true;  ///< wants W by columns
  /// Contacts up to which W is dense: there LAPACK is up to 90 times faster than sparse columns.
  int most_dense = 60;
  /// Iterations with a dense W, after which the solver goes on by columns: LAPACK's LU of a
  /// singular matrix may lead a Newton method astray where it converges with the sparse LU.
  int most_dense_iterations = std::numeric_limits<int>::max();
};

/// W by 3 x 3 blocks. A one-row contact gets two more rows with W_NN on the diagonal, q = 0 and mu
/// = 0: no impulse there.
class BlockProblem {
 public:
  explicit BlockProblem(const ReducedProblem& moving)
      : contacts_(moving.contact_count()), friction_(moving.friction) {
    for (int k = 0; k < contacts_; ++k)
      for (int i = 0; i < moving.rows(k); ++i) row_.push_back(3 * k + i);
    q_.setZero(3 * contacts_);
    q_(row_) = moving.q;
    for (int k = 0; k < contacts_; ++k) add_block_row(moving, k);
  }

  /// Siconos' own structures over our storage, each made once. Nothing is ever freed: only
  /// processes that soon end make them.
  FrictionContactProblem* siconos(bool is_dense) {
    FrictionContactProblem*& made = is_dense ? dense_problem_ : by_blocks_;
    if (made) return made;
    NumericsMatrix* w = is_dense ? dense_matrix() : block_matrix();
    made = frictionContactProblem_new_with_data(3, contacts_, w, q_.data(), friction_.data());
    return made;
  }

  Eigen::VectorXd pad(const Eigen::VectorXd& x) const {
    Eigen::VectorXd padded = Eigen::VectorXd::Zero(3 * contacts_);
    padded(row_) = x;
    return padded;
  }
  Eigen::VectorXd unpad(const Eigen::VectorXd& padded) const { return padded(row_); }
  const Eigen::VectorXd& q() const { return q_; }
  int contacts() const { return contacts_; }

 private:
  NumericsMatrix* block_matrix() {
    SparseBlockStructuredMatrix* blocks = SBM_new();
    blocks->nbblocks = static_cast<unsigned>(block_column_.size());
    for (std::size_t i = 0; i < block_column_.size(); ++i) block_.push_back(values_[i].data());
    for (int k = 1; k <= contacts_; ++k) block_end_.push_back(3 * k);
    blocks->block = block_.data();
    blocks->blocknumber0 = blocks->blocknumber1 = static_cast<unsigned>(contacts_);
    blocks->blocksize0 = blocks->blocksize1 = block_end_.data();
    blocks->filled1 = block_begin_.size();
    blocks->filled2 = block_column_.size();
    blocks->index1_data = block_begin_.data();
    blocks->index2_data = block_column_.data();
    return NM_new_SBM(3 * contacts_, 3 * contacts_, blocks);
  }

  NumericsMatrix* dense_matrix() {
    dense_.setZero(3 * contacts_, 3 * contacts_);
    for (int k = 0; k < contacts_; ++k)
      for (std::size_t i = block_begin_[k]; i < block_begin_[k + 1]; ++i)
        dense_.block<3, 3>(3 * k, 3 * static_cast<int>(block_column_[i])) = values_[i];
    return NM_create_from_data(NM_DENSE, 3 * contacts_, 3 * contacts_, dense_.data());
  }

  void add_block_row(const ReducedProblem& moving, int k) {
    std::map<int, Eigen::Matrix3d> blocks;  // by column, in order
    for (int i = 0; i < moving.rows(k); ++i)
      for (SparseRows::InnerIterator entry(moving.w, moving.row_begin[k] + i); entry; ++entry) {
        const int column = row_[entry.col()];
        const auto [block, created] = blocks.try_emplace(column / 3, Eigen::Matrix3d::Zero());
        block->second(i, column % 3) = entry.value();
      }
    if (moving.rows(k) == 1) blocks[k](1, 1) = blocks[k](2, 2) = blocks[k](0, 0);
    for (const auto& [column, block] : blocks) {
      block_column_.push_back(static_cast<std::size_t>(column));
      values_.push_back(block);
    }
    block_begin_.push_back(block_column_.size());
  }

  int contacts_;
  std::vector<int> row_;  ///< where each row of ReducedProblem went
  std::vector<double> friction_;
  Eigen::VectorXd q_;
  std::vector<std::size_t> block_begin_{0}, block_column_;
  std::vector<Eigen::Matrix3d> values_;
  std::vector<double*> block_;
  std::vector<unsigned> block_end_;
  Eigen::MatrixXd dense_;
  FrictionContactProblem *by_blocks_ = nullptr, *dense_problem_ = nullptr;
};

class Siconos final : public Solver {
 public:
  explicit Siconos(const SiconosRecipe& recipe) : recipe_(recipe) {}

  /// Converting W is start-up, as in a program of Siconos' own, and is left to solve().
  void prepare(const FrictionProblem&) override { blocks_.reset(); }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    const Stopwatch watch;
    if (!blocks_) {
      moving_.take(problem);
      blocks_.emplace(moving_);
    }
    const double conversion = watch.seconds();
    double tolerance = first_tolerance(budget);
    // Iterations of the first round: some seconds' worth, so that the clock is checked.
    const double visits = recipe_.contact_visits / std::max(1, blocks_->contacts());
    int chunk = static_cast<int>(std::clamp(visits, 100.0, 1e6));
    is_dense_ = recipe_.factorises && blocks_->contacts() <= recipe_.most_dense;
    Solved solved = solve_in_rounds(
        moving_, std::move(start), budget, /*patience=*/3,
        [&](const RoundRequest& request, RoundAnswer& answer) {
          const int most = is_dense_ ? recipe_.most_dense_iterations : chunk;
          const int limit = std::min({chunk, most, request.left.max_iterations});
          const auto run = [&](RoundAnswer& called) {
            call(request, tolerance, limit, called);
            return true;
          };
          const bool whole = answer_apart(request.left, run, answer);
          answer.finished = !whole || answer.iterations < limit;
          // A problem that dense steps have not solved goes on by columns.
          if (is_dense_ && limit == recipe_.most_dense_iterations)
            is_dense_ = false;
          else if (!answer.finished)
            chunk = chunk > (1 << 28) ? chunk : 2 * chunk;
          else
            tolerance *= std::clamp(0.5 * budget.aim() / request.last_error, 1e-3, 0.5);
        });
    solved.startup_seconds += conversion;
    return solved;
  }

 private:
  /// Siconos' error is a norm over contacts divided by max(|q|, |r|, |u|).
  double first_tolerance(const Budget& budget) const {
    // Slightly below the margin of reached(): an answer within that would cost a whole round more.
    if (budget.fclib) return budget.fclib->tolerance() * (1.0 - 2.0 * stop_margin);
    const double contacts = std::max(1.0, static_cast<double>(blocks_->contacts()));
    const double q = blocks_->q().norm();
    // Ours is rms over contacts: times the root of their number it is a norm like Siconos'.
    return budget.tolerance * std::sqrt(contacts) / (q > 0.0 ? q : 1.0);
  }

  /// One call of Siconos from the best iterate. The clock runs in fc3d_driver alone.
  void call(const RoundRequest& request, double tolerance, int limit, RoundAnswer& answer) {
    numerics_set_verbose(0);
    FrictionContactProblem* problem = blocks_->siconos(is_dense_);
    // The columns of a sparse W are kept in the matrix: made once, not timed.
    if (recipe_.factorises && !is_dense_) NM_csc(problem->M);
    SolverOptions* options = solver_options_create(recipe_.solver);
    recipe_.adjust(*options);
    options->dparam[SICONOS_DPARAM_TOL] = tolerance;
    options->iparam[SICONOS_IPARAM_MAX_ITER] = limit;
    Eigen::VectorXd r = blocks_->pad(request.best), u = blocks_->q();
    NM_gemv(1.0, problem->M, r.data(), 1.0, u.data());
    const Stopwatch watch;
    fc3d_driver(problem, r.data(), u.data(), options);
    answer.seconds = watch.seconds();
    answer.iterations = options->iparam[SICONOS_IPARAM_ITER_DONE];
    solver_options_delete(options);
    answer.x = blocks_->unpad(r);
  }

  const SiconosRecipe& recipe_;
  ReducedProblem moving_;
  std::optional<BlockProblem> blocks_;  ///< of moving_; nothing before the first solve()
  bool is_dense_ = false;
};

void use_hybrid_newton(SolverOptions& options) {
  solver_options_update_internal(&options, 0, SICONOS_FRICTION_3D_ONECONTACT_NSN_GP_HYBRID);
  options.internalSolvers[0]->iparam[SICONOS_FRICTION_3D_NSN_HYBRID_STRATEGY] =
      SICONOS_FRICTION_3D_NSN_HYBRID_STRATEGY_NSN_AND_PLI_NSN_LOOP;
}

/// Indexed by SiconosMethod.
const SiconosRecipe recipes[] = {
    {SICONOS_FRICTION_3D_NSGS, 2e6, use_hybrid_newton, false},
    // Siconos measures a sweep by its change: with that it goes on long after the error is small.
    {SICONOS_FRICTION_3D_NSGS, 2e6,
     [](SolverOptions& options) {
       use_hybrid_newton(options);
       options.iparam[SICONOS_FRICTION_3D_IPARAM_ERROR_EVALUATION] =
           SICONOS_FRICTION_3D_NSGS_ERROR_EVALUATION_FULL;
     },
     false},
    {SICONOS_FRICTION_3D_PROX, 1e5, [](SolverOptions&) {}},
    {SICONOS_FRICTION_3D_ADMM, 2e6,
     [](SolverOptions& options) {
       options.iparam[SICONOS_FRICTION_3D_ADMM_IPARAM_RHO_STRATEGY] =
           SICONOS_FRICTION_3D_ADMM_RHO_STRATEGY_RESIDUAL_BALANCING;
     }},
    {SICONOS_FRICTION_3D_NSN_AC, 1e5, [](SolverOptions&) {}, true, 45, 200}};

}  // namespace

std::unique_ptr<Solver> make_siconos(SiconosMethod method) {
  return std::make_unique<Siconos>(recipes[static_cast<int>(method)]);
}

}  // namespace ballast

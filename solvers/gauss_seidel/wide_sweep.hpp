#pragma once
// The Gauss-Seidel sweep over bodies, sixteen contacts at a time (group_kernels.hpp).
//
// It takes the problems of time steps: bodies with six unknowns and the mass diag(m, m, m, 3 x 3),
// contacts whose sides have opposite linear parts, and driven walls of one unknown without
// friction. For anything else prepare() returns false, and ScalarSweep takes the problem.

#include <algorithm>
#include <span>
#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "problems/algebra/mass_root.hpp"
#include "solvers/gauss_seidel/contact_sweep.hpp"
#include "solvers/gauss_seidel/sweep_plan.hpp"

namespace ballast {

class WideSweep final : public ContactSweep {
 public:
  /// The plan, whose team shares the sweep's work, must outlive it.
  explicit WideSweep(const SweepPlan& plan) : plan_(plan) {}

  /// The plan must have been prepared for `problem`. False, and nothing else may be called: another
  /// kind of problem, or one whose lanes would mostly stay empty.
  bool prepare(const FrictionProblem& problem);

  void load(const FrictionProblem& problem, const Impulses& r) override;
  void store(const FrictionProblem& problem, Impulses& r) const override;
  void sweep() override { sweep_in_precision(nullptr); }
  void start_search() override;
  double sweep_along(SearchStep step) override { return sweep_in_precision(&step); }
  double error() override;

  /// Sets whether records and impulses from the next load() on are in single precision, until their
  /// rounding may show in the error. error() computes in double, also with them.
  void allow_single(bool allowed) override { single_allowed_ = allowed; }
  /// The error of the single-precision iterate at less than error()'s cost, at times error().
  double rough_error() override;
  bool is_storable() const override { return !in_single_ || unseen_ == 0; }
  bool is_single() const override { return in_single_; }

  /// For tests: sets the instruction set, lets no group rest, returns how many groups rest.
  void use_kernels(const GroupKernels& kernels) { kernels_ = &kernels; }
  void allow_rests(bool allowed) { may_rest_ = allowed; }
  int resting_groups() const;

 private:
  /// The groups of one kind, and their impulses.
  template <typename Group>
  struct Kind {
    using Loops = GroupLoops<Group>;
    std::vector<Group> groups;
    std::vector<GroupFrame> frames;  ///< in double only
    std::vector<typename Loops::Impulses> impulses;
    std::vector<typename Loops::Search> search;  ///< empty before a search's first sweep
    // In single precision only: velocities at the last error evaluation; groups to sweep (Range).
    std::vector<GroupVelocities<Group::rows>> seen;
    std::vector<int> awake;
  };
  /// All groups and the iterate, in double or single precision.
  template <typename Number>
  struct State : Kinds<Kind, Number> {
    /// Indexed by row_of_body_. Each part of the plan has one more row, which never moves.
    std::vector<BodyRow<Number>> bodies, before, direction;
  };
  /// Groups begin .. begin + count - 1 of a kind. In single precision only the groups begin + i are
  /// swept, where i is one of kind.awake[begin] .. kind.awake[begin + awake - 1].
  struct Range {
    int begin = 0, count = 0, awake = 0;
  };
  /// The groups of one part of the plan. Its thread writes its sums: it has its own cache lines.
  struct alignas(64) Part {
    Range friction, one_row, wall;
    Range bodies;                ///< rows of the slab's bodies; interiors only
    int shared = 0;              ///< interfaces touch the first `shared` of these bodies
    int nowhere = 0;             ///< the row that never moves
    double change_square = 0.0;  ///< of the last sweep along a search
    double error_square = 0.0;   ///< of error()
    double impulse_square = 0.0, drift_square = 0.0;  ///< at the last error() in single precision
    bool is_vectorisable = true;  ///< there are groups for all kinds of its contacts
  };
  /// The groups of contacts of a part.
  struct Grouping {
    /// The contacts in the lanes, group_lanes for each group of a kind; -1: none.
    std::vector<int> friction, one_row, wall;
    std::vector<int> wall_of_group;  ///< the driven wall of each group of wall contacts
    int contacts = 0, on_walls = 0;  ///< numbers of contacts that something moves
  };

  /// Calls task() with the friction members of all `each`, then the one_row, then the wall ones.
  template <typename Task, typename... Each>
  static void for_each_kind(const Task& task, Each&... each) {
    task(each.friction...);
    task(each.one_row...);
    task(each.wall...);
  }

  bool sort_bodies(const DynamicsForm& dynamics);
  bool may_fill_lanes(const DynamicsForm& dynamics);
  void place_bodies(const DynamicsForm& dynamics);
  bool group_contacts(const DynamicsForm& dynamics);
  bool group_part(const DynamicsForm& dynamics, int number);
  template <typename Number>
  bool make_records(const FrictionProblem& problem);
  void need_exact();
  template <typename Group>
  bool make_group(const FrictionProblem& problem, const int* lanes, int nowhere, Group& group,
                  GroupFrame& frame, const ExactLoops<Group>& loops) const;
  template <typename Group>
  bool fill_lane(const FrictionProblem& problem, Group& group, GroupFrame& frame, int lane) const;
  void free_bodies(const DynamicsForm& dynamics);
  /// Calls task(part) for all interiors at the same time, then for all interfaces.
  template <typename Number, typename Task>
  void for_parts_in_phases(const State<Number>& state, const Task& task) {
    plan_.for_parts_in_phases([&](const SweepPlan::Part&, int number) {
      if (number >= plan_.slabs()) prefetch_shared(state, parts_[number]);
      task(parts_[number]);
    });
  }
  /// Calls task(number) for all parts, each slab followed by the interface behind it. Each thread
  /// has the same parts as in for_parts_in_phases().
  template <typename Task>
  void for_parts_by_slab(const Task& task) const {
    plan_.for_slabs([&](int begin, int end) {
      for (int slab = begin; slab < end; ++slab) {
        task(slab);
        if (slab + 1 < plan_.slabs()) task(plan_.slabs() + slab);
      }
    });
  }
  /// Calls task(parts) for one or two at a time of the slabs' parts, or of the interfaces'.
  template <typename Task>
  void for_pairs(std::span<Part> parts, const Task& task) {
    plan_.for_slabs([&](int begin, int end) {
      for (const int last = std::min(end, static_cast<int>(parts.size())); begin < last; begin += 2)
        task(parts.subspan(begin, std::min(2, last - begin)));
    });
  }
  template <typename Number>
  void prefetch_shared(const State<Number>& state, const Part& interface) const;
  const auto& kernels_of(const State<double>&) const { return kernels_->exact; }
  const auto& kernels_of(const State<float>&) const { return kernels_->single; }
  template <typename Number>
  void load_into(State<Number>& state, const Impulses& r);
  template <typename Number>
  void store_from(const State<Number>& state, Impulses& r) const;
  template <typename Number>
  void push_part(const State<Number>& state, Part& part);
  template <typename Number>
  void sweep_parts(State<Number>& state, const SearchStep* step, std::span<Part> parts);
  template <typename Number>
  double sweep_in(State<Number>& state, const SearchStep* step);
  double sweep_in_precision(const SearchStep* step);
  template <typename Number>
  void start_search_in(State<Number>& state);

  void settle(Part& part);
  template <typename Number, typename BodyNumber>
  double error_in(const State<Number>& state, const State<BodyNumber>& moved);
  double sum(double Part::*number) const;
  void choose_awake(double error);
  void leave_single();

  const SweepPlan& plan_;
  const GroupKernels* kernels_ = all_group_kernels().front();

  std::vector<MassRoot> roots_;
  std::vector<char> is_wall_;          ///< of each body
  std::vector<char> is_shared_;        ///< of each body: has contacts in an interface
  std::vector<int> contacts_of_body_;  ///< scratch space of may_fill_lanes()
  std::vector<int> row_of_body_;       ///< slab by slab, so that threads share no cache line
  int rows_ = 0;
  std::vector<Grouping> groupings_;  ///< of each part; never shrinks
  int contacts_ = 0;                 ///< number of contacts that something moves

  const FrictionProblem* problem_ = nullptr;  ///< of the last load()
  State<double> exact_;                       ///< bodies and frames; the rest where it is needed
  bool exact_made_ = false;                   ///< its records, since prepare()
  std::vector<BodyRow<double>> free_;
  std::vector<Part> parts_;  ///< in the plan's order, in which sums over parts are added

  State<float> single_;                       ///< see settle()
  std::vector<BodyRow<double>> last_bodies_;  ///< exact_.bodies at the last error()
  Impulses start_;                            ///< as they were loaded
  bool at_start_ = false;                     ///< no sweep since then
  bool single_begins_ = false;                ///< no look in single precision since then
  bool single_allowed_ = false;               ///< from the next load() on
  bool may_rest_ = true;                      ///< see choose_awake()
  bool in_single_ = false;
  bool search_begins_ = false;  ///< the next sweep_along() starts the search
  int unseen_ = 0;              ///< single sweeps since the last error()
  double seen_error_ = 0.0;     ///< what that error() returned
};

}  // namespace ballast

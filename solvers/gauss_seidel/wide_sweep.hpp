#pragma once
// The Gauss-Seidel sweep over bodies, sixteen contacts at a time (group_record.hpp).
//
// For what a time step gives: bodies with six unknowns and the mass diag(m, m, m, 3 x 3), contacts
// whose sides have opposite linear parts, and driven walls of one unknown without friction. Of
// anything else it says so, and ScalarSweep takes it.

#include <vector>

#include "platform/worker_team.hpp"
#include "problems/algebra/friction_problem.hpp"
#include "problems/algebra/mass_root.hpp"
#include "solvers/gauss_seidel/contact_groups.hpp"
#include "solvers/gauss_seidel/group_kernels.hpp"
#include "solvers/gauss_seidel/sweep_plan.hpp"

namespace ballast {

class WideSweep {
 public:
  /// Both outlive the sweep.
  WideSweep(const SweepPlan& plan, WorkerTeam& team) : plan_(plan), team_(team) {}

  /// The plan has been prepared for `problem`. False, and nothing else may be called: another kind
  /// of problem, or one whose groups would stay empty for the most part.
  bool prepare(const FrictionProblem& problem);
  /// As in BodySweep.
  void load(const FrictionProblem& problem, const Impulses& r);
  void store(const FrictionProblem& problem, Impulses& r) const;
  void sweep();
  double sweep(SearchStep step);
  void start_search();
  double error();
  void save(Eigen::VectorXd& state) const;
  void restore(const Eigen::VectorXd& state);
  void impulse_weights(Eigen::VectorXd& weights) const;
  /// The contacts one after the other: a sweep in this order is the same.
  std::vector<int> order() const;

  /// For tests: another instruction set.
  void use_kernels(const GroupKernels& kernels) { kernels_ = &kernels; }

 private:
  /// The groups of one kind, and the iterate that goes with them.
  template <typename Group>
  struct Kind {
    using Loops = GroupLoops<Group>;
    std::vector<Group> groups;
    std::vector<GroupFrame> frames;
    std::vector<typename Loops::Impulses> impulses;
    std::vector<typename Loops::Search> search;
  };
  struct Range {
    int begin = 0, count = 0;
  };
  /// The groups of one part of the plan.
  struct Part {
    Range friction, one_row, wall;
    double change_square = 0.0;  ///< of the last sweep along a search
    double error_square = 0.0;   ///< of error()
  };

  bool sort_bodies(const DynamicsForm& dynamics);
  bool group_contacts(const FrictionProblem& problem);
  bool group_part(const FrictionProblem& problem, const SweepPlan::Part& part, int nowhere,
                  std::vector<Part>& parts);
  template <typename Group>
  Range add_groups(Kind<Group>& kind, int nowhere);
  template <typename Group>
  bool make_records(const FrictionProblem& problem, Kind<Group>& kind,
                    const ExactLoops<Group>& loops);
  template <typename Group>
  bool fill_lane(const FrictionProblem& problem, Group& group, GroupFrame& frame, int lane) const;
  void free_bodies(const DynamicsForm& dynamics);
  /// Calls task(part) for the interiors, then for the interfaces; those of a kind at the same time.
  template <typename Task>
  void for_parts(const Task& task);
  /// Calls task(kind) for the three kinds.
  template <typename Task>
  void for_kinds(const Task& task) {
    task(friction_);
    task(one_row_);
    task(wall_);
  }
  template <typename Task>
  void for_kinds(const Task& task) const {
    task(friction_);
    task(one_row_);
    task(wall_);
  }

  const SweepPlan& plan_;
  WorkerTeam& team_;
  const GroupKernels* kernels_ = &group_kernels();

  std::vector<MassRoot> roots_;
  std::vector<char> is_wall_;  ///< of each body
  ContactGroups grouping_;
  std::vector<int> chosen_, walls_, grain_a_, grain_b_;  ///< room for group_part()
  int contacts_ = 0;                                     ///< that something moves

  Kind<FrictionGroup<double>> friction_;
  Kind<OneRowGroup<double>> one_row_;
  Kind<WallGroup<double>> wall_;
  std::vector<Part> interiors_, interfaces_;
  /// Bodies, then one row for each part of the plan that never moves.
  std::vector<BodyRow<double>> free_, bodies_, before_, direction_;
};

}  // namespace ballast

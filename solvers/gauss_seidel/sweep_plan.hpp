#pragma once
// The order of a sweep over bodies: slabs of bodies that threads can sweep side by side, within a
// slab an order in which one contact rarely waits for the one before, and contacts that vectors can
// solve side by side.
//
// A sweep is a chain of dependencies only where contacts share a body. Contacts in the order of
// their bodies wait for each other at every step (28 ns a contact); taken by turns from all bodies
// of a slab they overlap in the processor (13 ns from its own cache).
//
// Where bodies are numbered along the world, as the grains of a box are along x, slabs are about
// ranges of numbers. All lists that follow the bodies are then cut in about the same places, and
// each thread finds its side of them in its own cache. Else slabs are cut along a breadth-first
// search.
//
// Contacts whose gap would take long to close come last, the widest at the end. Most of them stay
// open: side by side they can be passed over together (WideSweep).

#include <algorithm>
#include <span>
#include <vector>

#include "platform/worker_team.hpp"
#include "problems/algebra/friction_problem.hpp"
#include "solvers/gauss_seidel/group_kernels.hpp"

namespace ballast {

/// Depends on the problem's graph alone, never on the number of threads: the same bits whoever
/// sweeps.
class SweepPlan {
 public:
  /// Contacts of contacts()[begin] .. [end - 1]. Those with friction come first.
  struct Part {
    int begin, friction_end, end;
  };

  /// Sets the team that shares the plan's work and that of its sweeps; null: the caller alone.
  void use_team(WorkerTeam* team) { team_ = team; }
  WorkerTeam* team() const { return team_; }
  /// `problem` has the dynamics form.
  void prepare(const FrictionProblem& problem);

  const std::vector<int>& contacts() const { return contacts_; }
  int slabs() const { return slabs_; }
  /// Bodies of a slab, ascending: bodies of no other slab are in parts()[slab].
  std::span<const int> bodies(int slab) const {
    return {bodies_.data() + body_begin_[slab],
            static_cast<size_t>(body_begin_[slab + 1] - body_begin_[slab])};
  }
  /// The interiors of slabs, then the interfaces: that of slabs k and k + 1 is parts()[slabs() +
  /// k]. No two interiors share a body; nor do two interfaces.
  const std::vector<Part>& parts() const { return parts_; }

  /// Calls task(begin, end) for ranges of slabs that cover [0, slabs()), shared by the team: each
  /// member has neighbouring slabs with about as many contacts as any other, the same in every
  /// call.
  template <typename Task>
  void for_slabs(const Task& task) const {
    run_parts(team_, static_cast<int>(edges_.size()) - 1, [&](int k) {
      if (edges_[k] < edges_[k + 1]) task(edges_[k], edges_[k + 1]);
    });
  }
  /// Calls task(part, its number) for the slabs' interiors, all at the same time, then for the
  /// interfaces.
  template <typename Task>
  void for_parts_in_phases(const Task& task) const {
    for_slabs([&](int begin, int end) {
      for (int k = begin; k < end; ++k) task(parts_[k], k);
    });
    for_slabs([&](int begin, int end) {
      for (int k = slabs_ + begin; k < slabs_ + std::min(end, slabs_ - 1); ++k) task(parts_[k], k);
    });
  }
  /// Where those ranges begin, and the end of the last; each member has as many of them. One range
  /// where there is one slab.
  const std::vector<int>& edges() const { return edges_; }

  /// Bodies of one slab: enough work between two meetings of the threads.
  static constexpr int slab_bodies = 500;
  /// Slabs follow the numbers only where there are so many of them, or as many as are wanted.
  static constexpr int least_slabs = 4;
  /// Contacts that open more slowly than 2^-10 times the fastest stand among those that close: more
  /// of them would be torn out of the order in which loads travel.
  static constexpr int gap_octaves = 10;

 private:
  void find_slabs(const DynamicsForm& dynamics);
  void weigh(const DynamicsForm& dynamics);
  void sort_by_neighbours(const DynamicsForm& dynamics);
  bool cut_in_order(const DynamicsForm& dynamics, int wanted);
  void find_levels(const DynamicsForm& dynamics);
  int breadth_first(int root, int level);
  void cut_levels(int wanted);
  void find_openings(const FrictionProblem& problem, int begin, int end);
  void order(const FrictionProblem& problem);
  void share_slabs();
  WorkerTeam* team_ = nullptr;
  std::vector<int> ends_;  ///< bodies a and b of each contact between two that move
  std::vector<int> neighbour_begin_, neighbour_;  ///< bodies that share a contact
  /// Breadth-first distance, and the order in which bodies are cut into slabs; contacts join a
  /// level to itself or the next.
  std::vector<int> level_, queue_;
  int levels_ = 0;
  std::vector<int> slab_;    ///< of each body
  std::vector<int> weight_;  ///< contacts of each body
  long total_weight_ = 0;
  std::vector<char> meets_;  ///< of each body: 1 the slab below, 2 the slab above, 3 both
  int slabs_ = 1;
  std::vector<int> bodies_, body_begin_;
  std::vector<long> number_sum_;  ///< of each body's own number and of its neighbours'
  std::vector<int> key_, count_, rank_;
  std::vector<double> opening_;  ///< of each contact [m/s]
  std::vector<int> contacts_;
  std::vector<Part> parts_;
  std::vector<int> edges_;
};

/// Contacts in groups that are solved side by side: no two contacts of a group share a body, and
/// groups one after the other keep the order in which each body's contacts come. Sweeping group
/// after group is therefore the same Gauss-Seidel sweep as contact after contact. They depend on
/// the contacts and their order alone, never on the width of registers.
class ContactGroups {
 public:
  /// A contact goes into the first group that has a free lane and comes after all groups with one
  /// of its bodies. `body_a`, `body_b`: of each of the `contacts`, 0 .. bodies - 1; -1: nothing
  /// that could be shared.
  void make(std::span<const int> contacts, std::span<const int> body_a, std::span<const int> body_b,
            int bodies);

  int count() const { return static_cast<int>(fill_.size()); }
  /// The contacts in a group's lanes; -1: none.
  std::span<const int, group_lanes> lanes(int group) const {
    return std::span<const int, group_lanes>(lanes_.data() + group * group_lanes, group_lanes);
  }

 private:
  int first_with_room(int group);

  std::vector<int> lanes_;  ///< group_lanes a group
  std::vector<int> fill_;   ///< contacts of each group
  std::vector<int> next_;   ///< itself while there is room, else a later group to ask
  std::vector<int> last_;   ///< of each body: its last group
};

}  // namespace ballast

#pragma once
// Islands: the parts of a problem that have nothing to do with one another. Contacts join the
// bodies that can move; what has no unknowns (walls, fixed bodies) joins nothing.

#include <span>
#include <vector>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// Sets of 0 .. count - 1, each named by its smallest member.
class DisjointSets {
 public:
  /// Every number in a set of its own.
  void reset(int count);
  int find(int i);
  void join(int i, int j);

 private:
  std::vector<int> parent_;  // parent_[i] <= i
};

/// The islands of a problem in dynamics form, in the order of their first bodies. Bodies without
/// contacts and contacts between two bodies that cannot move belong to none.
class Islands {
 public:
  void find(const FrictionProblem& problem);

  int count() const { return static_cast<int>(body_begin_.size()) - 1; }
  /// Numbers in the problem, ascending.
  std::span<const int> bodies(int island) const { return part(bodies_, body_begin_, island); }
  std::span<const int> contacts(int island) const {
    return part(contacts_, contact_begin_, island);
  }

  /// The island as a problem of its own; its bodies and contacts are numbered in the orders above.
  /// `problem`: the one given to find(). No allocation once `result` has grown.
  void extract(const FrictionProblem& problem, int island, FrictionProblem& result) const;

  /// Between stacked rows of the problem and of the island.
  void gather(const FrictionProblem& problem, int island, const Impulses& whole,
              Impulses& result) const;
  void scatter(const FrictionProblem& problem, int island, const Impulses& result,
               Impulses& whole) const;

 private:
  static std::span<const int> part(const std::vector<int>& list, const std::vector<int>& begin,
                                   int island) {
    return std::span(list).subspan(begin[island], begin[island + 1] - begin[island]);
  }
  void number_bodies(const FrictionProblem& problem);
  void list_contacts(const FrictionProblem& problem);

  DisjointSets sets_;
  std::vector<int> island_of_;  // body -> island, or -1
  std::vector<int> local_;      // body -> its number in its island
  std::vector<int> body_begin_{0}, bodies_;
  std::vector<int> contact_begin_{0}, contacts_;
};

}  // namespace ballast

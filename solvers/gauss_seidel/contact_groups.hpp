#pragma once
// Contacts in groups that are solved side by side: no two contacts of a group share a body, and
// groups one after the other keep the order in which each body's contacts come. Sweeping group
// after group is therefore the same Gauss-Seidel sweep as contact after contact.

#include <span>
#include <vector>

#include "solvers/gauss_seidel/group_record.hpp"

namespace ballast {

/// Depends on the contacts and their order alone, never on the width of registers.
class ContactGroups {
 public:
  /// Forgets all groups. Bodies are 0 .. bodies - 1.
  void begin(int bodies);

  /// Appends groups of these contacts. A contact goes into the first group that has a free lane and
  /// comes after all groups of this call with one of its bodies. `body_a`, `body_b`: of each
  /// contact, -1: nothing that could be shared.
  void add(std::span<const int> contacts, std::span<const int> body_a, std::span<const int> body_b);

  int count() const { return static_cast<int>(fill_.size()); }
  /// The contacts in a group's lanes; -1: none.
  std::span<const int, group_lanes> lanes(int group) const {
    return std::span<const int, group_lanes>(lanes_.data() + group * group_lanes, group_lanes);
  }

 private:
  int first_with_room(int group);
  void append_group();

  std::vector<int> lanes_;  ///< group_lanes a group
  std::vector<int> fill_;   ///< contacts of each group
  std::vector<int> next_;   ///< itself while there is room, else a later group to ask
  std::vector<int> last_;   ///< of each body: its last group
};

}  // namespace ballast

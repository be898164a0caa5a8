#include "problems/algebra/islands.hpp"

#include <numeric>
#include <utility>

namespace ballast {
namespace {

/// The contact's body that can move, or -1.
int moving_body(const DynamicsForm& dynamics, int c) {
  return dynamics.body_a[c] >= 0 ? dynamics.body_a[c] : dynamics.body_b[c];
}

}  // namespace

void DisjointSets::reset(int count) {
  parent_.resize(count);
  std::iota(parent_.begin(), parent_.end(), 0);
}

int DisjointSets::find(int i) {
  while (parent_[i] != i) {
    parent_[i] = parent_[parent_[i]];  // halves the path for the next one
    i = parent_[i];
  }
  return i;
}

void DisjointSets::join(int i, int j) {
  // The smallest member gives the set its name, whatever the order in which sets are joined.
  int low = find(i), high = find(j);
  if (low > high) std::swap(low, high);
  parent_[high] = low;
}

void Islands::find(const FrictionProblem& problem) {
  const DynamicsForm& dynamics = problem.dynamics;
  // Contacts between two bodies that can move join their sets.
  sets_.reset(dynamics.body_count());
  for (int c = 0; c < problem.contact_count(); ++c)
    if (dynamics.body_a[c] >= 0 && dynamics.body_b[c] >= 0)
      sets_.join(dynamics.body_a[c], dynamics.body_b[c]);
  number_bodies(problem);
  list_contacts(problem);
}

// Islands in the order of their first bodies; -1 for bodies that no contact touches.
void Islands::number_bodies(const FrictionProblem& problem) {
  const DynamicsForm& dynamics = problem.dynamics;
  island_of_.assign(dynamics.body_count(), -1);
  local_.assign(dynamics.body_count(), -1);
  // Sets that a contact touches are marked, then numbered in the order of their bodies.
  constexpr int touched = 0;
  for (int c = 0; c < problem.contact_count(); ++c)
    if (const int body = moving_body(dynamics, c); body >= 0)
      island_of_[sets_.find(body)] = touched;

  // a set's name is its smallest member, which comes first
  body_begin_.assign(1, 0);
  for (int b = 0; b < dynamics.body_count(); ++b) {
    const int root = sets_.find(b);
    if (island_of_[root] < 0) continue;
    if (root == b) {
      island_of_[b] = count();
      body_begin_.push_back(0);
    }
    island_of_[b] = island_of_[root];
    local_[b] = body_begin_[island_of_[b] + 1]++;
  }
  for (int i = 0; i < count(); ++i) body_begin_[i + 1] += body_begin_[i];
  bodies_.resize(body_begin_.back());
  for (int b = 0; b < dynamics.body_count(); ++b)
    if (island_of_[b] >= 0) bodies_[body_begin_[island_of_[b]] + local_[b]] = b;
}

/// Contacts by island: counted, summed up and filled in, so that those of each ascend.
void Islands::list_contacts(const FrictionProblem& problem) {
  const DynamicsForm& dynamics = problem.dynamics;
  contact_begin_.assign(count() + 1, 0);
  for (int c = 0; c < problem.contact_count(); ++c)
    if (const int body = moving_body(dynamics, c); body >= 0)
      ++contact_begin_[island_of_[body] + 1];
  for (int i = 0; i < count(); ++i) contact_begin_[i + 1] += contact_begin_[i];
  contacts_.resize(contact_begin_.back());
  std::vector<int> next(contact_begin_.begin(), contact_begin_.end() - 1);
  for (int c = 0; c < problem.contact_count(); ++c)
    if (const int body = moving_body(dynamics, c); body >= 0)
      contacts_[next[island_of_[body]]++] = c;
}

void Islands::extract(const FrictionProblem& problem, int island, FrictionProblem& result) const {
  const DynamicsForm& from = problem.dynamics;
  result.clear();
  result.has_dynamics = true;
  DynamicsForm& to = result.dynamics;
  // Bodies and contacts stay in the order that they have in the whole problem.
  for (const int b : bodies(island)) {
    to.dof_begin.push_back(to.dof_begin.back() + from.body_dofs(b));
    to.mass.insert(to.mass.end(), from.mass.begin() + from.mass_begin[b],
                   from.mass.begin() + from.mass_begin[b + 1]);
    to.mass_begin.push_back(static_cast<int>(to.mass.size()));
  }
  to.v_free.resize(to.dof_count());
  for (const int b : bodies(island))
    to.v_free.segment(to.dof_begin[local_[b]], from.body_dofs(b)) =
        from.v_free.segment(from.dof_begin[b], from.body_dofs(b));

  const auto local = [&](int body) { return body < 0 ? -1 : local_[body]; };
  for (const int c : contacts(island)) {
    result.row_begin.push_back(result.row_begin.back() + problem.contact_rows(c));
    result.friction.push_back(problem.friction[c]);
    to.body_a.push_back(local(from.body_a[c]));
    to.body_b.push_back(local(from.body_b[c]));
    to.h.insert(to.h.end(), from.h.begin() + from.h_begin[c], from.h.begin() + from.h_begin[c + 1]);
    to.h_begin.push_back(static_cast<int>(to.h.size()));
  }
  gather(problem, island, from.bias, to.bias);
}

/// The rows of an island's contacts, taken out of those of all; scatter() puts them back.
void Islands::gather(const FrictionProblem& problem, int island, const Impulses& whole,
                     Impulses& result) const {
  int rows = 0;
  for (const int c : contacts(island)) rows += problem.contact_rows(c);
  result.resize(rows);
  int row = 0;
  for (const int c : contacts(island))
    for (int k = problem.row_begin[c]; k < problem.row_begin[c + 1]; ++k) result[row++] = whole[k];
}

void Islands::scatter(const FrictionProblem& problem, int island, const Impulses& result,
                      Impulses& whole) const {
  int row = 0;
  for (const int c : contacts(island))
    for (int k = problem.row_begin[c]; k < problem.row_begin[c + 1]; ++k) whole[k] = result[row++];
}

}  // namespace ballast

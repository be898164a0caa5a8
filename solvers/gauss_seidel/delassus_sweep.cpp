#include "solvers/gauss_seidel/delassus_sweep.hpp"

#include <algorithm>
#include <cstring>

#include "platform/for_each_cpu.hpp"
#include "problems/algebra/contact_error.hpp"
#include "solvers/gauss_seidel/lanes.hpp"

namespace ballast {
namespace {

using Contact = DelassusSweep::Contact;
using BlockRows = DelassusSweep::BlockRows;

/// Three numbers side by side; the fourth is unused.
using Column = double __attribute__((vector_size(32)));

/// Returns u_c = W_c r + q_c in the given tangents: a row of 3 x 3 blocks times the impulses. The
/// three columns of blocks have separate sums, so that additions need not wait for each other.
BALLAST_INLINE Column velocity(const BlockRows& w, const Contact& contact, const double* r) {
  Column sums[3] = {{contact.q[0], contact.q[1], contact.q[2], 0.0}, {}, {}};
  for (int k = contact.begin; k < contact.end; ++k) {
    const double* block = w.blocks + 9 * static_cast<size_t>(k);
    const double* impulse = r + 3 * w.contacts[k];
    for (int j = 0; j < 3; ++j) {
      Column column;
      std::memcpy(&column, block + 3 * j, sizeof column);
      sums[j] += column * impulse[j];
    }
  }
  return sums[0] + (sums[1] + sums[2]);
}

/// Solves the contacts in turn. Each one sees the new impulses of those before it.
BALLAST_FOR_EACH_CPU
void sweep_rows(const BlockRows& w, Contact* contacts, int count, double* r) {
  for (int c = 0; c < count; ++c) {
    const Column u = velocity(w, contacts[c], r);
    const double velocity[3] = {u[0], u[1], u[2]};
    resolve_contact(contacts[c].local, contacts[c].turn, velocity, r + 3 * c, contacts[c].slip);
  }
}

/// Writes the velocities of `count` contacts from `first` on to `u`, four numbers each.
BALLAST_FOR_EACH_CPU
void find_velocities(const BlockRows& w, const Contact* first, int count, const double* r,
                     double* u) {
  for (int c = 0; c < count; ++c) {
    const Column moved = velocity(w, first[c], r);
    std::memcpy(u + 4 * c, &moved, sizeof moved);
  }
}

}  // namespace

void DelassusSweep::prepare(const FrictionProblem& problem) {
  const int contacts = problem.contact_count(), rows = problem.row_count();
  // The contact of each row; and for each contact the last block that was made for its column.
  std::vector<int> scratch(rows + contacts, -1);
  int *contact_of_row = scratch.data(), *slot = contact_of_row + rows;
  for (int c = 0; c < contacts; ++c)
    for (int row = problem.row_begin[c]; row < problem.row_begin[c + 1]; ++row)
      contact_of_row[row] = c;

  block_contact_.clear();
  blocks_.clear();
  const int full_blocks = static_cast<int>(problem.delassus.w.nonZeros()) / 9 + contacts;
  block_contact_.reserve(full_blocks);
  blocks_.reserve(9 * full_blocks + 1);
  contacts_.assign(contacts, {});
  r_.setZero(3 * contacts);
  for (int c = 0; c < contacts; ++c) {
    Contact& contact = contacts_[c];
    contact.begin = static_cast<int>(block_contact_.size());
    if (!append_whole_blocks(problem, c, contact_of_row))
      append_entries(problem, c, contact_of_row, slot);
    contact.end = static_cast<int>(block_contact_.size());
    // The contact's own block W_cc, in the coordinates in which the contact is solved.
    Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
    for (int k = contact.begin; k < contact.end; ++k)
      if (block_contact_[k] == c) own = Eigen::Matrix3d(blocks_.data() + 9 * k);
    const Eigen::Matrix3d symmetric = 0.5 * (own + own.transpose());
    make_principal(symmetric, problem.friction[c], contact.local, contact.turn);
    contact.lambda_max = largest_eigenvalue(symmetric);
    for (int i = 0; i < problem.contact_rows(c); ++i)
      contact.q[i] = problem.delassus.q[problem.row_begin[c] + i];
  }
  blocks_.push_back(0.0);  // velocity() reads four numbers where the last column has three
}

/// Appends the blocks of contact c if its three rows have entries in the same columns, all columns
/// of contacts with three rows each, as in most files. False: nothing was appended.
bool DelassusSweep::append_whole_blocks(const FrictionProblem& problem, int c,
                                        const int* contact_of_row) {
  const SparseRows& w = problem.delassus.w;
  if (problem.contact_rows(c) != 3 || !w.isCompressed()) return false;
  const int first = problem.row_begin[c], begin = w.outerIndexPtr()[first],
            count = w.outerIndexPtr()[first + 1] - begin;
  if (w.outerIndexPtr()[first + 3] - begin != 3 * count || count % 3 != 0) return false;
  const int* column = w.innerIndexPtr() + begin;
  if (!std::equal(column, column + count, column + count) ||
      !std::equal(column, column + count, column + 2 * count))
    return false;
  for (int k = 0; k < count; k += 3) {
    const int other = contact_of_row[column[k]];
    if (problem.contact_rows(other) != 3 || problem.row_begin[other] != column[k] ||
        column[k + 2] != column[k] + 2)
      return false;
  }
  const double* value = w.valuePtr() + begin;
  size_t at = blocks_.size();
  blocks_.resize(at + 3 * count);
  for (int k = 0; k < count; k += 3) {
    block_contact_.push_back(contact_of_row[column[k]]);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) blocks_[at++] = value[i * count + k + j];
  }
  return true;
}

/// Appends the blocks of contact c, entry by entry, in the order of their first entries. `slot`:
/// the last block in each contact's column, below the number of blocks.
void DelassusSweep::append_entries(const FrictionProblem& problem, int c, const int* contact_of_row,
                                   int* slot) {
  const int begin = static_cast<int>(block_contact_.size());
  for (int i = 0; i < problem.contact_rows(c); ++i)
    for (SparseRows::InnerIterator entry(problem.delassus.w, problem.row_begin[c] + i); entry;
         ++entry) {
      const int column = static_cast<int>(entry.col()), other = contact_of_row[column];
      if (slot[other] < begin) {
        slot[other] = static_cast<int>(block_contact_.size());
        block_contact_.push_back(other);
        blocks_.resize(blocks_.size() + 9, 0.0);
      }
      blocks_[9 * slot[other] + 3 * (column - problem.row_begin[other]) + i] = entry.value();
    }
}

void DelassusSweep::load(const FrictionProblem& problem, const Impulses& r) {
  for (int c = 0; c < problem.contact_count(); ++c) {
    // A sweep could keep the given impulse of a contact that nothing moves along its normal.
    const double weight = contacts_[c].local.inverse_normal > 0.0 ? 1.0 : 0.0;
    for (int i = 0; i < problem.contact_rows(c); ++i)
      r_[3 * c + i] = weight * r[problem.row_begin[c] + i];
  }
}

void DelassusSweep::store(const FrictionProblem& problem, Impulses& r) const {
  for (int c = 0; c < problem.contact_count(); ++c)
    for (int i = 0; i < problem.contact_rows(c); ++i) r[problem.row_begin[c] + i] = r_[3 * c + i];
}

void DelassusSweep::sweep() {
  sweep_rows(rows(), contacts_.data(), static_cast<int>(contacts_.size()), r_.data());
}

void DelassusSweep::start_search() {
  before_ = r_;
  direction_.setZero(r_.size());
}

double DelassusSweep::sweep_along(SearchStep step) {
  for (Eigen::Index i = 0; i < r_.size(); ++i)
    step.move(/*change=*/r_[i] - before_[i], direction_[i], r_[i]);
  before_ = r_;
  sweep();
  return (r_ - before_).squaredNorm();
}

double DelassusSweep::error() {
  constexpr int most = 16;  // contacts at a time
  double u[4 * most];
  RootMeanSquare mean;
  for (int c = 0; c < static_cast<int>(contacts_.size()); ++c) {
    const Contact& contact = contacts_[c];
    if (c % most == 0) {
      const int count = std::min(most, static_cast<int>(contacts_.size()) - c);
      find_velocities(rows(), &contact, count, r_.data(), u);
    }
    if (!(contact.lambda_max > 0.0)) continue;
    mean.add(ContactJudge::scaled_natural_map(r_.segment<3>(3 * c),
                                              Eigen::Vector3d(u + 4 * (c % most)), contact.local.mu,
                                              contact.lambda_max));
  }
  return mean.value();
}

}  // namespace ballast

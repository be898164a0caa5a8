#include "solvers/gauss_seidel/delassus_sweep.hpp"

#include "problems/algebra/contact_error.hpp"

namespace ballast {

void DelassusSweep::prepare(const FrictionProblem& problem) {
  const int contacts = problem.contact_count();
  const SparseRows& w = problem.delassus.w;
  std::vector<int> contact_of_row(problem.row_count());
  for (int c = 0; c < contacts; ++c)
    for (int row = problem.row_begin[c]; row < problem.row_begin[c + 1]; ++row)
      contact_of_row[row] = c;

  // The contacts that W couples with each, in the order of their first entries, and the blocks.
  block_begin_.assign(1, 0);
  block_begin_.reserve(contacts + 1);
  block_contact_.clear();
  blocks_.clear();
  const int full_blocks = static_cast<int>(w.nonZeros()) / 9 + contacts;
  block_contact_.reserve(full_blocks);
  blocks_.reserve(9 * full_blocks);
  contacts_.assign(contacts, {});
  q_.setZero(3 * contacts);
  r_.setZero(3 * contacts);
  std::vector<int> slot(contacts, -1);  // of a neighbour in the block row at hand
  for (int c = 0; c < contacts; ++c) {
    for (int i = 0; i < problem.contact_rows(c); ++i)
      for (SparseRows::InnerIterator entry(w, problem.row_begin[c] + i); entry;) {
        const int other = contact_of_row[entry.col()];
        const int first = problem.row_begin[other], rows = problem.contact_rows(other);
        if (slot[other] < block_begin_.back()) {
          slot[other] = static_cast<int>(block_contact_.size());
          block_contact_.push_back(other);
          blocks_.resize(blocks_.size() + 9, 0.0);
        }
        double* block = blocks_.data() + 9 * slot[other];
        for (; entry; ++entry) {
          const int j = static_cast<int>(entry.col()) - first;
          if (j < 0 || j >= rows) break;
          block[3 * j + i] = entry.value();
        }
      }
    // Its own block, in the coordinates in which it is solved.
    Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
    if (slot[c] >= block_begin_.back()) own = Eigen::Matrix3d(blocks_.data() + 9 * slot[c]);
    const Eigen::Matrix3d symmetric = 0.5 * (own + own.transpose());
    make_principal(symmetric, problem.friction[c], contacts_[c].local, contacts_[c].turn);
    contacts_[c].lambda_max = largest_eigenvalue(symmetric);
    for (int i = 0; i < problem.contact_rows(c); ++i)
      q_[3 * c + i] = problem.delassus.q[problem.row_begin[c] + i];
    block_begin_.push_back(static_cast<int>(block_contact_.size()));
  }
}

void DelassusSweep::load(const FrictionProblem& problem, const Impulses& r) {
  for (int c = 0; c < problem.contact_count(); ++c) {
    // An impulse that moves nothing would stay as it was given.
    const double weight = contacts_[c].local.inverse_normal > 0.0 ? 1.0 : 0.0;
    for (int i = 0; i < problem.contact_rows(c); ++i)
      r_[3 * c + i] = weight * r[problem.row_begin[c] + i];
  }
}

void DelassusSweep::store(const FrictionProblem& problem, Impulses& r) const {
  for (int c = 0; c < problem.contact_count(); ++c)
    for (int i = 0; i < problem.contact_rows(c); ++i) r[problem.row_begin[c] + i] = r_[3 * c + i];
}

/// A row of 3 x 3 blocks times the impulses.
void DelassusSweep::velocity(int c, double* u) const {
  double sum[3] = {q_[3 * c], q_[3 * c + 1], q_[3 * c + 2]};
  for (int k = block_begin_[c]; k < block_begin_[c + 1]; ++k) {
    const double* block = blocks_.data() + 9 * k;
    const double* r = r_.data() + 3 * block_contact_[k];
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) sum[i] += block[3 * j + i] * r[j];
  }
  for (int i = 0; i < 3; ++i) u[i] = sum[i];
}

void DelassusSweep::sweep() {
  // Each contact already sees the impulses that those before it have just been given.
  for (int c = 0; c < static_cast<int>(contacts_.size()); ++c) {
    Contact& contact = contacts_[c];
    double u[3];
    velocity(c, u);
    resolve_contact(contact.local, contact.turn, u, r_.data() + 3 * c, contact.slip);
  }
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

void DelassusSweep::sweep_by(const SweepVariant& variant, const std::vector<int>& contacts) {
  for (const int c : contacts) {
    Contact& contact = contacts_[c];
    const PrincipalContact& local = contact.local;
    double u[3], *r = r_.data() + 3 * c, y[3] = {r[0], r[1], r[2]};
    velocity(c, u);
    // Into principal coordinates and back, as resolve_contact() does in registers.
    contact.turn.to_principal(u[1], u[2]);
    contact.turn.to_principal(y[1], y[2]);
    u[1] -= local.c1 * u[0];
    u[2] -= local.c2 * u[0];
    y[0] += local.c1 * y[1] + local.c2 * y[2];
    resolve_by_variant(variant, local, contact.lambda_max, u, y, contact.slip);
    r[0] = y[0] - local.c1 * y[1] - local.c2 * y[2];
    contact.turn.from_principal(y[1], y[2]);
    r[1] = y[1];
    r[2] = y[2];
  }
}

double DelassusSweep::error() {
  RootMeanSquare mean;
  for (int c = 0; c < static_cast<int>(contacts_.size()); ++c) {
    const Contact& contact = contacts_[c];
    if (!(contact.lambda_max > 0.0)) continue;
    Eigen::Vector3d u;
    velocity(c, u.data());
    const Eigen::Vector3d r(r_[3 * c], r_[3 * c + 1], r_[3 * c + 2]);
    mean.add(ContactJudge::scaled_natural_map(r, u, contact.local.mu, contact.lambda_max));
  }
  return mean.value();
}

}  // namespace ballast

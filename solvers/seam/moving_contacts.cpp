#include "solvers/seam/moving_contacts.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"

namespace ballast {

void MovingContacts::take(const FrictionProblem& problem) {
  std::vector<Eigen::Matrix3d> diagonal;
  delassus_diagonal(problem, diagonal);
  const SparseRows whole = delassus_matrix(problem);
  Eigen::VectorXd whole_q;
  free_contact_velocity(problem, whole_q);

  // The contacts to keep, and where their rows go.
  contact.clear();
  row_begin.assign(1, 0);
  friction.clear();
  lambda_max.clear();
  std::vector<int> row_here(problem.row_count(), -1);
  for (int c = 0; c < problem.contact_count(); ++c) {
    const double largest = largest_eigenvalue(diagonal[c]);
    if (!(largest > 0.0)) continue;
    contact.push_back(c);
    friction.push_back(problem.friction[c]);
    lambda_max.push_back(largest);
    for (int i = 0; i < problem.contact_rows(c); ++i)
      row_here[problem.row_begin[c] + i] = row_begin.back() + i;
    row_begin.push_back(row_begin.back() + problem.contact_rows(c));
  }
  // Their part of q and W.
  q.resize(row_count());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(whole.nonZeros());
  for (int row = 0; row < problem.row_count(); ++row) {
    if (row_here[row] < 0) continue;
    q[row_here[row]] = whole_q[row];
    for (SparseRows::InnerIterator entry(whole, row); entry; ++entry)
      if (row_here[entry.col()] >= 0)
        entries.emplace_back(row_here[row], row_here[entry.col()], entry.value());
  }
  w.resize(row_count(), row_count());
  w.setFromTriplets(entries.begin(), entries.end());
}

void MovingContacts::gather(const FrictionProblem& problem, const Impulses& r,
                            Eigen::VectorXd& x) const {
  x.resize(row_count());
  for (int k = 0; k < contact_count(); ++k)
    x.segment(row_begin[k], rows(k)) = r.segment(problem.row_begin[contact[k]], rows(k));
}

void MovingContacts::scatter(const FrictionProblem& problem, const Eigen::VectorXd& x,
                             Impulses& r) const {
  r.setZero(problem.row_count());
  for (int k = 0; k < contact_count(); ++k)
    r.segment(problem.row_begin[contact[k]], rows(k)) = x.segment(row_begin[k], rows(k));
}

}  // namespace ballast

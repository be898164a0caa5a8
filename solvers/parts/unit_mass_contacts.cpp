#include "solvers/parts/unit_mass_contacts.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/friction_cone.hpp"

namespace ballast {

void UnitMassContacts::prepare(const FrictionProblem& problem) {
  const DynamicsForm& d = problem.dynamics;
  std::vector<MassRoot> roots;
  std::vector<Eigen::Matrix3d> diagonal;
  delassus_diagonal(problem, roots, diagonal);  // factors the masses into roots, too
  body_count_ = d.body_count();
  free_ = Eigen::VectorXd::Zero(unknown_count());
  for (int b = 0; b < body_count_; ++b) {
    double* x = free_.data() + width * b;
    std::copy_n(d.v_free.data() + d.dof_begin[b], d.body_dofs(b), x);
    // x = L^T v: the kinetic energy is |x|^2 / 2.
    roots[b].multiply_upper(x);
  }
  row_begin_ = problem.row_begin;
  contacts_.resize(problem.contact_count());
  for (int c = 0; c < contact_count(); ++c) {
    Contact& k = contacts_[c];
    const int rows = problem.contact_rows(c), body[2] = {d.body_a[c], d.body_b[c]};
    k.friction = problem.friction[c];
    k.half_line = rows == 1 || !(k.friction > 0.0);
    k.lambda_max = std::max(0.0, largest_eigenvalue(diagonal[c]));
    k.bias.setZero();
    k.bias.head(rows) = d.bias.segment(problem.row_begin[c], rows);
    const double* block = d.h.data() + d.h_begin[c];
    // G = H L^-T body by body. `block` holds the columns of a, then those of b, and none for what
    // does not move: that is body number body_count_, whose G is zero, so that its x stays zero.
    for (int s = 0; s < 2; ++s) {
      k.body[s] = body[s] < 0 ? body_count_ : body[s];
      k.g[s].setZero();
      if (body[s] < 0) continue;
      const MassRoot& root = roots[body[s]];
      const auto store_column = [&](int j, const double* column) {
        for (int i = 0; i < rows; ++i) k.g[s](i, j) = column[i];
      };
      if (rows == 3)
        root.scaled_columns<3>(block, store_column);
      else
        root.scaled_columns<1>(block, store_column);
      block += rows * root.dofs;
    }
  }
}

void UnitMassContacts::from_impulses(const Impulses& r, ContactColumns& columns) const {
  columns.setZero(3, contact_count());
  for (int c = 0; c < contact_count(); ++c)
    for (int i = row_begin_[c]; i < row_begin_[c + 1]; ++i) columns(i - row_begin_[c], c) = r[i];
  project(columns);
}

void UnitMassContacts::to_impulses(const ContactColumns& columns, Impulses& r) const {
  r.resize(row_begin_.back());
  for (int c = 0; c < contact_count(); ++c)
    for (int i = row_begin_[c]; i < row_begin_[c + 1]; ++i) r[i] = columns(i - row_begin_[c], c);
}

void UnitMassContacts::project(ContactColumns& r) const {
  for (int c = 0; c < contact_count(); ++c)
    r.col(c) = contacts_[c].lambda_max > 0.0
                   ? project_cone(Eigen::Vector3d(r.col(c)), contacts_[c].friction)
                   : Eigen::Vector3d::Zero();
}

void UnitMassContacts::body_velocity(const ContactColumns& r, Eigen::VectorXd& x) const {
  x = free_;
  for (int c = 0; c < contact_count(); ++c) push(x, c, r.col(c));
}

double UnitMassContacts::error(const ContactColumns& r,
                               const std::function<Eigen::Vector3d(int)>& u) const {
  RootMeanSquare mean;
  for (int c = 0; c < contact_count(); ++c) {
    const Contact& k = contacts_[c];
    if (!(k.lambda_max > 0.0)) continue;
    mean.add(ContactJudge::scaled_natural_map(r.col(c), u(c), k.friction, k.lambda_max));
  }
  return mean.value();
}

}  // namespace ballast

#pragma once
// Newton's method on the regularised law of all contacts (regular_law.hpp): every contact's status
// is guessed from the iterate, and the equations that belong to the statuses are solved exactly.

#include <vector>

#include "solvers/parts/body_matrix.hpp"
#include "solvers/parts/regular_law.hpp"
#include "solvers/parts/unit_mass_contacts.hpp"

namespace ballast {

/// Impulses and the body velocities that they give. Linear in each other: an iterate and a step of
/// it are combined alike.
struct NewtonIterate {
  ContactColumns r;
  Eigen::VectorXd x;
};

class RegularNewton {
 public:
  /// `problem` has the dynamics form and outlives the use.
  void prepare(const FrictionProblem& problem);
  const UnitMassContacts& contacts() const { return contacts_; }
  /// FrontLu::use_team
  void use_team(WorkerTeam* team) { matrix_.use_team(team); }
  double operations() const { return matrix_.operations(); }

  /// The iterate with x from r.
  NewtonIterate iterate(const Impulses& r) const;
  /// Every impulse into its cone, x from r afresh. Returns the judge's error [m/s].
  double settle(NewtonIterate& at) const;

  /// From here on the law is regularised by `epsilon` around `centre`, and no status is known.
  void set_centre(const ContactColumns& centre, double epsilon);
  /// Natural map of the regularised law [m/s], rms over contacts; the law's own error where `at` is
  /// the centre.
  double residual(const NewtonIterate& at) const;
  /// Every contact's status at `at`, and its law linearised for it. Returns how many contacts had
  /// another status when they were last linearised around this centre; 0 the first time.
  int linearise(const NewtonIterate& at);
  /// One factorisation: the full step from where the law was linearised. It may raise the residual
  /// a hundredfold where statuses change. False: the matrix is singular or the step not finite.
  bool step(NewtonIterate& change);

 private:
  Eigen::Vector3d velocity(const NewtonIterate& at, int c) const;
  void improve(Eigen::VectorXd& x);

  UnitMassContacts contacts_;
  BodyMatrix matrix_;
  ContactColumns centre_;
  double epsilon_ = 1e-3;
  std::vector<Eigen::Matrix3d> gain_;
  ContactColumns source_;
  std::vector<ContactStatus> status_;
  bool has_status_ = false;
  Eigen::VectorXd right_, rest_;
};

}  // namespace ballast

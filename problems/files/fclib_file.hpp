#pragma once
// What problem files hold before it becomes a FrictionProblem, and FCLIB's HDF5 layout (fclib 3.1):
// /fclib_local/{spacedim, W, vectors/{q, mu}}, /fclib_global/{spacedim, M, H, vectors/{f, w, mu}},
// and of answers:
//
//   /solution/{r, u}     impulses [N s] and relative velocities [m/s], three per contact
//   /solution/v          velocities of the bodies (dynamics form) [m/s, rad/s]
//   /ballast_answer/...  one number or text each: what was asked, and what the judge found

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "platform/error.hpp"
#include "platform/hdf5_file.hpp"
#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// M v = H r + f, u = H^T v + w: H is unknowns x contact rows, the transpose of ours.
struct GlobalProblem {
  Eigen::SparseMatrix<double> m, h;
  Eigen::VectorXd f, w;
  std::vector<double> mu;
};

inline std::vector<double> as_vector(const Eigen::VectorXd& x) {
  return {x.data(), x.data() + x.size()};
}
inline Eigen::VectorXd as_eigen(const std::vector<double>& x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

/// Keeps the dynamics form when the unknowns can be grouped into bodies of six, or of three, so
/// that M is block diagonal and a contact touches at most two of them; one unknown may be left for
/// a last body. Forms W otherwise, of an M that need not be quite symmetric. Throws InvalidProblem:
/// sizes that do not agree, an M that is not positive definite, entries that are not finite where W
/// is formed.
FrictionProblem to_friction_problem(const GlobalProblem& global);

/// How a global problem divides: body b has unknowns dof_begin[b] .. dof_begin[b+1], contact c is
/// between body_a[c] and body_b[c] (-1: nothing that moves) and has the first rows[c] of its rows.
struct Division {
  std::vector<int> dof_begin{0}, body_a, body_b, rows;
};

/// The dynamics form by a division that fits the matrices' sizes; entries that it has no place for
/// are left out. v_free remains to be set.
FrictionProblem divided(const GlobalProblem& global, const Division& division);

/// Rows of the problem as three per contact, tangents of one-row contacts being zero, and back.
Eigen::VectorXd three_rows(const FrictionProblem& problem, const Eigen::VectorXd& x);
Eigen::VectorXd own_rows(const FrictionProblem& problem, const Eigen::VectorXd& wide);

/// Of the dynamics form. One-row contacts become three rows with mu = 0, of which two are empty.
GlobalProblem to_global_problem(const FrictionProblem& problem);

/// Any problem by W and q alone: W is built where only bodies are known. One-row contacts as above.
FrictionProblem condensed(const FrictionProblem& problem);

/// By the global form where a file has both, not yet validated. Throws Error: not HDF5, a dataset
/// that is missing, has the wrong size or holds NaN, 2-D, bilateral parts; InvalidProblem.
FrictionProblem read_fclib(const std::filesystem::path& file);
/// The global form alone.
GlobalProblem read_global(const Hdf5Reader& file);

/// What a written file has: bodies (M, H) where they are known and W where not, W (built where only
/// bodies are known), or W beside what is known of bodies.
enum class StoredForms { as_known, delassus, both };

/// The whole file or none: written beside and renamed. `add` adds what else shall be in it. One-row
/// contacts become three rows with mu = 0 (the format knows no others). Throws Error;
/// InvalidProblem before anything is written.
void write_problem(const std::filesystem::path& file, const FrictionProblem& problem,
                   StoredForms forms = StoredForms::as_known,
                   const std::function<void(Hdf5Writer&)>& add = nullptr);

struct StoredSolution {
  Impulses r;  ///< rows as in the problem
  std::vector<std::pair<std::string, double>> numbers;
  std::vector<std::pair<std::string, std::string>> texts;
};

/// u and v are computed from r. Written whole or not at all. Throws Error.
void write_solution(const std::filesystem::path& file, const FrictionProblem& problem,
                    const StoredSolution& solution);

/// The impulses of a dataset, three a contact. Throws Error: none there, of another number of
/// contacts, not finite.
Impulses read_impulses(const Hdf5Reader& file, const std::string& dataset,
                       const FrictionProblem& problem);
/// The same of /solution/r, whoever wrote the file.
Impulses read_solution(const std::filesystem::path& file, const FrictionProblem& problem);

/// The finite numbers of a dataset, of which there must be `size` where it is given. Throws Error.
std::vector<double> read_vector(const Hdf5Reader& file, const std::string& dataset,
                                std::optional<std::size_t> size = std::nullopt);

}  // namespace ballast

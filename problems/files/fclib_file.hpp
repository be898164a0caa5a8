#pragma once
// Content of problem files before it becomes a FrictionProblem. FCLIB's HDF5 layout (fclib 3.1) is
// /fclib_local/{spacedim, W, vectors/{q, mu}}, /fclib_global/{spacedim, M, H, vectors/{f, w, mu}};
// answers have:
//
//   /solution/{r, u}     impulses [N s] and relative velocities [m/s], three per contact
//   /solution/v          velocities of the bodies (dynamics form) [m/s, rad/s]
//   /ballast_answer/...  one number or text each: the request, and the judge's findings

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
/// a last body. Otherwise forms W, from an M that need not be quite symmetric. Throws
/// InvalidProblem for sizes that do not agree, an M that is not positive definite, and entries that
/// are not finite where W is formed.
FrictionProblem to_friction_problem(const GlobalProblem& global);

/// How a global problem divides: body b has unknowns dof_begin[b] .. dof_begin[b+1], contact c is
/// between body_a[c] and body_b[c] (-1: nothing that moves) and has the first rows[c] of its rows.
struct Division {
  std::vector<int> dof_begin{0}, body_a, body_b, rows;
};

/// Returns the dynamics form by a division that fits the matrices' sizes; entries outside its
/// blocks are left out. The caller sets v_free.
FrictionProblem divided(const GlobalProblem& global, const Division& division);

/// Convert rows of the problem to three per contact (missing tangents are zero), and back.
Eigen::VectorXd three_rows(const FrictionProblem& problem, const Eigen::VectorXd& x);
Eigen::VectorXd own_rows(const FrictionProblem& problem, const Eigen::VectorXd& wide);

/// Needs the dynamics form. One-row contacts become three rows with mu = 0, of which two are empty.
GlobalProblem to_global_problem(const FrictionProblem& problem);

/// Any problem as W and q: W is built where only bodies are known. One-row contacts are as above.
FrictionProblem condensed(const FrictionProblem& problem);

/// Prefers the global form where a file has both; does not validate. Throws Error: not HDF5, a
/// dataset that is missing, has the wrong size or holds NaN, 2-D, bilateral parts; InvalidProblem.
FrictionProblem read_fclib(const std::filesystem::path& file);
/// Reads the global form.
GlobalProblem read_global(const Hdf5Reader& file);

/// The forms in a written file: bodies (M, H) where they are known and else W; W alone (built where
/// only bodies are known); or W, with the bodies where they are known.
enum class StoredForms { as_known, delassus, both };

/// Writes the whole file or none: beside, then renamed. `add` writes additional content. One-row
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

/// Writes the whole file or none; u and v are computed from r. Throws Error.
void write_solution(const std::filesystem::path& file, const FrictionProblem& problem,
                    const StoredSolution& solution);

/// Reads the impulses of a dataset, three per contact. Throws Error where it is missing, of another
/// number of contacts, or not finite.
Impulses read_impulses(const Hdf5Reader& file, const std::string& dataset,
                       const FrictionProblem& problem);
/// Reads /solution/r in the same way, from a file of any origin.
Impulses read_solution(const std::filesystem::path& file, const FrictionProblem& problem);

/// Reads a dataset of finite numbers, which must have `size` entries if it is given. Throws Error.
std::vector<double> read_vector(const Hdf5Reader& file, const std::string& dataset,
                                std::optional<std::size_t> size = std::nullopt);

}  // namespace ballast

#include "problems/files/solution_file.hpp"

#include <cmath>

#include "platform/hdf5_file.hpp"
#include "problems/files/problem_file_error.hpp"
#include "problems/files/stored_problem.hpp"

namespace ballast {

void write_solution(const std::filesystem::path& path, const FrictionProblem& problem,
                    const StoredSolution& solution) {
  Eigen::VectorXd u, v;
  contact_velocity(problem, solution.r, u);
  with_problem_file_errors([&] {
    Hdf5Writer file(path, Hdf5Storage::plain);
    file.add_group("/solution");
    file.add("/solution/r", as_vector(three_rows(problem, solution.r)));
    file.add("/solution/u", as_vector(three_rows(problem, u)));
    if (problem.has_dynamics) {
      body_velocity(problem.dynamics, problem.row_begin, solution.r, v);
      file.add("/solution/v", as_vector(v));
    }
    file.add_group("/ballast_answer");
    for (const auto& [name, value] : solution.numbers)
      file.add("/ballast_answer/" + name, std::vector<double>{value});
    for (const auto& [name, text] : solution.texts) file.add_text("/ballast_answer/" + name, text);
    file.commit();
  });
}

Impulses read_solution(const std::filesystem::path& path, const FrictionProblem& problem) {
  return with_problem_file_errors([&] {
    const Hdf5Reader file(path);
    const std::vector<double> r = file.read_doubles("/solution/r");
    const auto rows = 3 * static_cast<std::size_t>(problem.contact_count());
    if (r.size() != rows)
      file.fail("/solution/r has " + std::to_string(r.size()) + " entries, the problem's " +
                std::to_string(problem.contact_count()) + " contacts have " + std::to_string(rows));
    for (std::size_t i = 0; i < r.size(); ++i)
      if (!std::isfinite(r[i])) file.fail("/solution/r[" + std::to_string(i) + "] is not finite");
    return own_rows(problem, as_eigen(r));
  });
}

}  // namespace ballast

#pragma once
// A folder of problems, for tests of commands that take whole collections.

#include <filesystem>

#include "problems/algebra/known_solutions.hpp"
#include "problems/files/problem_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {

/// A folder "in" with the same problem twice, once in a subfolder. The folder "out" is not made.
struct ProblemFolder {
  TemporaryFolder folder;
  KnownSolution known = make_known_solution({.bodies = 6, .contacts = 12});
  std::filesystem::path in = folder.path() / "in", out = folder.path() / "out";
  ProblemFolder() {
    std::filesystem::create_directories(in / "deep");
    write_problem(in / "a.hdf5", known.problem);
    write_problem(in / "deep" / "b.hdf5", known.problem);
  }
};

}  // namespace ballast

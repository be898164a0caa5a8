// Broken meshes and stored problems: the program names the file and the place in it, and exits with
// 1.

#include <filesystem>
#include <fstream>

#include "experiments/record/checkpoint.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/files/problem_file.hpp"
#include "solvers/solver_list.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

const std::string tetrahedron_vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
const std::string tetrahedron_faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// Two contacts with W = 1, q = -1 and mu as given, in Siconos' dense text format.
std::string dense_problem(const std::string& w_entry, const std::string& q_entry,
                          const std::string& mu) {
  return "3\n1\n0 3 3\n3 3\n" + w_entry + " 0 0 0 1 0 0 0 1\n" + q_entry + " 0 0\n" + mu + "\n";
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace

TEST_CASE("a sound mesh is described, a broken one is exit code 1") {
  const TemporaryFolder folder;
  const auto sound = folder.write("sound.obj", tetrahedron_vertices + tetrahedron_faces);
  const ProgramResult described = ballast_program({"check", sound.string()});
  CHECK(described.status == 0);
  CHECK_THAT(described.output,
             Catch::Contains("4 vertices, 6 edges, 4 faces, volume 0.166667 m^3"));

  struct Wrong {
    std::string name, text;
    std::vector<std::string> named;
  };
  const std::vector<Wrong> wrongs = {
      {"empty.obj", "", {}},
      {"words.obj", "v one two three\n", {"1", "one"}},
      {"nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + tetrahedron_faces, {"1", "nan"}},
      {"infinite.obj", "v 0 0 0\nv inf 0 0\nv 0 1 0\nv 0 0 1\n" + tetrahedron_faces, {"2", "inf"}},
      {"index.obj", tetrahedron_vertices + "f 1 3 9\n", {"5", "9"}},
      {"open.obj", tetrahedron_vertices + "f 1 3 2\nf 1 2 4\nf 1 4 3\n", {}},
      {"inside_out.obj", tetrahedron_vertices + "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n", {}},
      {"one_face_turned.obj", tetrahedron_vertices + "f 1 2 3\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", {}},
      {"three_on_an_edge.obj",
       tetrahedron_vertices + "v 1 1 1\n" + tetrahedron_faces + "f 1 2 5\nf 2 1 5\n",
       {}},
      {"flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n" + tetrahedron_faces, {}},
      {"unused_vertex.obj", tetrahedron_vertices + "v 5 5 5\n" + tetrahedron_faces, {}},
      {"cut.stl", "solid grain\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n", {}},
      {"binary_cut.stl",
       std::string(80, ' ') + std::string("\x04\x00\x00\x00", 4) + "too short",
       {}},
  };
  for (const Wrong& wrong : wrongs) {
    INFO(wrong.name);
    std::vector<std::string> named = wrong.named;
    named.push_back(wrong.name);
    check_failure(ballast_program({"check", folder.write(wrong.name, wrong.text).string()}),
                  ExitCode::failure, named);
    // The same mesh in a scene: the error names the scene's line and the mesh's.
    const auto scene = folder.write(
        "scene.toml", "[[body]]\nshape = \"mesh\"\nmass = 1\nfile = \"" + wrong.name + "\"\n");
    named.insert(named.end(), {"scene.toml:4", "body.0.file = \"" + wrong.name + "\""});
    check_failure(ballast_program({"check", scene.string()}), ExitCode::failure, named);
  }
  check_failure(ballast_program({"check", sound.string(), (folder.path() / "none.obj").string()}),
                ExitCode::failure, {"none.obj"});
}

TEST_CASE("a stored problem is solved, a broken one is exit code 1") {
  const TemporaryFolder folder;
  const auto sound = folder.write("sound.dat", dense_problem("1", "-1", "0.5"));
  const ProgramResult solved = ballast_program({"solve", sound.string()});
  INFO(solved.errors);
  CHECK(solved.status == 0);
  CHECK_THAT(solved.output, Catch::Contains("sound.dat") && Catch::Contains("reached_tolerance") &&
                                Catch::Contains("solved"));

  KnownSolution known = make_known_solution({});
  add_delassus_form(known.problem);
  const auto whole = folder.path() / "whole.hdf5";
  write_problem(whole, known.problem);
  CHECK(ballast_program({"check", whole.string()}).status == 0);
  const std::string bytes = bytes_of(whole);

  const std::vector<std::pair<std::string, std::string>> wrongs = {
      {"empty.dat", ""},
      {"words.dat", "no problem at all\n"},
      {"short.dat", "3\n1\n0 3 3\n3 3\n1 0 0\n"},
      {"two_dimensional.dat", "2\n1\n0 2 2\n2 2\n1 0 0 1\n-1 0\n0.5\n"},
      {"nan.dat", dense_problem("nan", "-1", "0.5")},
      {"infinite.dat", dense_problem("1", "inf", "0.5")},
      {"negative_friction.dat", dense_problem("1", "-1", "-0.5")},
      {"indefinite.dat", dense_problem("-1", "-1", "0.5")},
      {"empty.hdf5", ""},
      {"text.hdf5", "no HDF5 at all"},
      {"cut.hdf5", bytes.substr(0, bytes.size() / 2)},
  };
  for (const auto& [name, text] : wrongs) {
    INFO(name);
    const auto file = folder.write(name, text);
    for (const char* command : {"solve", "check"})
      check_failure(ballast_program({command, file.string()}), ExitCode::failure, {file.string()});
    check_failure(ballast_program({"compare", file.string(), "--solvers", "pgs", "--output",
                                   (folder.path() / "out").string()}),
                  ExitCode::failure, {file.string()});
  }
  std::filesystem::create_directory(folder.path() / "folder.hdf5");
  check_failure(ballast_program({"check", (folder.path() / "folder.hdf5").string()}),
                ExitCode::failure, {"folder.hdf5"});
}

TEST_CASE("an unreadable problem is a row with its reason, the others go on, the exit code is 1") {
  const TemporaryFolder folder;
  const std::string first = folder.write("first.dat", dense_problem("1", "-1", "0.5")).string();
  const std::string broken = folder.write("broken.dat", "no problem at all").string();
  const std::string last = folder.write("last.dat", dense_problem("2", "-1", "0.5")).string();
  const std::string missing = (folder.path() / "missing.hdf5").string();
  const std::string out = (folder.path() / "out").string();
  const std::vector<std::vector<std::string>> calls = {
      {"solve", first, broken, missing, last},
      {"solve", first, broken, missing, last, "--json"},
      {"compare", first, broken, missing, last, "--solvers", "pgs", "--output", out}};
  for (const std::vector<std::string>& call : calls) {
    const ProgramResult result = ballast_program(call);
    INFO(result.output);
    check_failure(result, ExitCode::failure, {broken, missing, "2 of 4"});
    for (const char* part : {"first.dat", "broken.dat", "missing.hdf5", "last.dat", "unreadable"})
      CHECK_THAT(result.output, Catch::Contains(part));
  }
  CHECK_THAT(bytes_of(out + "/results.csv"),
             Catch::Contains("unreadable") && Catch::Contains("last.dat"));
  CHECK_THAT(bytes_of(out + "/compare.html"), Catch::Contains("What must not happen"));
}

TEST_CASE("a problem that the solver cannot take is a row with its reason") {
  if (!find_solver("nlopt_slsqp").make) return;  // built without NLopt, the backend with a limit
  const TemporaryFolder folder;
  KnownSolutionSettings large;
  large.bodies = 100;
  large.contacts = 400;
  const auto too_large = folder.path() / "large.hdf5", small = folder.path() / "small.hdf5";
  write_problem(too_large, make_known_solution(large).problem);
  write_problem(small, make_known_solution({}).problem);
  const ProgramResult result =
      ballast_program({"solve", too_large.string(), small.string(), "--solver", "nlopt_slsqp"});
  CHECK(result.status == static_cast<int>(ExitCode::failure));
  CHECK_THAT(result.output, Catch::Contains("unsupported: ") && Catch::Contains("small.hdf5"));
}

TEST_CASE("a problem without a solution is said to have none, whatever the backend") {
  const TemporaryFolder folder;
  // q_N = -1 m/s between two bodies that never move.
  const auto immovable =
      folder.write("immovable.dat", "3\n1\n0 3 3\n3 3\n0 0 0 0 0 0 0 0 0\n-1 0 0\n0.5\n");
  for (const SolverEntry& entry : solver_list()) {
    if (!entry.make) continue;
    const ProgramResult result = ballast_program(
        {"solve", immovable.string(), "--solver", entry.name, "--max-seconds", "5"});
    INFO(entry.name << ": " << result.output);
    CHECK(result.status == 1);
    CHECK(result.output.find(" solved") == std::string::npos);
    if (result.output.find("unsupported") == std::string::npos)
      CHECK_THAT(result.errors,
                 Catch::Contains("there is no solution: contact 0 sinks in at 1 m/s"));
  }
}

TEST_CASE("scales that overflow are one line") {
  const TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::vector<std::string>>> wrongs = {
      {dense_problem("1e200", "-1", "0.5"), {"delassus.w(0, 0)", "is beyond 1e+30"}},
      {dense_problem("1", "-1e308", "0.5"), {"delassus.q[0]", "is beyond 1e+30"}},
      {dense_problem("1", "-1", "1e9"), {"friction[0]", "is above 10000"}}};
  for (const auto& [text, named] : wrongs)
    check_failure(ballast_program({"solve", folder.write("scale.dat", text).string()}),
                  ExitCode::failure, named);
}

TEST_CASE("a solver that stops short is exit code 1, by the clock 3") {
  const TemporaryFolder folder;
  KnownSolutionSettings settings;
  settings.bodies = 200;
  settings.contacts = 600;
  settings.mass_ratio = 1e4;
  const auto file = folder.path() / "hard.hdf5";
  write_problem(file, make_known_solution(settings).problem);
  const auto solve = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"solve", file.string(), "--tolerance", "0"});
    return ballast_program(more);
  };
  check_failure(solve({"--max-iterations", "3"}), ExitCode::failure,
                {"hard.hdf5", "iteration_limit"});
  check_failure(solve({"--max-iterations", "1000000000", "--max-seconds", "0.05"}),
                ExitCode::time_limit, {"hard.hdf5", "time_limit"});
  const ProgramResult json = solve({"--max-iterations", "3", "--json"});
  CHECK_THAT(json.output, Catch::StartsWith("[") && Catch::Contains("\"natural_map_rms\": "));
}

TEST_CASE("a broken checkpoint is exit code 1") {
  const TemporaryFolder folder;
  const auto sound = folder.path() / "sound.bin";
  Checkpoint checkpoint;
  checkpoint.phase = "drive";
  checkpoint.state.pose.resize(3);
  checkpoint.state.velocity.assign(3, Vec3::Zero());
  checkpoint.state.spin.assign(3, Vec3::Zero());
  write_checkpoint(sound, checkpoint);
  const ProgramResult described = ballast_program({"check", sound.string()});
  CHECK(described.status == 0);
  CHECK_THAT(described.output, Catch::Contains("phase drive") && Catch::Contains("3 bodies"));

  const std::string bytes = bytes_of(sound);
  for (const std::string& text : {std::string(), bytes.substr(0, bytes.size() - 1), bytes + "x"})
    check_failure(ballast_program({"check", folder.write("wrong.bin", text).string()}),
                  ExitCode::failure, {"wrong.bin"});
  check_failure(ballast_program({"check", (folder.path() / "none.bin").string()}),
                ExitCode::failure, {"none.bin"});
}

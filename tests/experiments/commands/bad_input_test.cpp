// Mistakes of a user, through the program itself: it names the mistake in one line, and its exit
// code tells the kind of mistake.

#include <sstream>

#include "experiments/commands/command.hpp"
#include "solvers/solver_list.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

const std::string wall = "[[wall]]\nnormal = [0, 0, 1]\n";
const std::string body = "[[body]]\nshape = \"box\"\nsize = [1, 1, 1]\n";

/// Ten steps of one box on a floor: a run of milliseconds.
const std::string tiny_scene = "[scene]\nname = \"tiny\"\nstep = 1e-3\nduration = 0.01\n" + wall +
                               body + "mass = 1\nposition = [0, 0, 0.5]\n";

}  // namespace

TEST_CASE("a wrong command line is exit code 2") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("tiny.toml", tiny_scene).string();
  const std::string elsewhere = folder.write("notes.txt", "no scene").string();
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrongs = {
      {{}, "subcommand"},
      {{"simulate"}, "simulate"},
      {{"rnu", "incline"}, "no command 'rnu', did you mean \"run\"?"},
      {{"bench", "stp"}, "did you mean \"step\"?"},
      {{"run", "incline", "--ouput=x"}, "run: no option --ouput, did you mean \"--output\"?"},
      {{"solve", "p.hdf5", "--solver", "prox_neton"}, "did you mean \"prox_newton\"?"},
      {{"compare", "diff", "a", "b", "--lest", "2"}, "--lest, did you mean \"--least\""},
      {{"compare", "known:", "--solver", "pgs"}, "--solver, did you mean"},
      {{"--fast"}, "--fast"},
      {{"run"}, "scene"},
      {{"run", scene, "--fast"}, "--fast"},
      {{"run", scene, "more"}, "more"},
      {{"run", scene, "--set"}, "--set"},
      {{"run", scene, "--overwrite", "--continue"}, "--continue"},
      {{"run", scene, "--max-seconds", "0"}, "--max-seconds"},
      {{"run", scene, "--max-seconds", "nan"}, "--max-seconds"},
      {{"run", scene, "--max-seconds", "soon"}, "soon"},
      {{"solve"}, "files"},
      {{"bench", "step", "incline", "--steps", "1.5"},
       "--steps = 1.5 is no whole number that fits"},
      {{"solve", "p.hdf5", "--solver", "oracle"}, "oracle"},
      {{"solve", "p.hdf5", "--tolerance", "-1"}, "--tolerance"},
      {{"solve", "p.hdf5", "--tolerance", "inf"}, "--tolerance"},
      {{"solve", "p.hdf5", "--tolerance", "small"}, "small"},
      {{"solve", "p.hdf5", "--max-iterations", "0"}, "--max-iterations"},
      {{"solve", "p.hdf5", "--max-iterations", "1.5"}, "1.5"},
      {{"solve", "p.hdf5", "--max-seconds", "-2"}, "--max-seconds"},
      {{"compare"}, "expected cases, or --live"},
      {{"bench"}, "subcommand"},
      {{"bench", "step", "--steps", "0"}, "--steps"},
      {{"bench", "step", "--threads", "1,x"}, "--threads"},
      {{"bench", "scaling", "--grains", "1e3"}, "--grains"},
      {{"compare", "--live", scene, "--iterations", "20,0"}, "--iterations"},
      {{"bench", "kernels", "--min-time", "0"}, "--min-time"},
      {{"bench", "diff", "a.json"}, "B"},
      {{"compare", "p.hdf5", "--live", scene}, "--live SCENE: not with cases"},
      {{"compare", "p.hdf5", "--set", "grains.seed=2"}, "--set requires --live"},
      {{"run", scene, "--output", ""}, "--output: '': expected a name"},
      {{"plan", "p.toml", "--only", ""}, "--only: ''"},
      {{"run", scene, "--output=", "--quiet"}, "'--quiet': expected a name"},
      {{"compare", "--live", scene, "--duration", "0"}, "--duration"},
      {{"compare", "p.hdf5", "--solvers", "pgs,oracle"}, "oracle"},
      {{"compare", "p.hdf5", "--solvers", "pgs,"}, "--solvers"},
      {{"compare", "p.hdf5", "--tolerances", "1e-4,0"}, "--tolerances"},
      {{"compare", "p.hdf5", "--tolerances", ""}, "--tolerances"},
      {{"compare", "p.hdf5", "--tolerances", "none"}, "--iterations COUNT"},
      {{"compare", "--solvers", "pgs", "merge", "q"}, "a word of 'compare', not of 'merge'"},
      {{"compare", "p.hdf5", "merge", "q"}, "cases"},
      {{"compare", "--live", scene, "--repeats", "2"}, "--repeats"},
      {{"compare", "p.hdf5", "--starts", "hot"}, "'hot' is no start"},
      {{"compare", "p.hdf5", "--measure", "feeling"}, "feeling"},
      {{"compare", "p.hdf5", "--repeats", "0"}, "--repeats"},
      {{"compare", "p.hdf5", "--max-seconds", "-1"}, "--max-seconds"},
      {{"compare", "p.hdf5", "--memory", "-1"}, "--memory"},
      {{"run", scene, "--capture", "often"}, "--capture"},
      {{"check"}, "files"},
      {{"check", elsewhere}, "notes.txt: unknown kind of file"},
      {{"check", "mesh.obj", "--scale", "0"}, "--scale"},
      {{"export", folder.path().string()}, "--output"},
      {{"export", folder.path().string(), "--output", "a", "--time", "noon"}, "noon"},
      {{"export", folder.path().string(), "--output", "a", "--time", "1", "--all"}, "--all"},
      {{"scenes", "incline", "cradle"}, "cradle"},
      {{"scenes", "--resolved"}, "name"},
      {{"solvers", "2"}, "2"},
  };
  for (const auto& [arguments, named] : wrongs) {
    INFO(Catch::StringMaker<std::vector<std::string>>::convert(arguments));
    check_failure(ballast_program(arguments), ExitCode::usage, {named});
  }
}

TEST_CASE("a bad scene is exit code 1 and names file, line, key and value") {
  struct Wrong {
    std::string text;
    std::vector<std::string> named;
  };
  const std::vector<Wrong> wrongs = {
      {"[scene\n" + wall, {":1:", "not valid TOML"}},
      {"", {"nothing in it"}},
      {wall + "frction = 0.4\n", {":3:", "wall.0.frction = 0.4", "friction"}},
      {wall + "friction = \"rough\"\n", {":3:", "wall.0.friction = \"rough\"", "not a number"}},
      {wall + "friction = -0.4\n", {":3:", "wall.0.friction = -0.4", "from 0 to 1e4"}},
      {wall + "friction = nan\n", {":3:", "wall.0.friction = nan"}},
      {wall + "offset = inf\n", {"wall.0.offset = inf", "finite"}},
      {wall + "motion = \"driven\"\nload = { f_max = 1, frequency = 1 }\n",
       {"wall.0.mass is missing"}},
      {wall + body, {"body.0.density is missing"}},
      {wall + body + "mass = 0\n", {"body.0.mass = 0", "> 0 [kg]"}},
      {wall + "[[body]]\nshape = \"box\"\nsize = [1, 1, -1]\nmass = 1\n",
       {"body.0.size = [1, 1, -1]", "> 0"}},
      {wall + "[[body]]\nshape = \"mesh\"\nfile = \"none.stl\"\nmass = 1\n",
       {"body.0.file = \"none.stl\"", "none.stl"}},
      {wall + body + "mass = 1\nname = \"wall_0\"\n", {"body.0.name = \"wall_0\"", "twice"}},
      {wall + "[scene]\nstep = 0\n", {"scene.step = 0", "> 0 [s]"}},
      {wall + "[contact]\nrestitution = 2\n", {"contact.restitution = 2"}},
      {wall + "[grains]\ncount = 5\n", {"wall", "[grains]"}},
      {"[grains]\ncount = -5\n[box]\nlength = 1\nwidth = 1\n", {"grains.count = -5", "from 1"}},
      {"[grains]\ncount = 5\nmeshes = [\"none.obj\"]\n[box]\nlength = 1\nwidth = 1\n",
       {"grains.meshes", "none.obj"}},
      {wall + "[solver]\nname = \"oracle\"\n", {"scene.toml: solver.name = \"oracle\"", "pgs"}},
  };
  const TemporaryFolder folder;
  for (const Wrong& wrong : wrongs) {
    INFO(wrong.text);
    const std::string file = folder.write("scene.toml", wrong.text).string();
    const std::string output = (folder.path() / "run").string();
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"check", file}, {"run", file, "--output", output}})
      check_failure(ballast_program(arguments), ExitCode::failure, wrong.named);
    CHECK_FALSE(std::filesystem::exists(output));  // a bad scene begins nothing
  }
}

TEST_CASE("a bad override or an unknown scene is exit code 1") {
  const TemporaryFolder folder;
  const std::string output = (folder.path() / "run").string();
  const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> wrongs = {
      {{"no_such_scene"}, {"no_such_scene", "vibrated_box"}},
      {{"inclin"}, {"did you mean \"incline\"?"}},
      {{"no/such/scene.toml"}, {"no/such/scene.toml"}},
      {{folder.path().string()}, {folder.path().string()}},
      {{"incline", "--set", "scene.step"},
       {"incline.toml (--set)", "scene.step", "dotted.key=value"}},
      {{"incline", "--set", "scene.stp=1e-3"},
       {"incline.toml (--set)", "scene.stp = 0.001", "\"step\""}},
      {{"incline", "--set", "scene.step=-1"},
       {"incline.toml (--set)", "scene.step = -1", "> 0 [s]"}},
      {{"incline", "--set", "body.7.mass=1"}, {"incline.toml (--set)", "body.7.mass=1", "below 1"}},
      {{"incline", "--set", "solver.name=oracle"}, {"oracle", "pgs"}},
      {{"vibrated_box", "--set", "drive.frequency=0"},
       {"vibrated_box.toml (--set)", "drive.frequency = 0", "> 0 [Hz]"}},
  };
  for (auto [arguments, named] : wrongs) {
    INFO(Catch::StringMaker<std::vector<std::string>>::convert(arguments));
    arguments.insert(arguments.begin(), "run");
    arguments.insert(arguments.end(), {"--output", output});
    check_failure(ballast_program(arguments), ExitCode::failure, named);
  }
  check_failure(ballast_program({"scenes", "no_such_scene"}), ExitCode::failure,
                {"no_such_scene", "vibrated_box"});
}

TEST_CASE("a name of no solver is told by all that read a scene to run it, before they do") {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "out").string(),
                    plan = folder.write("p.toml",
                                        "scene = \"vibrated_box_small\"\n[[run]]\n"
                                        "name = \"one\"\nset = [\"deposit.solver=foo\"]\n");
  const std::string box = "vibrated_box_small", set = "deposit.solver=foo";
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"check", box, "--set", set},
        {"plan", plan, "--dry-run"},
        {"compare", "--live", box, "--set", set, "--output", out}})
    check_failure(ballast_program(words), ExitCode::failure,
                  {words[0] == "plan" ? "p.toml: run one: " : "",
                   "vibrated_box_small.toml: deposit.solver = \"foo\": no solver", "pgs"});
  CHECK_FALSE(std::filesystem::exists(out));
}

TEST_CASE("the paper of no run and no row is an error, and nothing is written") {
  const TemporaryFolder folder;
  const std::string results = (folder.path() / "nothere").string();
  for (const char* target : {"report", "article", "archive"})
    check_failure(ballast_program({"paper", target, "--results", results}), ExitCode::failure,
                  {results, "no finished run", "--rows"});
  CHECK_FALSE(std::filesystem::exists(results));
}

TEST_CASE("a folder that can't take the run is exit code 1") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("tiny.toml", tiny_scene).string();
  const std::string in_the_way = folder.write("file", "in the way").string();
  const std::string output = (folder.path() / "run").string();
  const auto run = [&](const std::string& to, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"run", scene, "--no-report", "--output", to});
    return ballast_program(more);
  };
  const auto fails = [](const ProgramResult& result, const std::vector<std::string>& named) {
    check_failure(result, ExitCode::failure, named);
  };
  fails(run(in_the_way + "/below"), {in_the_way});
  fails(run("/proc/ballast"), {"/proc/ballast"});
  REQUIRE(run(output).status == 0);
  fails(run(output), {output, "--overwrite"});
  fails(run(output, {"--continue", "--set", "body.0.mass=2"}), {output, "other settings"});
  CHECK(run(output, {"--overwrite"}).status == 0);

  // Cuts off half of the checkpoint.
  const std::string checkpoint = output + "/checkpoint.bin";
  std::filesystem::resize_file(checkpoint, std::filesystem::file_size(checkpoint) / 2);
  std::filesystem::remove(output + "/steps.csv");  // without it the run is unfinished
  fails(run(output, {"--continue"}), {checkpoint, "truncated"});
  fails(ballast_program({"check", checkpoint}), {checkpoint, "truncated"});
  fails(ballast_program({"export", output, "--output", output + "/a.obj"}),
        {checkpoint, "truncated"});
}

TEST_CASE("a disk that is full is exit code 1") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("tiny.toml", tiny_scene).string();
  check_failure(ballast_in_shell("\"$@\" > /dev/full", {"scenes"}), ExitCode::failure,
                {"standard output"});
  // Limits files to one block of 512 bytes, which fails a write as a full disk does.
  const std::string output = (folder.path() / "run").string();
  const ProgramResult full = ballast_in_shell("trap '' XFSZ; ulimit -f 1; exec \"$@\"",
                                              {"run", scene, "--output", output, "--no-report"});
  check_failure(full, ExitCode::failure, {output, "File too large"});
}

TEST_CASE("a solver built without its library is exit code 4") {
  std::ostringstream err;
  CHECK(perform([]() -> ExitCode { throw MissingSolver("x\n  install libx"); }, err) ==
        ExitCode::backend_missing);
  CHECK(err.str() == "ballast: x   install libx\n");
  for (const SolverEntry& entry : solver_list()) {
    if (entry.make) continue;
    INFO(entry.name);
    check_failure(ballast_program({"solve", "p.hdf5", "--solver", entry.name}),
                  ExitCode::backend_missing, {entry.name});
    check_failure(
        ballast_program({"check", "incline", "--set", std::string("solver.name=") + entry.name}),
        ExitCode::backend_missing, {entry.name});
    for (const char* command : {"check", "bench scaling"}) {
      std::vector<std::string> words = split(command, ' ');
      words.insert(words.end(),
                   {"vibrated_box_small", "--set", std::string("deposit.solver=") + entry.name});
      check_failure(ballast_program(words), ExitCode::backend_missing, {entry.name});
    }
  }
}

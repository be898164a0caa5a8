#include "platform/program.hpp"

#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "tests/catch.hpp"
#include "tests/support/environment_guard.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// True if no child is left, running or dead.
bool no_children() { return waitpid(-1, nullptr, WNOHANG) == -1; }

[[noreturn]] void wait_for_ever() {
  for (;;) pause();
}

int status_of(ChildProcess& child) {
  REQUIRE(child.ends_within(30.0));
  return child.status();
}

/// Whether the process whose number is in the file runs. Waits for the file.
bool runs(const fs::path& file) {
  pid_t process = 0;
  for (const Stopwatch watch; process == 0 && watch.seconds() < 10.0; usleep(1000))
    std::ifstream(file) >> process;
  REQUIRE(process > 1);
  // It may be a child of init by then, which may reap it late.
  std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
  std::string number, name, state;
  stat >> number >> name >> state;
  return stat && state != "Z";
}

/// Whether the process ends within ten seconds.
bool ends(const fs::path& file) {
  for (const Stopwatch watch; watch.seconds() < 10.0; usleep(1000))
    if (!runs(file)) return true;
  return false;
}

}  // namespace

TEST_CASE("an answer comes back whole, whatever its size") {
  for (const std::size_t size : {0u, 1u, 1000u, 8000000u}) {  // the last does not fit into any pipe
    std::string expected(size, '\0');
    for (std::size_t i = 0; i < size; ++i) expected[i] = static_cast<char>(i * 7 % 251);
    const ChildResult result = run_in_child(60.0, [&] { return expected; });
    CHECK(result.end == ChildEnd::complete);
    CHECK((result.answer == expected));
    CHECK(no_children());
  }
}

TEST_CASE("a child that ends without an answer has crashed, even with exit code 0") {
  const auto end_of = [](void (*work)()) {
    const ChildResult result = run_in_child(60.0, [&] {
      work();
      return std::string("lost");
    });
    CHECK(result.answer.empty());
    CHECK(no_children());
    return result.end;
  };
  CHECK(end_of([] { _exit(0); }) == ChildEnd::crashed);
  CHECK(end_of([] { raise(SIGKILL); }) == ChildEnd::crashed);
}

TEST_CASE("a child that throws has failed, and its words come back") {
  const ChildResult result =
      run_in_child(60.0, []() -> std::string { throw std::runtime_error("no way on"); });
  CHECK(result.end == ChildEnd::failed);
  CHECK(result.answer == "no way on");
  CHECK(no_children());
}

TEST_CASE("a child that takes too long is killed") {
  const Stopwatch watch;
  for (const double seconds : {0.1, 0.0}) {
    const ChildResult child = run_in_child(seconds, []() -> std::string { wait_for_ever(); });
    CHECK(child.end == ChildEnd::out_of_time);
    CHECK(no_children());
  }
  CHECK(watch.seconds() < 5.0);
}

TEST_CASE("a child that is no longer wanted is killed, and one that is wanted answers") {
  const Stopwatch watch;
  int asked = 0;
  const ChildResult child = run_in_child(
      1e9, []() -> std::string { wait_for_ever(); }, [&] { return ++asked > 2; });
  CHECK(child.end == ChildEnd::out_of_time);
  CHECK(asked == 3);
  CHECK(no_children());
  CHECK(watch.seconds() < 5.0);
  const auto slow = [] {
    usleep(120000);
    return std::string("slow");
  };
  CHECK(run_in_child(60.0, slow, [] { return false; }).answer == "slow");
}

TEST_CASE("what the parent has is not touched, the child prints nowhere and may be lost") {
  int here = 1;
  const ChildResult result = run_in_child(60.0, [&] {
    std::puts("program_test: this line must not be seen");
    std::fflush(stdout);
    return std::to_string(++here) + (is_expendable_process() ? " expendable" : "");
  });
  CHECK(result.answer == "2 expendable");
  CHECK(here == 1);
  CHECK_FALSE(is_expendable_process());
}

TEST_CASE("the status of a child is its exit code, or its signal") {
  ChildProcess five([] { _exit(5); }), returns([] {}), throws([] { throw 1; }),
      killed([] { raise(SIGTERM); });
  CHECK(status_of(five) == 5);
  CHECK(status_of(returns) == 1);
  CHECK(status_of(throws) == 1);
  CHECK(status_of(killed) == 128 + SIGTERM);
  CHECK(status_of(five) == 5);  // a second call returns the same
  CHECK(no_children());
}

TEST_CASE("a child ends with its object, and by signals as if nobody had caught them here") {
  signal(SIGTERM, SIG_IGN);
  {
    ChildProcess left(wait_for_ever), asked(wait_for_ever);
    CHECK_FALSE(left.has_ended());
    usleep(20000);
    asked.send(SIGTERM);
    CHECK(status_of(asked) == 128 + SIGTERM);
  }
  signal(SIGTERM, SIG_DFL);
  CHECK(no_children());
}

TEST_CASE("a signal that comes while a child starts is not lost") {
  const InterruptGuard guard;  // at first the child has its handlers too
  for (int k = 0; k < 100; ++k) {
    ChildProcess asked(wait_for_ever);
    asked.send(SIGTERM);
    REQUIRE(status_of(asked) == 128 + SIGTERM);
  }
  CHECK_FALSE(InterruptGuard::requested());
}

TEST_CASE("a child dies with the process that made it") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "grandchild";
  {
    ChildProcess parent([&] {
      ChildProcess grandchild([&] {
        std::ofstream(file.string() + ".new") << getpid() << '\n';
        fs::rename(file.string() + ".new", file);
        wait_for_ever();
      });
      wait_for_ever();
    });
    CHECK(runs(file));
  }
  CHECK(ends(file));
}

// ---- programs whose output is read

namespace {

ProgramResult shell(const std::string& script, double seconds = 30.0) {
  return run_program("sh", {"-c", script}, seconds);
}

}  // namespace

TEST_CASE("output, errors and exit code of a program come back") {
  const ProgramResult result = shell("echo out; echo err >&2; exit 3");
  CHECK_FALSE(result.timed_out);
  CHECK_FALSE(result.succeeded());
  CHECK(result.status == 3);
  CHECK(result.output == "out\n");
  CHECK(result.errors == "err\n");
  CHECK(shell("true").succeeded());
  CHECK(shell("kill -TERM $$").status == 128 + SIGTERM);
  CHECK(run_program("printf", {"%s|%s", "a b", "$HOME"}, 30.0).output == "a b|$HOME");
}

TEST_CASE("much output on both channels does not block") {
  const ProgramResult result =
      shell("head -c 3000000 /dev/zero; head -c 3000000 /dev/zero >&2; cat; echo end");
  CHECK(result.succeeded());
  CHECK(result.output.size() == 3000004);  // the input of `cat` is empty
  CHECK(result.errors.size() == 3000000);
}

TEST_CASE("a program that is not there has failed, and says why") {
  const ProgramResult result = run_program("ballast-no-such-program", {}, 30.0);
  CHECK_FALSE(result.succeeded());
  CHECK(result.status == 127);
  CHECK(result.errors == "cannot be started: No such file or directory");
}

TEST_CASE("a program that takes too long is killed, even when it has closed its output") {
  for (const char* script : {"sleep 60", "exec >&- 2>&-; sleep 60"}) {
    CAPTURE(script);
    const Stopwatch watch;
    const ProgramResult result = shell(std::string("exec 0<&-; ") + script, 0.2);
    CHECK(result.timed_out);
    CHECK(result.status == 128 + SIGKILL);
    CHECK(watch.seconds() < 20.0);
  }
}

TEST_CASE("programs whose output is read find the C locale and nothing of gnuplot's") {
  const EnvironmentGuard library("GNUPLOT_LIB", "somewhere"), terminal("GNUTERM", "x11"),
      other("BALLAST_TEST_VARIABLE", "kept");
  CHECK(shell("echo \"$LC_ALL|$GNUPLOT_LIB|$GNUTERM|$BALLAST_TEST_VARIABLE\"").output ==
        "C|||kept\n");
}

// ---- programs beside this one

TEST_CASE("a program beside us appends to its log, also that it cannot be started") {
  const TemporaryFolder folder;
  const fs::path log = folder.write("log", "before\n"), absent = folder.path() / "absent";
  CHECK(status_of(*start_program("/bin/sh", {"-c", "echo out; echo err >&2; exit 4"}, log)) == 4);
  CHECK(read_whole_file(log) == "before\nout\nerr\n");
  CHECK_THROWS_AS(start_program("/bin/sh", {}, absent / "log"), Error);
  std::cout.flush();  // ThreadSanitizer's _exit writes the child's copy of its buffer
  CHECK(status_of(*start_program(absent, {}, log)) == 127);
  CHECK(last_line(log) == absent.string() + ": cannot be started: No such file or directory");
}

TEST_CASE("a program beside us ends when it is asked, and with its object") {
  const TemporaryFolder folder;
  const fs::path log = folder.path() / "log";
  const auto asked = start_program(
      "/bin/sh", {"-c", "trap 'exit 9' TERM; echo ready; while :; do sleep 0.01; done"}, log);
  const Stopwatch watch;
  while (read_whole_file(log).empty() && watch.seconds() < 30.0) usleep(1000);
  asked->send(SIGTERM);
  CHECK(status_of(*asked) == 9);
  start_program("/bin/sleep", {"60"}, log).reset();
  CHECK(watch.seconds() < 50.0);
  CHECK(no_children());
}

TEST_CASE("a program beside us has one thread of linear algebra, where nothing else is said") {
  const TemporaryFolder folder;
  const fs::path log = folder.path() / "log";
  const EnvironmentGuard blas("OPENBLAS_NUM_THREADS", ""), two("OMP_NUM_THREADS", "2");
  unsetenv("OPENBLAS_NUM_THREADS");
  const char* script = "echo $OPENBLAS_NUM_THREADS $OMP_NUM_THREADS $OMP_THREAD_LIMIT";
  CHECK(status_of(*start_program("/bin/sh", {"-c", script}, log)) == 0);
  CHECK(read_whole_file(log) == "1 2 1\n");
}

TEST_CASE("the last line of a log that says anything") {
  const TemporaryFolder folder;
  CHECK(last_line(folder.path() / "absent").empty());
  CHECK(last_line(folder.write("log", "one\ntwo\n \n\t\n")) == "two");
  CHECK(last_line(folder.write("log", "one\nballast: two")) == "two");
}

TEST_CASE("this program knows its file and its words") {
  CHECK(executable_path().filename() == "platform_test");
  const std::vector<std::string> words = process_arguments();
  REQUIRE_FALSE(words.empty());
  CHECK(fs::path(words[0]).filename() == "platform_test");
}

TEST_CASE("words for a shell") {
  CHECK(shell_quoted("drive.frequency=5") == "drive.frequency=5");
  CHECK(shell_quoted("a b") == "'a b'");
  CHECK(shell_quoted("it's $HOME") == "'it'\\''s $HOME'");
  CHECK(shell_line({"a", "b c", ""}) == "a 'b c' ''");
  // A shell reads the same words.
  const std::vector<std::string> words{"a b", "it's", "$HOME", "", "*", "x\ny"};
  std::string expected;
  for (const std::string& word : words) expected += word + "|";
  CHECK(shell("printf '%s|' " + shell_line(words)).output == expected);
}

// ---- programs that are not trusted

namespace {

/// The only child of a process.
pid_t child_of(pid_t process) {
  const std::string number = std::to_string(process);
  pid_t child = 0;
  std::ifstream("/proc/" + number + "/task/" + number + "/children") >> child;
  return child;
}

SupervisedProgram program(const std::string& command) {
  return SupervisedProgram("sh -c '" + command + "'", {"sh"}, {});
}

}  // namespace

TEST_CASE("A program gets its arguments, whatever is in them, and its status is told") {
  const TemporaryFolder folder;
  SupervisedProgram told("sh -c 'printf %s \"$1\" > \"$0\"; exit 7'",
                         {(folder.path() / "said").string(), "it's $HOME; \"x\""}, {});
  REQUIRE(told.wait(10.0));
  CHECK(told.status() == 7);
  CHECK(read_whole_file(folder.path() / "said") == "it's $HOME; \"x\"");
}

TEST_CASE("How a program ended is told with its last words") {
  struct Ending {
    std::string command, folder;
    int status;
    std::string last_words;
  };
  for (const auto& [command, folder, status, last_words] :
       {Ending{"sh -c 'echo first >&2; echo; echo last words >&2; echo >&2; exit 3'", "", 3,
               "last words"},
        {"sh -c 'kill -SEGV $$'", "", 128 + SIGSEGV, ""},
        {"/no/such/program", "", 127, "sh: 1: /no/such/program: not found"},
        {"true", "/no/such/folder", 127, "cannot be started: No such file or directory"}}) {
    SupervisedProgram ended(command, {}, {.folder = folder});
    REQUIRE(ended.wait(10.0));
    CHECK(ended.status() == status);
    CHECK_THAT(ended.last_words(), Catch::EndsWith(last_words));
  }
}

TEST_CASE("Lines go both ways") {
  auto echo = program("while read line; do echo \"<$line>\"; done");
  std::string line;
  for (const std::string text : {"one", "two words"}) {
    CHECK(echo.write_line(text));
    REQUIRE(echo.read_line(line, 10.0) == SupervisedProgram::Heard::line);
    CHECK(line == "<" + text + ">");
  }
  CHECK(echo.read_line(line, 0.01) == SupervisedProgram::Heard::out_of_time);
  echo.close_input();
  CHECK(echo.read_line(line, 10.0) == SupervisedProgram::Heard::end);
  CHECK_FALSE(echo.write_line("three"));
}

TEST_CASE("A program that hangs or floods is given up in time, and its memory is not ours") {
  const Stopwatch watch;
  for (const char* endless :
       {"sleep 1000", "exec <&- >&- 2>&-; sleep 1000", "exec yes", "exec yes >&2"})
    CHECK_FALSE(program(endless).wait(0.3));
  // An endless line: only its beginning is read.
  auto endless = program("yes | tr -d \"\\n\"");
  std::string line;
  CHECK(endless.read_line(line, 0.3) == SupervisedProgram::Heard::out_of_time);
  auto flood =
      program("yes | head -c 30000000; yes | head -c 30000000 >&2; echo >&2; echo end >&2");
  REQUIRE(flood.wait(60.0));
  CHECK(flood.last_words() == "end");
  CHECK(watch.seconds() < 60.0);
}

TEST_CASE("What a program forks ends with it") {
  const TemporaryFolder folder;
  const auto child = folder.path() / "child", daemon = folder.path() / "daemon";
  // One child stays in the group. The other gets a session of its own, and its parent ends.
  const std::string forks = "(sh -c \"echo \\$\\$ > " + child.string() +
                            "; exec sleep 1000\") & (setsid sh -c \"echo \\$\\$ > " +
                            daemon.string() + "; exec sleep 1000\" &) ";
  SECTION("when it ends itself") {
    auto forking = program(forks + "; while [ ! -s " + daemon.string() + " ] || [ ! -s " +
                           child.string() + " ]; do sleep 0.01; done");
    REQUIRE(forking.wait(20.0));
  }
  SECTION("when it is given up") {
    auto forking = program(forks + "; sleep 1000");
    CHECK(runs(child));
    CHECK(runs(daemon));
  }
  SECTION("when this process is killed") {
    const ChildProcess killed([&] { program(forks + "; sleep 1000").wait(1000.0); });
    CHECK(runs(child));
    CHECK(runs(daemon));
    killed.send(SIGKILL);
    CHECK(ends(child));
    CHECK(ends(daemon));
  }
  for (const bool inner : {false, true})
    DYNAMIC_SECTION("when a supervisor is killed, the inner one: " << inner) {
      auto forking = program(forks + "; sleep 1000");
      CHECK(runs(child));
      CHECK(runs(daemon));
      const pid_t outer = child_of(getpid());
      const pid_t supervisor = inner ? child_of(outer) : outer;
      REQUIRE(supervisor > 0);
      kill(supervisor, SIGKILL);
      CHECK(ends(child));
      CHECK(ends(daemon));
      REQUIRE(forking.wait(20.0));
      CHECK(forking.status() == 128 + SIGKILL);
    }
  CHECK_FALSE(runs(child));
  CHECK_FALSE(runs(daemon));
}

TEST_CASE("A program that asks for more memory than it may have does not get it") {
  SupervisedProgram greedy(
      "head -c 400000000 /dev/zero | tail -c 390000000 > /dev/null; exit ${?}; :", {},
      {.memory_MB = 100.0});
  REQUIRE(greedy.wait(60.0));
  CHECK(greedy.status() != 0);
}

#include "platform/program.hpp"

#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <fstream>
#include <iostream>
#include <thread>

#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

ProgramResult shell(const std::string& script, double seconds = 30.0) {
  return run_program("sh", {"-c", script}, seconds);
}

int status_of(BackgroundProgram& program) {
  const Stopwatch watch;
  while (!program.has_ended() && watch.seconds() < 30.0) usleep(1000);
  REQUIRE(program.has_ended());
  return program.status();
}

}  // namespace

TEST_CASE("output, errors and exit code of a program come back") {
  const ProgramResult result = shell("echo out; echo err >&2; exit 3");
  CHECK(result.was_found);
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
  CHECK(result.output.size() == 3000004);  // `cat` found its input empty
  CHECK(result.errors.size() == 3000000);
}

TEST_CASE("a program that is not there is told apart from one that fails") {
  const ProgramResult result = run_program("ballast-no-such-program", {}, 30.0);
  CHECK_FALSE(result.was_found);
  CHECK_FALSE(result.succeeded());
  CHECK(result.status == 127);
  CHECK(result.errors == "No such file or directory");
  CHECK(shell("exit 127").was_found);
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
  setenv("GNUPLOT_LIB", "somewhere", 1);
  setenv("GNUTERM", "x11", 1);
  setenv("BALLAST_TEST_VARIABLE", "kept", 1);
  const ProgramResult result =
      shell("echo \"$LC_ALL|$GNUPLOT_LIB|$GNUTERM|$BALLAST_TEST_VARIABLE\"");
  for (const char* name : {"GNUPLOT_LIB", "GNUTERM", "BALLAST_TEST_VARIABLE"}) unsetenv(name);
  CHECK(result.output == "C|||kept\n");
}

TEST_CASE("a program beside us appends to its log") {
  const TemporaryFolder folder;
  const fs::path log = folder.write("log", "before\n");
  BackgroundProgram program("/bin/sh", {"-c", "echo out; echo err >&2; exit 4"}, log);
  CHECK(status_of(program) == 4);
  CHECK(read_whole_file(log) == "before\nout\nerr\n");
  CHECK_THROWS_AS(BackgroundProgram("/bin/sh", {}, folder.path() / "absent" / "log"), Error);
}

TEST_CASE("a program beside us ends when it is asked, and with its object") {
  const TemporaryFolder folder;
  const fs::path log = folder.path() / "log";
  BackgroundProgram asked(
      "/bin/sh", {"-c", "trap 'exit 9' TERM; echo ready; while :; do sleep 0.01; done"}, log);
  const Stopwatch watch;
  while (read_whole_file(log).empty() && watch.seconds() < 30.0) usleep(1000);
  asked.stop();
  CHECK(status_of(asked) == 9);
  const Stopwatch since;
  { const BackgroundProgram left("/bin/sleep", {"60"}, log); }
  CHECK(since.seconds() < 20.0);
}

TEST_CASE("a program beside us has one thread of linear algebra, where nothing else is said") {
  const TemporaryFolder folder;
  const fs::path log = folder.path() / "log";
  const char* old = getenv("OPENBLAS_NUM_THREADS");
  const std::string kept = old ? old : "";
  unsetenv("OPENBLAS_NUM_THREADS");
  setenv("OMP_NUM_THREADS", "2", 1);
  BackgroundProgram program(
      "/bin/sh", {"-c", "echo $OPENBLAS_NUM_THREADS $OMP_NUM_THREADS $OMP_THREAD_LIMIT"}, log);
  CHECK(status_of(program) == 0);
  unsetenv("OMP_NUM_THREADS");
  if (old) setenv("OPENBLAS_NUM_THREADS", kept.c_str(), 1);
  CHECK(read_whole_file(log) == "1 2 1\n");
}

TEST_CASE("what cannot be started says so in the log") {
  const TemporaryFolder folder;
  const fs::path log = folder.path() / "log", absent = folder.path() / "absent";
  std::cout.flush();  // ThreadSanitizer's _exit writes what the child's copy of it holds
  BackgroundProgram program(absent, {}, log);
  CHECK(status_of(program) == 127);
  CHECK(last_line(log) == absent.string() + ": cannot be started: No such file or directory");
}

TEST_CASE("the last line of a log that says anything") {
  const TemporaryFolder folder;
  CHECK(last_line(folder.path() / "absent").empty());
  CHECK(last_line(folder.write("log", "one\ntwo\n \n\t\n")) == "two");
  CHECK(last_line(folder.write("log", "one\nballast: two")) == "two");
}

TEST_CASE("this program knows its file and its words") {
  CHECK(own_program().filename() == "platform_test");
  const std::vector<std::string> words = own_words();
  REQUIRE_FALSE(words.empty());
  CHECK(fs::path(words[0]).filename() == "platform_test");
}

TEST_CASE("words for a shell") {
  CHECK(shell_word("drive.frequency=5") == "drive.frequency=5");
  CHECK(shell_word("a b") == "'a b'");
  CHECK(shell_word("it's $HOME") == "'it'\\''s $HOME'");
  CHECK(shell_word("") == "''");
  CHECK(shell_line({"a", "b c", ""}) == "a 'b c' ''");
  // A shell reads them back.
  const std::vector<std::string> words{"a b", "it's", "$HOME", "", "*", "x\ny"};
  std::string expected;
  for (const std::string& word : words) expected += word + "|";
  CHECK(run_program("/bin/sh", {"-c", "printf '%s|' " + shell_line(words)}, 10.0).output ==
        expected);
}

namespace {

/// The process that wrote its number into the file runs; waits for the file.
bool runs(const std::filesystem::path& file) {
  pid_t process = 0;
  for (const Stopwatch watch; process == 0 && watch.seconds() < 10.0; usleep(1000))
    std::ifstream(file) >> process;
  REQUIRE(process > 1);
  return kill(process, 0) == 0;
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
  std::string said;
  std::getline(std::ifstream(folder.path() / "said"), said);
  CHECK(said == "it's $HOME; \"x\"");
}

TEST_CASE("How a program ended is told with its last words") {
  auto words = program("echo first >&2; echo; echo last words >&2; echo >&2; exit 3");
  REQUIRE(words.wait(10.0));
  CHECK(words.status() == 3);
  CHECK(words.last_words() == "last words");
  auto killed = program("kill -SEGV $$");
  REQUIRE(killed.wait(10.0));
  CHECK(killed.status() == 128 + SIGSEGV);
  SupervisedProgram missing("/no/such/program", {}, {});
  REQUIRE(missing.wait(10.0));
  CHECK(missing.status() == 127);
  SupervisedProgram nowhere("true", {}, {.folder = "/no/such/folder"});
  REQUIRE(nowhere.wait(10.0));
  CHECK(nowhere.status() == 127);
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
  CHECK_FALSE(program("sleep 1000").wait(0.05));
  CHECK_FALSE(program("exec yes").wait(0.3));
  CHECK_FALSE(program("exec yes >&2").wait(0.3));
  // One line without end: its beginning is what is heard.
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
  // One in its group, and one that left it for a session of its own while its parent ended.
  const std::string forks = "(sh -c \"echo \\$\\$ > " + child.string() +
                            "; exec sleep 1000\") & (setsid sh -c \"echo \\$\\$ > " +
                            daemon.string() + "; exec sleep 1000\" &) ";
  SECTION("when it ends itself") {
    auto forking = program(forks + "; while [ ! -s " + daemon.string() + " ] || [ ! -s " +
                           child.string() + " ]; do sleep 0.01; done");
    REQUIRE(forking.wait(20.0));
    CHECK_FALSE(runs(child));
    CHECK_FALSE(runs(daemon));
  }
  SECTION("when it is given up") {
    {
      auto forking = program(forks + "; sleep 1000");
      CHECK(runs(child));
      CHECK(runs(daemon));
    }
    CHECK_FALSE(runs(child));
    CHECK_FALSE(runs(daemon));
  }
}

TEST_CASE("What a program started ends when this process is killed") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "process";
  {
    const ChildProcess killed([&] {
      auto started =
          program("setsid sh -c \"echo \\$\\$ > " + file.string() + "; exec sleep 1000\"");
      started.wait(1000.0);
    });
    CHECK(runs(file));
    killed.send(SIGKILL);
  }
  for (const Stopwatch watch; runs(file) && watch.seconds() < 10.0;) usleep(1000);
  CHECK_FALSE(runs(file));
}

TEST_CASE("A program that asks for more memory than it may have does not get it") {
  SupervisedProgram greedy(
      "head -c 400000000 /dev/zero | tail -c 390000000 > /dev/null; exit ${?}; :", {},
      {.memory_MB = 100.0});
  REQUIRE(greedy.wait(60.0));
  CHECK(greedy.status() != 0);
}

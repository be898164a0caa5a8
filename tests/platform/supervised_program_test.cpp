// Whatever a foreign program does: the wait for it ends, and nothing of it is left.

#include "platform/supervised_program.hpp"

#include <signal.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "platform/clock.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

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

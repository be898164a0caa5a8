#include "platform/standard_streams.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

/// The exit code of a process that does `work`; 128 when a signal ended it.
template <typename Work>
int code_of(const Work& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

}  // namespace

TEST_CASE("with closed standard streams, no file gets their number") {
  const auto first_number = [](std::initializer_list<int> closed) {
    return code_of([&] {
      for (const int stream : closed) close(stream);
      prepare_standard_streams();
      const int opened = open("/dev/null", O_RDONLY);
      // What is printed goes nowhere, without an error.
      return write(STDOUT_FILENO, "x", 1) == 1 && write(STDERR_FILENO, "x", 1) == 1 ? opened : 99;
    });
  };
  CHECK(first_number({1}) > 2);
  CHECK(first_number({2}) > 2);
  CHECK(first_number({0, 1, 2}) > 2);
  CHECK(first_number({0, 2}) > 2);
}

TEST_CASE("a file over the limit is an error, not a death") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "file").string();
  CHECK(code_of([&] {
          prepare_standard_streams();
          const rlimit small{4, 4};
          setrlimit(RLIMIT_FSIZE, &small);
          const int opened = open(file.c_str(), O_WRONLY | O_CREAT, 0600);
          if (write(opened, "12345678", 8) != 4) return 2;  // as much as fits
          return write(opened, "5678", 4) < 0 && errno == EFBIG ? 0 : 1;
        }) == 0);
}

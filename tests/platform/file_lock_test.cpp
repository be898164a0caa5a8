#include "platform/file_lock.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

bool at_once(double) { return false; }

/// A process that holds the lock until it is killed.
class Holder {
 public:
  explicit Holder(const fs::path& file) {
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    child_ = fork();
    if (child_ == 0) {
      const FileLock lock(file, at_once);
      const char held = lock.is_held() ? 'y' : 'n';
      if (write(ends[1], &held, 1) != 1) _exit(1);
      for (;;) pause();
    }
    close(ends[1]);
    char held = 'n';
    REQUIRE(read(ends[0], &held, 1) == 1);
    REQUIRE(held == 'y');
    close(ends[0]);
  }
  ~Holder() { die(); }
  void die() {
    if (child_ < 0) return;
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    child_ = -1;
  }
  pid_t process() const { return child_; }

 private:
  pid_t child_ = -1;
};

}  // namespace

TEST_CASE("a free lock is had at once, and its file goes with it") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "lock";
  for (int k = 0; k < 2; ++k) {
    const FileLock lock(file, at_once);
    CHECK(lock.is_held());
    CHECK(fs::exists(file));
  }
  CHECK_FALSE(fs::exists(file));
}

TEST_CASE("one holder at a time, who is named to the others") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "lock";
  const Holder other(file);
  const FileLock lock(file, at_once);
  CHECK_FALSE(lock.is_held());
  CHECK(lock.holder().starts_with("process " + std::to_string(other.process()) + " on "));
}

TEST_CASE("a lock that was not had leaves the holder's file alone") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "lock";
  const FileLock mine(file, at_once);
  { const FileLock second(file, at_once); }
  CHECK(fs::exists(file));
  CHECK_FALSE(FileLock(file, at_once).is_held());
}

TEST_CASE("the lock of a killed process is free, although its file is still there") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "lock";
  Holder other(file);
  other.die();
  CHECK(fs::exists(file));
  CHECK(FileLock(file, at_once).is_held());
}

TEST_CASE("patience is asked with the seconds waited, and waiting ends when the holder goes") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "lock";
  Holder other(file);
  std::vector<double> waited;
  const FileLock lock(file, [&](double seconds) {
    waited.push_back(seconds);
    if (waited.size() == 3) other.die();
    return waited.size() < 100;
  });
  CHECK(lock.is_held());
  REQUIRE(waited.size() >= 3);
  CHECK(waited[0] == 0.0);
  CHECK(waited[2] == Approx(0.1));
  CHECK(briefly(2.9));
  CHECK_FALSE(briefly(3.0));
}

TEST_CASE("a lock in a folder that is not there is an error with its name") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "absent" / "lock";
  CHECK_THROWS_WITH(FileLock(file, at_once),
                    file.string() + ": cannot make the lock: No such file or directory");
}

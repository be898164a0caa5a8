#include "platform/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "platform/clock.hpp"
#include "platform/program.hpp"
#include "tests/catch.hpp"
#include "tests/support/complaint.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("a file has its new content after commit(), and its old one until then") {
  const TemporaryFolder folder;
  const fs::path path = folder.write("a.txt", "old");
  {
    AtomicFile file(path);
    file.write("new ");
    file.write("7 words");
    CHECK(read_whole_file(path) == "old");
    file.commit();
    CHECK(read_whole_file(path) == "new 7 words");
  }
  CHECK(read_whole_file(path) == "new 7 words");
  CHECK_FALSE(fs::exists(folder.path() / "a.txt.tmp"));
}

TEST_CASE("without commit() nothing happens to the target") {
  const TemporaryFolder folder;
  const fs::path path = folder.write("a.txt", "old");
  { AtomicFile(path).write("new"); }
  CHECK(read_whole_file(path) == "old");
  { AtomicFile(folder.path() / "b.txt").write("new"); }
  CHECK_FALSE(fs::exists(folder.path() / "b.txt"));
  CHECK_FALSE(fs::exists(folder.path() / "a.txt.tmp"));
  CHECK_FALSE(fs::exists(folder.path() / "b.txt.tmp"));
}

TEST_CASE("whole files come back byte by byte") {
  const TemporaryFolder folder;
  std::string bytes;
  for (int k = 0; k < 300000; ++k) bytes += static_cast<char>(k % 256);
  for (const std::string& text : {std::string(), bytes}) {
    write_whole_file(folder.path() / "a", text);
    CHECK((read_whole_file(folder.path() / "a") == text));
  }
}

TEST_CASE("what goes wrong is one line that begins with the file") {
  const TemporaryFolder folder;
  const fs::path absent = folder.path() / "absent" / "a.txt", pipe = folder.path() / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  for (const auto& [file, said] : {std::pair(absent, "open: No such file or directory"),
                                   {folder.path(), "read: Is a directory"},
                                   // Reading it might never end.
                                   {pipe, "read: it is a pipe, not a regular file"},
                                   {"/dev/zero", "read: it is a device, not a regular file"}})
    CHECK(complaint_about(file, [&] { read_whole_file(file); }) == std::string("cannot ") + said);
  for (const auto& [file, said] : {std::pair(absent, "No such file or directory"),
                                   {folder.path(), "Is a directory"},
                                   {"/dev/full", "No space left on device"}})
    CHECK(complaint_about(file, [&] { write_whole_file(file, "x"); }) ==
          std::string("cannot write: ") + said);
  errno = ENOSPC;
  CHECK(complaint([&] { throw_file_error("f", "stand"); }) ==
        "f: cannot stand: No space left on device");
}

TEST_CASE("a disk that is full is noticed when the file is made safe") {
  std::FILE* full = std::fopen("/dev/full", "wb");
  REQUIRE(full);
  std::fputs("x", full);
  CHECK(complaint([&] { sync_to_disk(full, "a.txt"); }) ==
        "a.txt: cannot write: No space left on device");
  std::fclose(full);
}

TEST_CASE("folders are made with their parents") {
  const TemporaryFolder folder;
  const fs::path deep = folder.path() / "a" / "b" / "c";
  create_folder(deep);
  create_folder(deep);  // it may exist already
  CHECK(fs::is_directory(deep));
  const fs::path file = folder.write("file", "");
  for (const fs::path& refused : {file, file / "x"})
    CHECK_THAT(complaint_about(refused, [&] { create_folder(refused); }),
               Catch::StartsWith("cannot make the folder"));
}

TEST_CASE("output through symbolic links writes what they point to, be it not there yet") {
  const TemporaryFolder folder;
  const fs::path real = folder.write("real.txt", "old"), link = folder.path() / "link",
                 second = folder.path() / "second", dangling = folder.path() / "dangling";
  fs::create_symlink("real.txt", link);
  fs::create_symlink(link, second);
  fs::create_symlink("new.txt", dangling);
  write_whole_file(second, "written");
  CHECK(fs::is_symlink(second));
  CHECK(fs::is_symlink(link));
  CHECK(read_whole_file(real) == "written");
  write_whole_file(dangling, "made");
  CHECK(fs::is_symlink(dangling));
  CHECK(read_whole_file(folder.path() / "new.txt") == "made");
  const fs::path ring = folder.path() / "ring";
  fs::create_symlink("ring", ring);
  CHECK_THAT(complaint_about(ring, [&] { write_whole_file(ring, "x"); }),
             Catch::StartsWith("cannot write"));
}

TEST_CASE("a pipe is written as it is, and stays one") {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::string got;
  std::thread reader([&] {
    const int end = open(pipe.c_str(), O_RDONLY);
    char bytes[64];
    ssize_t count;
    while ((count = read(end, bytes, sizeof bytes)) > 0)
      got.append(bytes, static_cast<size_t>(count));
    close(end);
  });
  write_whole_file(pipe, "through");
  reader.join();
  CHECK(got == "through");
  CHECK(fs::is_fifo(pipe));
  CHECK_FALSE(fs::exists(pipe.string() + ".tmp"));
}

TEST_CASE("an open descriptor's file is written in place, not replaced") {
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", "old"), name = folder.path() / "stdout";
  const int descriptor = open(file.c_str(), O_RDWR);
  // A link into /proc, as /dev/stdout is.
  fs::create_symlink("/proc/self/fd/" + std::to_string(descriptor), name);
  write_whole_file(name, "new");
  char bytes[8] = {};
  CHECK(pread(descriptor, bytes, sizeof bytes, 0) == 3);
  CHECK(std::string(bytes) == "new");
  CHECK(fs::is_symlink(name));
  close(descriptor);
}

TEST_CASE("who may read a file stays as it was") {
  const TemporaryFolder folder;
  const fs::path file = folder.write("secret", "old");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  write_whole_file(file, "new");
  CHECK(fs::status(file).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
}

TEST_CASE("results go into a folder that is new, empty, or has such results") {
  const TemporaryFolder folder;
  const fs::path results = folder.path() / "results";
  const auto said = [&] {
    return complaint_about(results, [&] {
      require_own_folder(results, {"rows", {"a", "ours"}, "runs"});
    });
  };
  CHECK(said() == "");
  fs::create_directory(results);
  write_whole_file(results / "killed.tmp", "");  // killed in the first file
  CHECK(said() == "");
  for (const char* file : {"notes.txt", "rows", "a"}) {  // files of the user
    write_whole_file(results / file, "no folder");
    CHECK_THAT(said(), Catch::StartsWith("holds files"));
  }
  write_whole_file(results / "a", "it is ours");
  CHECK(said() == "");
  fs::remove(results / "a");
  fs::create_directory(results / "runs");
  CHECK(said() == "");
}

TEST_CASE("what a name leads to, links followed") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "file", link = folder.path() / "link";
  std::ofstream(file) << "x";
  std::filesystem::create_symlink(file, link);
  const auto pipe = folder.path() / "pipe", missing = folder.path() / "missing";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);

  CHECK((path_exists(file) && is_file(file) && !is_folder(file)));
  CHECK((path_exists(link) && is_file(link)));
  CHECK((path_exists(folder.path()) && is_folder(folder.path()) && !is_file(folder.path())));
  CHECK((path_exists(pipe) && !is_file(pipe) && !is_folder(pipe)));
  // A name that the system refuses does not exist.
  const fs::path longer_than_any(std::string(5000, 'n'));
  REQUIRE_THROWS(fs::exists(longer_than_any));
  for (const fs::path& none : {missing, longer_than_any})
    CHECK_FALSE((path_exists(none) || is_file(none) || is_folder(none)));
}

namespace {

bool at_once(double) { return false; }

/// A process that holds the lock until it is killed.
class Holder {
 public:
  explicit Holder(const fs::path& file)
      : child_(std::make_unique<ChildProcess>([&] {
          const FileLock lock(file, at_once);
          for (;;) pause();
        })) {
    const Stopwatch watch;
    while ((!fs::exists(file) || fs::is_empty(file)) && watch.seconds() < 30.0) usleep(1000);
    REQUIRE(fs::exists(file));
  }
  void die() { child_.reset(); }

 private:
  std::unique_ptr<ChildProcess> child_;
};

}  // namespace

TEST_CASE("one holder at a time, who is named to the others, the lock's file goes with it") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "lock";
  for (int k = 0; k < 2; ++k) {
    const FileLock mine(file, at_once);
    CHECK(mine.is_held());
    CHECK_FALSE(FileLock(file, at_once).is_held());
    CHECK(fs::exists(file));
  }
  CHECK_FALSE(fs::exists(file));
  Holder other(file);
  const FileLock lock(file, at_once);
  CHECK_FALSE(lock.is_held());
  CHECK(lock.holder() == read_whole_file(file));
  // The lock of a killed process is free, although its file still exists.
  other.die();
  CHECK(fs::exists(file));
  CHECK(FileLock(file, at_once).is_held());
}

TEST_CASE("a file or link of somebody's is no lock, and stays") {
  const TemporaryFolder folder;
  const fs::path file = folder.write("run.lock", "notes"), link = folder.path() / "link.lock";
  CHECK_THROWS_WITH(FileLock(file, at_once), Catch::StartsWith(file.string()));
  fs::create_symlink(file, link);
  CHECK_THROWS_WITH(FileLock(link, at_once), Catch::StartsWith(link.string()));
  CHECK(read_whole_file(file) == "notes");
  CHECK(fs::is_symlink(link));
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
  CHECK_THROWS_WITH(FileLock(folder.path() / "absent" / "lock", at_once),
                    (folder.path() / "absent" / "lock").string() +
                        ": cannot make the lock: No such file or directory");
}

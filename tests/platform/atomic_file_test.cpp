#include "platform/atomic_file.hpp"

#include <cerrno>

#include <unistd.h>

#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

template <typename Work>
std::string complaint(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a file has its new content after commit(), and its old one until then") {
  const TemporaryFolder folder;
  const fs::path path = folder.write("a.txt", "old");
  {
    AtomicFile file(path);
    file.write("new ");
    file.print("%d %s", 7, "words");
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
  const fs::path absent = folder.path() / "absent" / "a.txt";
  CHECK(complaint([&] { write_whole_file(absent, "x"); }) ==
        absent.string() + ": cannot write: No such file or directory");
  CHECK(complaint([&] { read_whole_file(absent); }) ==
        absent.string() + ": cannot open: No such file or directory");
  const std::string name = folder.path().string();
  CHECK(complaint([&] { write_whole_file(name, "x"); }) ==
        name + ": cannot write: it is not a regular file");
  CHECK(complaint([&] { read_whole_file(name); }) == name + ": cannot read: Is a directory");
  CHECK(complaint([&] { write_whole_file("/dev/full", "x"); }) ==
        "/dev/full: cannot write: it is not a regular file");
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
  create_folder(deep);  // it may be there
  CHECK(fs::is_directory(deep));
  const fs::path file = folder.write("file", "");
  CHECK(complaint([&] {
          create_folder(file);
        }).starts_with(file.string() + ": cannot make the folder"));
  CHECK(complaint([&] {
          create_folder(file / "x");
        }).starts_with((file / "x").string() + ": cannot make the folder"));
}

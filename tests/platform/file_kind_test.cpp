#include "platform/file_kind.hpp"

#include <sys/stat.h>

#include <fstream>
#include <string>

#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("what a name leads to, links followed") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "file", link = folder.path() / "link";
  std::ofstream(file) << "x";
  std::filesystem::create_symlink(file, link);
  const auto pipe = folder.path() / "pipe", missing = folder.path() / "missing";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);

  CHECK((is_there(file) && is_file(file) && !is_folder(file)));
  CHECK((is_there(link) && is_file(link)));
  CHECK((is_there(folder.path()) && is_folder(folder.path()) && !is_file(folder.path())));
  CHECK((is_there(pipe) && !is_file(pipe) && !is_folder(pipe)));
  CHECK_FALSE((is_there(missing) || is_file(missing) || is_folder(missing)));
}

TEST_CASE("a name that the system refuses leads to nothing") {
  const std::string longer_than_any(5000, 'n');
  REQUIRE_THROWS(std::filesystem::exists(longer_than_any));
  CHECK_FALSE(is_there(longer_than_any));
  CHECK_FALSE(is_file(longer_than_any));
  CHECK_FALSE(is_folder(longer_than_any));
}

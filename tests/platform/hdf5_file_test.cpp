#include "platform/hdf5_file.hpp"

#include <hdf5.h>
#include <unistd.h>

#include <cstdio>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/hdf5_reader.hpp"
#include "platform/hdf5_writer.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("a handle is closed once, by whoever has it last") {
  static int closed = 0;
  const auto count = [](std::int64_t) {
    ++closed;
    return 0;
  };
  {
    Hdf5Id first(7, count);
    Hdf5Id second(std::move(first));
    CHECK(second == 7);
    CHECK(first < 0);
    CHECK(closed == 0);
  }
  CHECK(closed == 1);
  {
    Hdf5Id closed_by_hand(8, count);
    CHECK(closed_by_hand.close() == 0);
    const Hdf5Id none(-1, count);
  }
  CHECK(closed == 2);
}

TEST_CASE("HDF5 prints nothing of its own while a file is in use, and speaks again afterwards") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5", log = folder.path() / "log";
  Hdf5Writer(path, Hdf5Storage::plain).commit();
  const int saved = dup(STDERR_FILENO);
  REQUIRE(std::freopen(log.c_str(), "w", stderr));
  std::string first, second;
  try {
    Hdf5Reader(path).read_doubles("x");
  } catch (const Error& error) {
    first = error.what();
  }
  try {
    Hdf5Reader(folder.path() / "absent.h5");
  } catch (const Error& error) {
    second = error.what();
  }
  std::fflush(stderr);
  const auto silent = fs::file_size(log);
  // Not through us: HDF5 complains as it was told to.
  const hid_t none = H5Fopen((folder.path() / "absent.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  std::fflush(stderr);
  const auto loud = fs::file_size(log);
  dup2(saved, STDERR_FILENO);
  close(saved);
  CHECK(none < 0);
  CHECK(first == path.string() + ": x: no such dataset");
  CHECK(second == (folder.path() / "absent.h5").string() + ": no such file");
  CHECK(silent == 0);
  CHECK(loud > 0);
}

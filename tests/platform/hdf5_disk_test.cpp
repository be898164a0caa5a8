#include "platform/hdf5_disk.hpp"

#include <hdf5.h>
#include <sys/stat.h>

#include <fstream>
#include <thread>

#include "platform/error.hpp"
#include "platform/hdf5_writer.hpp"
#include "tests/catch.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// Two megabytes, and metadata of many groups.
void write_much(const fs::path& path) {
  Hdf5Writer writer(path, Hdf5Storage::plain);
  writer.add("x", std::vector<double>(250000, 1.5));
  for (int k = 0; k < 6000; ++k) {
    const std::string name = "group " + std::to_string(k);
    writer.add_group(name);
    writer.add_attribute(name, "text", std::string(300, 't'));
  }
  writer.commit();
}

}  // namespace

TEST_CASE("a disk that fills up at any moment is one error, and no file") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5";
  write_much(path);
  const std::uintmax_t length = fs::file_size(path);
  fs::remove(path);
  REQUIRE(length > 3'000'000);
  const auto complaint = [&](rlim_t limit) -> std::string {
    const FileSizeLimit disk(limit);
    try {
      write_much(path);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  for (std::uintmax_t limit = 0; limit < length; limit += length / 23)
    CHECK(complaint(limit) == path.string() + ": cannot write: File too large");
  CHECK(fs::is_empty(folder.path()));
  // HDF5 has no file open that it would try to finish at the end of the program.
  CHECK(H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL) == 0);
}

TEST_CASE("through a pipe the same bytes come out") {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe", file = folder.path() / "a.h5";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::thread reader([&] {
    std::ofstream(folder.path() / "got") << std::ifstream(pipe, std::ios::binary).rdbuf();
  });
  write_much(pipe);
  write_much(file);
  reader.join();
  CHECK((read_whole_file(folder.path() / "got") == read_whole_file(file)));
}

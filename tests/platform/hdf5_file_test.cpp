#include "platform/hdf5_file.hpp"

#include <fcntl.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>

#include "platform/atomic_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/captured_errors.hpp"
#include "tests/support/complaint.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/hdf5_attribute.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("HDF5 prints nothing of its own") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5";
  Hdf5Writer(path, Hdf5Storage::plain).commit();
  const CapturedErrors printed;
  const std::string first = complaint([&] { Hdf5Reader(path).read<double>("x"); }),
                    second = complaint([&] { Hdf5Reader(folder.path() / "absent.h5"); });
  const long bytes = printed.bytes();
  CHECK(bytes == 0);
  CHECK(first == path.string() + ": x: no such dataset");
  CHECK(second == (folder.path() / "absent.h5").string() + ": no such file");
}

namespace {

constexpr size_t sample_rows = 5000;  // 48 bytes each: several compressed chunks

/// Writes an item of each kind, and slices of two by three numbers.
void write_sample(const fs::path& path, Hdf5Storage storage = Hdf5Storage::compressed) {
  Hdf5Writer file(path, storage);
  file.add_group("group");
  file.add_attribute("/", "format", "test 1");
  file.add_attribute("group", "unit", "m/s\u00b2");
  file.add("group/doubles", std::vector<double>{1.5, -0.0, 1e-300});
  file.add("group/ints", std::vector<std::int32_t>{-7, 8});
  file.add("group/long", std::vector<std::int64_t>{std::int64_t{1} << 40, -1});
  file.add("group/keys", std::vector<std::uint64_t>{~std::uint64_t{0}, 3});
  file.add("group/empty", std::vector<double>{});
  file.add("group/texts", std::vector<std::string>{"", "one", "two words"});
  file.add_text("group/text", "a text");
  file.add("group/one", std::vector<std::int32_t>{5});
  {
    const Hdf5Id slices = file.add_rows("group/slices", {sample_rows, 2, 3});
    for (size_t k = 0; k < sample_rows; ++k) {
      const double x = static_cast<double>(k);
      file.write_rows(slices, k, std::vector<double>{x, x + 1, x + 2, -x, -x - 1, -x - 2});
    }
  }
  file.commit();
}

}  // namespace

TEST_CASE("what is no HDF5 file is told apart") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5";
  const auto opened = [&] { return complaint_about(path, [&] { Hdf5Reader file(path); }); };
  CHECK(opened() == "no such file");
  write_whole_file(path, "not at all");
  CHECK(opened() == "not an HDF5 file");
  write_sample(path);
  CHECK(opened() == "");
  fs::resize_file(path, fs::file_size(path) / 2);
  CHECK(opened() == "damaged or truncated HDF5 file");
  CHECK(complaint_about(folder.path(), [&] { Hdf5Reader file(folder.path()); }) ==
        "not a regular file");
  fs::remove(path);
  fs::create_symlink(path, path);
  CHECK(opened() == "cannot open: Too many levels of symbolic links");
}

TEST_CASE("what a file does not have is named") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5";
  write_sample(path);
  const Hdf5Reader file(path);
  CHECK(file.has("group"));
  CHECK(file.has("/group/ints"));
  CHECK_FALSE(file.has("group/y"));
  CHECK_FALSE(file.has("h/x"));
  const auto said = [&](auto work) { return complaint_about(path, work); };
  CHECK(said([&] { file.read<double>("h/x"); }) == "h/x: no such dataset");
  CHECK(said([&] { file.read<double>("group"); }) == "group: not a dataset");
  CHECK(said([&] { file.read<double>("group/texts"); }) == "group/texts: does not hold numbers");
  CHECK(said([&] { file.read_int("group/ints"); }) == "group/ints has 2 entries, must have 1");
  CHECK(file.read_int("group/one") == 5);
  CHECK(said([&] { file.read_text("group/ints"); }) == "group/ints: is no text of fixed length");
  CHECK(said([&] { file.read_text("group/texts"); }) == "group/texts: is no text of fixed length");
  CHECK(said([&] { file.read_rows("group/ints", 2); }) ==
        "HDF5 cannot read rows 2 to 3 of group/ints");
  CHECK(said([&] { file.read_texts("group/ints"); }) == "HDF5 cannot read group/ints");
}

TEST_CASE("a text of any length that was never written is empty") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5";
  {
    const Hdf5Id file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose),
        type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    const hsize_t two = 2;
    const Hdf5Id space(H5Screate_simple(1, &two, nullptr), H5Sclose),
        plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_alloc_time(plan, H5D_ALLOC_TIME_EARLY);
    const Hdf5Id texts(H5Dcreate2(file, "x", type, space, H5P_DEFAULT, plan, H5P_DEFAULT),
                       H5Dclose);
  }
  CHECK(Hdf5Reader(path).read_texts("x") == std::vector<std::string>{"", ""});
}

TEST_CASE("a bit that flips in compressed numbers is noticed") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5";
  std::vector<double> many(20000);
  for (size_t k = 0; k < many.size(); ++k) many[k] = 0.1 * static_cast<double>(k * k);
  Hdf5Writer writer(path, Hdf5Storage::compressed);
  writer.add("few", std::vector<double>{1.0, 2.0});
  writer.add("many", many);
  writer.commit();
  std::string bytes = read_whole_file(path);
  const size_t middle = bytes.size() / 2;  // most of the file is "many"
  bytes[middle] = static_cast<char>(bytes[middle] ^ 1);
  write_whole_file(path, bytes);
  const Hdf5Reader file(path);
  CHECK(file.read<double>("few") == std::vector<double>{1.0, 2.0});
  CHECK(complaint_about(path, [&] { file.read<double>("many"); }) ==
        "many: cannot be read (damaged or truncated)");
}

TEST_CASE("what is written is read back, plain or compressed") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5";
  for (const Hdf5Storage storage : {Hdf5Storage::plain, Hdf5Storage::compressed}) {
    write_sample(path, storage);
    const Hdf5Reader file(path);
    CHECK(hdf5_attribute(path, "/", "format") == "test 1");
    CHECK(hdf5_attribute(path, "group", "unit") == "m/s\u00b2");
    CHECK(file.read<double>("group/doubles") == std::vector<double>{1.5, -0.0, 1e-300});
    CHECK(std::signbit(file.read<double>("group/doubles")[1]));
    CHECK(file.read<int>("group/ints") == std::vector<int>{-7, 8});
    CHECK(file.read<double>("group/long") == std::vector<double>{0x1p40, -1.0});
    CHECK(file.read<std::uint64_t>("group/keys") ==
          std::vector<std::uint64_t>{~std::uint64_t{0}, 3});
    CHECK(file.read<double>("group/empty").empty());
    CHECK(file.read<double>("group/doubles", 3).size() == 3);
    CHECK_THROWS_WITH(file.read<double>("group/doubles", 4),
                      Catch::EndsWith("group/doubles has 3 entries, must have 4"));
    CHECK(file.read_texts("group/texts") == std::vector<std::string>{"", "one", "two words"});
    CHECK(file.read_text("/group/text") == "a text");
    CHECK(file.shape("group/slices") == Hdf5Shape{sample_rows, 2, 3});
    CHECK(file.read_rows("group/slices", 4321) ==
          std::vector<double>{4321, 4322, 4323, -4321, -4322, -4323});
    const std::vector<double> all = file.read<double>("group/slices");
    REQUIRE(all.size() == 6 * sample_rows);
    CHECK(all[6 * 17 + 1] == 18.0);
  }
}

TEST_CASE("equal contents are equal bytes, and compression is one") {
  const TemporaryFolder folder;
  const auto bytes = [&](const char* name, Hdf5Storage storage) {
    write_sample(folder.path() / name, storage);
    return read_whole_file(folder.path() / name);
  };
  const std::string plain = bytes("a.h5", Hdf5Storage::plain);
  CHECK(plain == bytes("b.h5", Hdf5Storage::plain));
  CHECK(plain.size() > 48u * 5000u);
  CHECK(bytes("c.h5", Hdf5Storage::compressed).size() < plain.size() / 3);
}

TEST_CASE("without commit() there is no file, and an old one stays") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5";
  { Hdf5Writer writer(path, Hdf5Storage::plain); }
  CHECK(fs::is_empty(folder.path()));
  write_whole_file(path, "old");
  Hdf5Writer(path, Hdf5Storage::plain).add("x", std::vector<double>{1.0});
  CHECK(read_whole_file(path) == "old");
}

TEST_CASE("rows come one by one, many at once, and as whole numbers") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5";
  Hdf5Writer writer(path, Hdf5Storage::compressed);
  constexpr size_t rows = 20000;
  std::vector<double> values(2 * rows);
  for (size_t k = 0; k < values.size(); ++k) values[k] = static_cast<double>(k * k);
  {
    const Hdf5Id pairs = writer.add_rows("pairs", {rows, 2}),
                 keys = writer.add_rows("keys", {3}, Hdf5Number::int64),
                 counts = writer.add_rows("counts", {3}, Hdf5Number::int32);
    for (const size_t first : {size_t{0}, size_t{1}, size_t{777}}) {
      const size_t next = first == 0 ? 1 : first == 1 ? 777 : rows;
      writer.write_rows(pairs, first, std::span(values).subspan(2 * first, 2 * (next - first)));
    }
    writer.write_rows(keys, 0, std::vector<double>{0x1p40, -1.0, 3.0});
    writer.write_rows(counts, 1, std::vector<double>{-7.0, 8.0});
  }
  writer.commit();
  const Hdf5Reader file(path);
  CHECK(file.read<double>("pairs") == values);
  CHECK(file.read_rows("pairs", 776, 2) ==
        std::vector<double>(values.begin() + 1552, values.begin() + 1556));
  CHECK(file.read<std::uint64_t>("keys")[0] == std::uint64_t{1} << 40);
  CHECK(file.read<int>("counts") == std::vector<int>{0, -7, 8});
}

TEST_CASE("what cannot be written is an error that names the file") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5", absent = folder.path() / "absent" / "a.h5";
  const auto said = [&](auto work) { return complaint_about(path, work); };
  CHECK_THROWS_WITH(Hdf5Writer(absent, Hdf5Storage::plain),
                    absent.string() + ": cannot write: No such file or directory");
  Hdf5Writer writer(path, Hdf5Storage::plain);
  writer.add("x", std::vector<double>{1.0});
  for (const std::string name : {"x", "no/x"})
    CHECK(said([&] { writer.add(name, std::vector<double>{2.0}); }) == "HDF5 cannot make " + name);
  CHECK(said([&] { writer.add_group("x"); }) == "HDF5 cannot make x");
  CHECK(said([&] { writer.add_attribute("y", "unit", "m"); }) ==
        "HDF5 cannot write the attribute unit of y");
  {
    const Hdf5Id dataset = writer.add_rows("rows", {2, 3});
    const auto rows = [&](size_t first, size_t size) {
      return said([&] { writer.write_rows(dataset, first, std::vector<double>(size)); });
    };
    for (const auto& [first, size] : {std::pair(2, 3), {1, 4}, {1, 6}, {0, 0}})
      CHECK(rows(first, size) == "HDF5 cannot select rows");
    for (const auto& [first, size] : {std::pair(1, 3), {0, 6}}) CHECK(rows(first, size) == "");
  }
}

namespace {

/// Writes two megabytes, and the metadata of many groups.
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
  const auto write_within = [&](rlim_t limit) {
    const FileSizeLimit disk(limit);
    write_much(path);
  };
  for (std::uintmax_t limit = 0; limit < length; limit += length / 23)
    CHECK(complaint_about(path, [&] { write_within(limit); }) == "cannot write: File too large");
  CHECK(fs::is_empty(folder.path()));
  // HDF5 has no open file that it would try to finish at the end of the program.
  CHECK(H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL) == 0);
}

TEST_CASE("a pipe cannot hold an HDF5 file") {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  CHECK_THROWS_WITH(Hdf5Writer(pipe, Hdf5Storage::plain),
                    pipe.string() + ": cannot write: not a regular file");
  close(reader);
}

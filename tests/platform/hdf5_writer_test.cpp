#include "platform/hdf5_writer.hpp"

#include <cmath>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/hdf5_reader.hpp"
#include "tests/catch.hpp"
#include "tests/support/hdf5_attribute.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// Something of each kind; `rows` slices of two by three numbers.
void fill(Hdf5Writer& file, size_t rows) {
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
  const Hdf5Id slices = file.add_rows("group/slices", {rows, 2, 3});
  for (size_t k = 0; k < rows; ++k) {
    const double x = static_cast<double>(k);
    file.write_rows(slices, k, std::vector<double>{x, x + 1, x + 2, -x, -x - 1, -x - 2});
  }
}

}  // namespace

TEST_CASE("what is written is read back, plain or compressed") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5";
  for (const Hdf5Storage storage : {Hdf5Storage::plain, Hdf5Storage::compressed}) {
    constexpr size_t rows = 5000;  // of 48 bytes: several compressed chunks
    Hdf5Writer writer(path, storage);
    fill(writer, rows);
    writer.commit();
    const Hdf5Reader file(path);
    CHECK(hdf5_attribute(path, "/", "format") == "test 1");
    CHECK(hdf5_attribute(path, "group", "unit") == "m/s\u00b2");
    CHECK(file.read_doubles("group/doubles") == std::vector<double>{1.5, -0.0, 1e-300});
    CHECK(std::signbit(file.read_doubles("group/doubles")[1]));
    CHECK(file.read_ints("group/ints") == std::vector<int>{-7, 8});
    CHECK(file.read_doubles("group/long") == std::vector<double>{0x1p40, -1.0});
    CHECK(file.read_keys("group/keys") == std::vector<std::uint64_t>{~std::uint64_t{0}, 3});
    CHECK(file.read_doubles("group/empty").empty());
    CHECK(file.read_texts("group/texts") == std::vector<std::string>{"", "one", "two words"});
    CHECK(file.read_text("/group/text") == "a text");
    CHECK(file.shape("group/slices") == Hdf5Shape{rows, 2, 3});
    CHECK(file.read_rows("group/slices", 4321) ==
          std::vector<double>{4321, 4322, 4323, -4321, -4322, -4323});
    const std::vector<double> all = file.read_doubles("group/slices");
    REQUIRE(all.size() == 6 * rows);
    CHECK(all[6 * 17 + 1] == 18.0);
  }
}

TEST_CASE("equal contents are equal bytes, and compression is one") {
  const TemporaryFolder folder;
  const auto bytes = [&](const char* name, Hdf5Storage storage) {
    Hdf5Writer writer(folder.path() / name, storage);
    fill(writer, 5000);
    writer.commit();
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
  {
    Hdf5Writer writer(path, Hdf5Storage::plain);
    fill(writer, 1);
  }
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
  CHECK(file.read_doubles("pairs") == values);
  CHECK(file.read_rows("pairs", 776, 2) ==
        std::vector<double>(values.begin() + 1552, values.begin() + 1556));
  CHECK(file.read_keys("keys")[0] == std::uint64_t{1} << 40);
  CHECK(file.read_ints("counts") == std::vector<int>{0, -7, 8});
}

TEST_CASE("what cannot be written is an error that names the file") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5", absent = folder.path() / "absent" / "a.h5";
  const auto complaint = [&](auto work) -> std::string {
    try {
      work();
    } catch (const Error& error) {
      return std::string(error.what()).substr(path.string().size());
    }
    return "no error";
  };
  CHECK_THROWS_WITH(Hdf5Writer(absent, Hdf5Storage::plain),
                    absent.string() + ": cannot write: No such file or directory");
  Hdf5Writer writer(path, Hdf5Storage::plain);
  writer.add("x", std::vector<double>{1.0});
  CHECK(complaint([&] { writer.add("x", std::vector<double>{2.0}); }) == ": HDF5 cannot make x");
  CHECK(complaint([&] { writer.add("no/x", std::vector<double>{2.0}); }) ==
        ": HDF5 cannot make no/x");
  CHECK(complaint([&] { writer.add_group("x"); }) == ": HDF5 cannot make x");
  CHECK(complaint([&] { writer.add_attribute("y", "unit", "m"); }) ==
        ": HDF5 cannot write the attribute unit of y");
  {
    const Hdf5Id dataset = writer.add_rows("rows", {2, 3});
    const auto rows = [&](size_t first, size_t size) {
      return complaint([&] { writer.write_rows(dataset, first, std::vector<double>(size)); });
    };
    CHECK(rows(2, 3) == ": HDF5 cannot select rows");
    CHECK(rows(1, 4) == ": HDF5 cannot select rows");
    CHECK(rows(1, 6) == ": HDF5 cannot select rows");
    CHECK(rows(0, 0) == ": HDF5 cannot select rows");
    CHECK(rows(1, 3) == "no error");
    CHECK(rows(0, 6) == "no error");
  }
}

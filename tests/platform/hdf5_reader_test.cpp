#include "platform/hdf5_reader.hpp"

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/hdf5_writer.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

void write_sample(const fs::path& path) {
  Hdf5Writer writer(path, Hdf5Storage::compressed);
  writer.add_group("g");
  writer.add_attribute("g", "unit", "m");
  writer.add("g/x", std::vector<double>{1.0, 2.0});
  writer.add("g/one", std::vector<std::int32_t>{5});
  writer.add("g/texts", std::vector<std::string>{"a", "b"});
  writer.add_text("g/text", "t");
  std::vector<double> many(20000);
  for (size_t k = 0; k < many.size(); ++k) many[k] = 0.1 * static_cast<double>(k * k);
  writer.add("g/many", many);
  writer.commit();
}

/// What work() complains of, without the file's name; "" when it does not.
template <typename Work>
std::string complaint(const fs::path& path, const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    const std::string text = error.what();
    CHECK(text.starts_with(path.string() + ": "));
    CHECK(text.find('\n') == std::string::npos);
    return text.substr(path.string().size() + 2);
  }
  return "";
}

}  // namespace

TEST_CASE("what is no HDF5 file is told apart") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5";
  const auto opened = [&] { return complaint(path, [&] { Hdf5Reader file(path); }); };
  CHECK(opened() == "no such file");
  write_whole_file(path, "not at all");
  CHECK(opened() == "not an HDF5 file");
  write_sample(path);
  CHECK(opened() == "");
  fs::resize_file(path, fs::file_size(path) / 2);
  CHECK(opened() == "damaged or truncated HDF5 file");
  CHECK(complaint(folder.path(), [&] { Hdf5Reader file(folder.path()); }) == "not a regular file");
}

TEST_CASE("what a file does not have is named") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5";
  write_sample(path);
  const Hdf5Reader file(path);
  CHECK(file.has("g"));
  CHECK(file.has("/g/x"));
  CHECK_FALSE(file.has("g/y"));
  CHECK_FALSE(file.has("h/x"));
  const auto said = [&](auto work) { return complaint(path, work); };
  CHECK(said([&] { file.read_doubles("h/x"); }) == "h/x: no such dataset");
  CHECK(said([&] { file.read_doubles("g"); }) == "g: not a dataset");
  CHECK(said([&] { file.read_doubles("g/texts"); }) == "g/texts: does not hold numbers");
  CHECK(said([&] { file.read_int("g/x"); }) == "g/x has 2 entries, must have 1");
  CHECK(file.read_int("g/one") == 5);
  CHECK(said([&] { file.read_text("g/x"); }) == "g/x: is no text of fixed length");
  CHECK(said([&] { file.read_text("g/texts"); }) == "g/texts: is no text of fixed length");
  CHECK(said([&] { file.read_rows("g/x", 2); }) == "HDF5 cannot read rows 2 to 3 of g/x");
  CHECK(said([&] { file.read_texts("g/x"); }) == "HDF5 cannot read g/x");
}

TEST_CASE("a bit that flips in compressed numbers is noticed") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.h5";
  write_sample(path);
  std::string bytes = read_whole_file(path);
  const size_t middle = bytes.size() / 2;  // most of the file is g/many
  bytes[middle] = static_cast<char>(bytes[middle] ^ 1);
  write_whole_file(path, bytes);
  const Hdf5Reader file(path);
  CHECK(file.read_doubles("g/x") == std::vector<double>{1.0, 2.0});
  CHECK(complaint(path, [&] { file.read_doubles("g/many"); }) ==
        "g/many: cannot be read (damaged or truncated)");
}

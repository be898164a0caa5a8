#include "experiments/record/record_file.hpp"

#include "platform/hdf5_file.hpp"
#include "tests/support/hdf5_attribute.hpp"
#include "tests/support/peak_memory.hpp"
#include "tests/support/sample_record.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// Row k has the numbers 10 k, 10 k + 1, ...
void write_log(const fs::path& path, long rows, size_t row_size) {
  RowWriter log(path, {"rows", 0, row_size});
  std::vector<double> row(row_size);
  for (long k = 0; k < rows; ++k) {
    for (size_t i = 0; i < row_size; ++i)
      row[i] = static_cast<double>(10 * k) + static_cast<double>(i);
    log.append(row);
  }
  log.flush();
}

}  // namespace

TEST_CASE("quantities of rows become datasets, more rows than are gathered at once") {
  const TemporaryFolder folder;
  const fs::path log = folder.path() / "rows", record = folder.path() / "a.h5";
  constexpr long rows = 50000;  // of 48 bytes: more than two megabytes
  write_log(log, rows, 6);
  RowReader reader(log);
  Hdf5Writer writer(record, Hdf5Storage::compressed);
  const RowLayout layout(
      "all", {{"square", {2, 2}, "m", "four"}, {"last", {}, "1", "one", Hdf5Number::int32}}, 1);
  long seen = 0;
  bool in_order = true;
  reader.next();  // it begins with the first row wherever the reader was
  add_rows(writer, reader, layout, [&](std::span<const double> row) {
    in_order = in_order && row[0] == static_cast<double>(10 * seen++);
  });
  writer.commit();
  CHECK((seen == rows && in_order));
  const Hdf5Reader file(record);
  CHECK(file.shape("all/last") == Hdf5Shape{rows});
  CHECK(file.shape("all/square") == Hdf5Shape{rows, 2, 2});
  CHECK(hdf5_attribute(record, "all/square", "unit") == "m");
  CHECK(hdf5_attribute(record, "all/last", "description") == "one");
  const std::vector<double> square = file.read_doubles("all/square");
  const std::vector<int> last = file.read_ints("all/last");
  bool fits = true;
  for (size_t k = 0; k < rows; ++k) {
    const double first = 10.0 * static_cast<double>(k);
    fits = fits && last[k] == static_cast<int>(first) + 5;
    for (size_t i = 0; i < 4; ++i)
      fits = fits && square[4 * k + i] == first + 1 + static_cast<double>(i);
  }
  CHECK(fits);
}

TEST_CASE("rows that are longer than what is gathered, and none at all") {
  const TemporaryFolder folder;
  const fs::path log = folder.path() / "rows", record = folder.path() / "a.h5";
  for (const long rows : {0L, 3L}) {
    write_log(log, rows, 200000);
    RowReader reader(log);
    Hdf5Writer writer(record, Hdf5Storage::compressed);
    add_rows(writer, reader, RowLayout("rows", {{"all", {100000, 2}}}));
    writer.commit();
    const std::vector<double> all = Hdf5Reader(record).read_doubles("rows/all");
    REQUIRE(all.size() == static_cast<size_t>(rows) * 200000);
    if (rows > 0) CHECK(all.back() == 20.0 + 199999.0);
  }
}

TEST_CASE("a record takes the same memory however long its run was") {
  const MechanicalSystem system = sample_system();
  StepMemory memory;
  for (int c = 0; c < 2000; ++c) {
    const double x = std::sin(c);
    memory.contacts.push_back({c, c + 1, 7, Vec3(0, 0, 1), Vec3(x, -x, 2 * x), -1e-6 * x});
    memory.impulses.emplace_back(x, 0.5, x);
  }
  // at the end of a run of so many frames
  const auto peak_after = [&](long frames) {
    const TemporaryFolder folder;
    Recorder recorder(folder.path(), system, 0, true);
    for (long step = 1; step <= frames; ++step) {
      const MotionState state = sample_state(system, step);
      recorder.add_step(sample_row(step));
      recorder.add_poses(state);
      recorder.add_forces(state, memory, 1e-4);
    }
    recorder.flush();
    REQUIRE(fs::file_size(folder.path() / "log" / "forces.bin") >
            112u * 2000u * static_cast<size_t>(frames));
    return peak_memory([&] { recorder.finish("", ""); });
  };
  // 4 MB of contacts, and 27 MB
  CHECK(peak_after(120) < peak_after(20) + 5000);
}

#include "experiments/record/record_file.hpp"

#include "platform/hdf5_file.hpp"
#include "tests/support/hdf5_attribute.hpp"
#include "tests/support/sample_record.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

constexpr double step_length = 2e-4;

/// `step % 4` contacts, all numbers of which say the step and the contact.
StepMemory sample_memory(long step) {
  StepMemory memory;
  for (int c = 0; c < step % 4; ++c) {
    const double x = static_cast<double>(step) + 0.1 * c;
    memory.contacts.push_back({c, c + 1, 7, Vec3(0, 0, 1), Vec3(x, -x, 2 * x), -1e-6 * x});
    memory.impulses.push_back(Vec3(0.0, 0.5, x) * step_length);
  }
  return memory;
}

void record_with_forces(Recorder& recorder, const MechanicalSystem& system, long first, long last) {
  for (long step = first; step <= last; ++step) {
    if (step > 0) recorder.add_step(sample_row(step));
    if (step % 5 != 0) continue;
    const MotionState state = sample_state(system, step);
    recorder.add_poses(state);
    recorder.add_forces(state, sample_memory(step), step_length);
  }
}

}  // namespace

TEST_CASE("record.h5 has the contacts and forces of every stored frame, where they are asked for") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  Recorder recorder(folder.path(), system, 0, true);
  record_with_forces(recorder, system, 0, 20);
  recorder.finish("", "");
  const Hdf5Reader file(folder.path() / "record.h5");
  // steps 0 (none: before the first step), 5, 10, 15, 20 have 0, 1, 2, 3, 0 contacts
  CHECK(file.read_ints("contacts/frame_begin") == std::vector<int>{0, 0, 1, 3, 6, 6});
  CHECK(file.read_ints("contacts/body_a") == std::vector<int>{0, 0, 1, 0, 1, 2});
  CHECK(file.read_ints("contacts/body_b") == std::vector<int>{1, 1, 2, 1, 2, 3});
  const std::vector<double> force = file.read_doubles("contacts/force"),
                            position = file.read_doubles("contacts/position"),
                            gap = file.read_doubles("contacts/gap"),
                            normal = file.read_doubles("contacts/normal");
  REQUIRE(force.size() == 18);
  const double x = 15 + 0.1 * 2;
  CHECK(same_bits(force[17], x * step_length / step_length));
  CHECK(same_bits(force[16], 0.5 * step_length / step_length));
  CHECK(same_bits(position[15], x));
  CHECK(same_bits(gap[5], -1e-6 * x));
  CHECK(normal[17] == 1.0);
  CHECK(hdf5_attribute(folder.path() / "record.h5", "contacts/force", "unit") == "N");
  CHECK_FALSE(hdf5_attribute(folder.path() / "record.h5", "contacts/gap", "description").empty());
}

TEST_CASE("a run that was killed and goes on has the same forces") {
  const MechanicalSystem system = sample_system();
  const TemporaryFolder folder, through;
  killed([&] {
    Recorder recorder(folder.path(), system, 0, true);
    record_with_forces(recorder, system, 0, 12);
    recorder.flush();
    record_with_forces(recorder, system, 13, 17);
  });
  Recorder resumed(folder.path(), system, 12, true);
  record_with_forces(resumed, system, 13, 20);
  resumed.finish("", "");
  Recorder whole(through.path(), system, 0, true);
  record_with_forces(whole, system, 0, 20);
  whole.finish("", "");
  CHECK((file_bytes(folder.path() / "record.h5") == file_bytes(through.path() / "record.h5")));
}

TEST_CASE("without being asked for there are none") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  Recorder recorder(folder.path(), system, 0);
  record_with_forces(recorder, system, 0, 10);
  recorder.finish("", "");
  CHECK_FALSE(fs::exists(folder.path() / "log" / "forces.bin"));
  CHECK_FALSE(Hdf5Reader(folder.path() / "record.h5").has("contacts"));
}

TEST_CASE("the contacts of every frame are read back, those without force left out") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  const fs::path record = folder.path() / "record.h5";
  {
    Recorder recorder(folder.path(), system, 0, false);
    record_with_forces(recorder, system, 0, 5);
    recorder.finish("", "");
    CHECK(RecordForces(record).frame_count() == 0);
  }
  Recorder recorder(folder.path(), system, 0, true);
  record_with_forces(recorder, system, 0, 20);
  // one more without a force
  const MotionState state = sample_state(system, 25);
  StepMemory memory = sample_memory(2);
  memory.impulses[0] = Vec3::Zero();
  recorder.add_poses(state);
  recorder.add_forces(state, memory, step_length);
  recorder.finish("", "");
  const RecordForces forces(record);
  REQUIRE(forces.frame_count() == 6);
  for (size_t k = 0; k < 6; ++k)
    CHECK(forces.of_frame(k).size() == std::vector<size_t>{0, 1, 2, 3, 0, 1}[k]);
  const FrameContact last = forces.of_frame(3)[2];
  CHECK((last.body_a == 2 && last.body_b == 3));
  CHECK(last.position == Eigen::Vector3f(15.2f, -15.2f, 30.4f));
  CHECK(last.normal == Eigen::Vector3f::UnitZ());
  CHECK_THAT(last.force.z(), Catch::Matchers::WithinRel(15.2f, 1e-6f));
  CHECK_THAT(run_error([&] { forces.of_frame(6); }), Contains("has no contacts of frame 6"));
}

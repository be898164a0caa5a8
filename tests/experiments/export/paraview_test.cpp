#include "experiments/export/vtp_file.hpp"

#include "tests/experiments/export/sample_contacts.hpp"
#include "tests/experiments/export/xml_sample.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> pvd_files(const fs::path& file) {
  std::vector<std::string> names;
  for (const XmlElement& element : parse_xml(file_bytes(file)))
    if (element.name == "DataSet")
      names.push_back(element.attributes.at("file") + " " + element.attributes.at("timestep"));
  return names;
}

}  // namespace

TEST_CASE("a ParaView series goes on after the step of the checkpoint") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  const auto contacts = sample_contacts(4);
  const std::vector<Vec3> impulses(4, Vec3(0, 0, 2e-4));
  const fs::path paraview = folder.path() / "paraview";
  {
    ParaviewSeries series(folder.path(), system, 0);
    for (long step : {0, 50, 100, 150})
      series.add(sample_state(system, step), contacts, impulses, 2e-4);
  }
  fs::remove(paraview / "grains.pvd");  // died before it was written
  put_bytes(paraview / "grains_00000200.vtp.tmp", "half a frame");
  put_bytes(paraview / "grains_of_salt.vtp", "not ours");
  {
    ParaviewSeries series(folder.path(), system, 120);
    CHECK(pvd_files(paraview / "grains.pvd").size() == 3);
    CHECK_FALSE(fs::exists(paraview / "grains_00000150.vtp"));
    CHECK_FALSE(fs::exists(paraview / "contacts_00000150.vtp"));
    series.add(sample_state(system, 150));
  }
  CHECK(pvd_files(paraview / "grains.pvd") ==
        std::vector<std::string>{"grains_00000000.vtp 0", "grains_00000050.vtp 0.01",
                                 "grains_00000100.vtp 0.02",
                                 "grains_00000150.vtp 0.030000000000000002"});
  CHECK(pvd_files(paraview / "contacts.pvd").size() == 3);
  CHECK(file_bytes(paraview / "grains_of_salt.vtp") == "not ours");
  ParaviewSeries afresh(folder.path(), system, 0);
  CHECK(pvd_files(paraview / "grains.pvd").empty());
  CHECK_FALSE(fs::exists(paraview / "grains_00000000.vtp"));
}

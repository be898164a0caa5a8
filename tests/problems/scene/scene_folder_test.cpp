// Where scenes are found.

#include <cstdlib>

#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/problems/scene/scene_texts.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("scenes are found by path, by name, and in the folder that BALLAST_SCENES names") {
  const TemporaryFolder folder;
  const auto file = folder.write("mine.toml", "[scene]\ntitle = \"my own\"\n" + one_wall);
  CHECK(find_scene(file.string()) == file);
  CHECK_THROWS_WITH(find_scene("mine"), Catch::Contains("mine") && Catch::Contains("vibrated_box"));
  CHECK_THROWS_WITH(find_scene("none.toml"), Catch::Contains("none.toml"));
  setenv("BALLAST_SCENES", folder.path().c_str(), 1);
  CHECK(find_scene("mine") == file);
  REQUIRE(list_scenes().size() == 1);
  CHECK(list_scenes()[0] == std::pair<std::string, std::string>("mine", "my own"));
  unsetenv("BALLAST_SCENES");
}

TEST_CASE("a scene that is not there is refused with what there is") {
  CHECK_THROWS_WITH(find_scene(""), Catch::Contains("no such scene file"));
  CHECK_THROWS_WITH(find_scene("folder/vibrated_box"), Catch::Contains("no such scene file"));
  CHECK_THROWS_WITH(find_scene(std::string(5000, 'n')), Catch::Contains("no scene of this name"));
  setenv("BALLAST_SCENES", "/nowhere", 1);
  CHECK_THROWS_WITH(list_scenes(), Catch::Contains("/nowhere: no such folder of scenes"));
  unsetenv("BALLAST_SCENES");
}

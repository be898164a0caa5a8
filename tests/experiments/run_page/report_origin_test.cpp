#include "experiments/run_page/report_origin.hpp"

#include "platform/program.hpp"
#include "tests/catch.hpp"

namespace ballast {
namespace {

TEST_CASE("what makes a run again and what comes next can be pasted in any folder") {
  RunData data;
  data.folder = "some folder/run";
  data.scene_text = "[scene]\n";
  const std::string folder = std::filesystem::absolute(data.folder).string();
  CHECK_THAT(reproduce_commands(data),
             Catch::Contains(shell_line({own_program().string(), "run", folder + "/scene.toml",
                                         "--output", folder + "-again"})));
  data.scene_text.clear();  // nothing to make it from
  CHECK_THAT(reproduce_commands(data), !Catch::Contains("run"));
  for (const bool has_grains : {false, true})
    CHECK_THAT(next_commands(has_grains), Catch::Contains(shell_word(own_program().string())) &&
                                              !Catch::Contains("build/default/bin/ballast plan"));
}

}  // namespace
}  // namespace ballast

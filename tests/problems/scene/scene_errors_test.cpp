// Wrong scenes: the error names the file, line, key and value, and the expected value. The types
// and ranges of every key are in scene_docs_test.cpp.

#include "tests/problems/scene/scene_texts.hpp"

using namespace ballast;

TEST_CASE(
    "a scene that is wrong is refused in one line that names file, line, key, value and what was "
    "expected") {
  struct Wrong {
    std::string text;
    std::vector<std::string> named;
  };
  const std::string body = "[[body]]\nshape = \"box\"\nsize = [1, 1, 1]\n";
  const std::string grains = "[grains]\ncount = 10\n[box]\nlength = 0.3\nwidth = 0.3\n";
  const std::string driven = one_wall + "motion = \"driven\"\n";
  const std::vector<Wrong> wrongs = {
      // TOML itself.
      {"[scene\n", {":1:", "not valid TOML"}},
      {"[scene]\nstep = 1\nstep = 2\n", {":3:", "step"}},
      {"", {"nothing in it", "[grains]"}},
      {"[scene]\nname = \"empty\"\n", {"nothing in it"}},
      // Unknown keys, at every depth.
      {"[sceen]\nstep = 1\n" + one_wall, {":1:", "sceen", "unknown key", "\"scene\""}},
      {one_wall + "frictoin = 0.4\n", {":3:", "wall.0.frictoin = 0.4", "\"friction\""}},
      {body + "mass = 1\nradius = 3\n", {":5:", "body.0.radius = 3", "unknown key", "size"}},
      {body + "mass = 1\nforce = { constnat = [0, 0, 1] }\n",
       {"body.0.force.constnat = [0, 0, 1]", "\"constant\""}},
      {grains + "[deposit]\nlid_time = 1e300\n",
       {"deposit.lid_time = 1e+300", "at most 1e12 steps"}},
      {grains + "[deposit]\nsettle_time = 1e200\n", {"deposit.settle_time", "at most 1e12 steps"}},
      {grains + "[deposit]\nmax_time = 1e300\n", {"deposit.max_time", "at most 1e12 steps"}},
      {grains + "[deposit]\nmax_time = 1e-300\n", {"deposit.max_time", "shorter than a step"}},
      {grains + "[deposit]\nstep = 1e-300\n", {"deposit.max_time", "at most 1e12 steps"}},
      {grains + "[grains.shape]\nangularity = 2\n",
       {"grains.shape.angularity = 2", "unknown key", "roughness"}},
      {"step = 1e-4\n" + one_wall, {":1:", "step = 1e-04", "unknown key"}},
      // Types and relations.
      {"scene = 3\n" + one_wall, {"scene = 3", "expected a table [scene]"}},
      {"[gravity]\ndirection = [0, 1, \"z\"]\n" + one_wall, {"gravity.direction", "entry 2"}},
      {"[wall]\nnormal = [0, 0, 1]\n", {"wall", "[[wall]]"}},
      {"[scene]\nstep = 2\nduration = 1\n" + one_wall, {"scene.step = 2", "step <= duration"}},
      {"[scene]\nname = \"a/b\"\n" + one_wall, {"scene.name = \"a/b\"", "letters"}},
      {"[gravity]\ndirection = [0, 0, 0]\n" + one_wall,
       {"gravity.direction = [0, 0, 0]", "not zero"}},
      {"[solver]\nwarm_strat = true\n" + one_wall,
       {"solver.warm_strat = true", "did you mean \"warm_start\""}},
      // Walls.
      {"[[wall]]\nnormal = [0, 0, 0]\n", {"wall.0.normal = [0, 0, 0]", "not zero"}},
      {"[[wall]]\nnormal = [0, 0, 1e200]\n", {"wall.0.normal = [0, 0, 1e+200]", "finite length"}},
      {driven + "mass = 1\n", {"wall.0.load.f_max is missing", "[N]"}},
      {driven + "mass = 1\nload = { f_min = 2, f_max = 1, frequency = 5 }\n",
       {"wall.0.load.f_min = 2", "f_max"}},
      {one_wall + "mass = 3\n", {"wall.0.mass = 3", "unknown key"}},
      {one_wall + "name = \"a\"\n" + one_wall + "name = \"a\"\n",
       {":6:", "wall.1.name = \"a\"", "twice"}},
      {one_wall + "name = \"\"\n", {"wall.0.name = \"\"", "empty"}},
      // Bodies.
      {"[[body]]\nshape = \"box\"\nsize = [1, -2, 1]\nmass = 1\n",
       {"body.0.size = [1, -2, 1]", "> 0 [m]"}},
      {"[[body]]\nshape = \"box\"\nsize = [1, 1e-12, 1]\nmass = 1\n", {"body.0.shape = \"box\""}},
      {body, {"body.0.density is missing", "[kg/m^3]"}},
      {body + "mass = -1\n", {":4:", "body.0.mass = -1", "> 0 [kg]"}},
      {body + "mass = 1\ndensity = 1\n", {"body.0.mass = 1", "density"}},
      {body + "mass = 1\nlocked = [\"w\"]\n", {"body.0.locked = [\"w\"]", "\"rotation\""}},
      {body + "mass = 1\nlocked = [\"x\"]\nvelocity = [1, 0, 0]\n",
       {"body.0.velocity = [1, 0, 0]", "locked"}},
      {body + "mass = 1\nlocked = [\"rotation\"]\nspin = [1, 0, 0]\n",
       {"body.0.spin = [1, 0, 0]", "locked"}},
      {body + "mass = 1\norientation = { axis = [0, 0, 0] }\n",
       {"body.0.orientation.axis = [0, 0, 0]", "not zero"}},
      {one_wall + "name = \"a\"\n" + body + "mass = 1\nname = \"a\"\n",
       {"body.0.name = \"a\"", "twice"}},
      {"[[body]]\nshape = \"mesh\"\nmass = 1\nfile = \"none.obj\"\n",
       {"body.0.file = \"none.obj\"", "none.obj"}},
      // Grains.
      {"[grains]\ncount = 10\n", {"box.length is missing", "[m]"}},
      {"[grains]\ncount = 10\n[box]\nlength = 1\nwidth = 0.05\n",
       {"box.width = 0.05", "at least 0.1"}},
      {"[box]\nlength = 1\nwidth = 1\n", {"box = {", "[grains]"}},
      {"[drive]\nfrequency = 1\n" + one_wall, {"drive = {frequency = 1}", "[grains]"}},
      {grains + one_wall, {"wall = [{", "together with [grains]"}},
      {grains + body + "mass = 1\n", {"body = [{", "together with [grains]"}},
      {grains + "[gravity]\nmagnitude = 0\n", {"gravity = {magnitude = 0}", "deposited"}},
      {grains + "[gravity]\ndirection = [1, 0, -1]\n", {"gravity", "deposited"}},
      {grains + "[grains.shape]\nmin_vertices = 30\nmax_vertices = 20\n",
       {"grains.shape.min_vertices = 30", "max_vertices"}},
      {grains + "[grains.shape]\nflatness_min = 0.7\nelongation_min = 0.6\nflatness_max = 0.9\n",
       {"grains.shape.flatness_min = 0.7", "larger than elongation_min"}},
      {grains + "[[grains.distribution]]\nsize = 0.02\nfraction = 0.7\n",
       {"grains.distribution", "sum to 0.7", "expected 1"}},
      {grains + "[drive]\nf_min_over_weight = 9\n",
       {"drive.f_min_over_weight = 9", "f_max_over_weight"}},
      {grains + "[control_volume]\nmargin_x = 0.2\n",
       {"control_volume.margin_x = 0.2", "box.length"}},
  };
  const TemporaryFolder folder;
  for (const Wrong& wrong : wrongs) {
    const std::string message = error_of(folder, wrong.text);
    INFO(wrong.text);
    for (const std::string& part : wrong.named) CHECK_THAT(message, Catch::Contains(part));
  }
}

TEST_CASE("control characters of a broken file stay out of the message") {
  const TemporaryFolder folder;
  for (const char* text :
       {"a = in\n", "a = 1\x7f\n", "\"b\tc\" = 1\n", "[scene]\nname = \"a\\u0007\\n\"\n"}) {
    const std::string message = error_of(folder, text);
    INFO(message);
    CHECK(std::none_of(message.begin(), message.end(),
                       [](unsigned char c) { return c < 32 || c == 127; }));
  }
}

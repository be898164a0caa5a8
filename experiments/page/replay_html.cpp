// A replay as a part of a page: controls come from the script, which draws into the element.

#include <algorithm>
#include <array>

#include "experiments/page/html.hpp"
#include "platform/deflate.hpp"

namespace ballast {

std::string replay_file(const std::string& name);   // of experiments/page/replay
std::string answers_file(const std::string& name);  // of experiments/page/answers

namespace page {
namespace {

/// The modules in the order in which they build upon each other.
constexpr std::array modules = {"vector.js", "colour.js", "decode.js",  "data.js",  "camera.js",
                                "shader.js", "mesh.js",   "light.js",   "rods.js",  "drawing.js",
                                "rest.js",   "shades.js", "marks.js",   "pick.js",  "plots.js",
                                "panel.js",  "errors.js", "address.js", "input.js", "replay.js"};

std::string script() {
  std::string code = "(() => {\n\"use strict\";\n" + answers_file("choice.js");
  for (const char* name : modules) code += replay_file(name);
  return code + "})();\n";
}

/// Inside a script element only "</" could end it: "<\/" is the same in JSON.
std::string for_script(std::string json) {
  for (size_t at = 0; (at = json.find("</", at)) != std::string::npos; at += 3)
    json.insert(at + 1, 1, '\\');
  return json;
}

}  // namespace

void write_replay(const Replay& replay, const Write& write) {
  write("<figure class=\"replay\" id=\"replay\">\n<style>\n" + replay_file("replay.css") +
        "</style>\n<div id=\"replay-stage\">");
  if (!replay.still.empty())
    write("<img alt=\"The bodies in 3D: a still picture\" src=\"data:image/png;base64," +
          base64(replay.still) + "\">");
  write(
      "</div>\n<p id=\"replay-sentence\">This picture moves in a browser with WebGL 2 and "
      "scripts.</p>\n");
  if (!replay.caption.empty()) write("<figcaption>" + html_of(replay.caption) + "</figcaption>\n");
  write("<script type=\"application/json\" id=\"replay-head\">" + for_script(replay.head) +
        "</script>\n");
  for (const auto& [name, bytes] : replay.parts) {
    write("<script type=\"text/plain\" id=\"replay-" + name + "\">");
    write(base64(deflated(bytes, 9)));
    write("</script>\n");
  }
  write("<script>\n" + script() + "</script>\n</figure>\n");
}

}  // namespace page
}  // namespace ballast

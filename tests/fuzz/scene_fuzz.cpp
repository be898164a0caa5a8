// A scene in TOML. An accepted scene is resolved to a text that resolves to itself.

#include "problems/scene/scene_file.hpp"
#include "tests/fuzz/fuzz_file.hpp"

using namespace ballast;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::input_folder().write("scene.toml", fuzz::text_of(data, size));
  fuzz::refused_or(file, [&] {
    const std::string text = resolve_scene(file).text;
    const auto again = fuzz::input_folder().write("again.toml", text);
    if (resolve_scene(again).text != text) fuzz::finding("the resolved text resolves to another");
  });
  return 0;
}

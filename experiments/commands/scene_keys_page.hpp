#pragma once
// The part of docs/manual/scenes.md that is written from the tables of keys.

#include <string>

namespace ballast {

/// Markdown: every key of a scene file with unit, default, what is expected, and meaning.
/// docs/manual/scenes.md ends with it.
std::string scene_keys_markdown();

}  // namespace ballast

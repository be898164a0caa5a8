#pragma once
// What a name leads to, links followed.
//
// std::filesystem's own questions throw for a name that the system refuses (longer than a file's
// name may be, a folder that may not be entered). Words of a command line and of a scene are such
// names, so everywhere else these are asked: nothing is there then.

#include <filesystem>

namespace ballast {

inline bool is_there(const std::filesystem::path& path) noexcept {
  std::error_code refused;
  return std::filesystem::exists(path, refused);
}

/// A regular file: not a folder, a pipe or a device.
inline bool is_file(const std::filesystem::path& path) noexcept {
  std::error_code refused;
  return std::filesystem::is_regular_file(path, refused);
}

inline bool is_folder(const std::filesystem::path& path) noexcept {
  std::error_code refused;
  return std::filesystem::is_directory(path, refused);
}

}  // namespace ballast

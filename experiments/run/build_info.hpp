#pragma once
// Which program this is: version, commit, compiler, libraries. Filled in by the build
// (build_info.cmake).

#include <string>
#include <utility>
#include <vector>

namespace ballast {

struct BuildInfo {
  std::string version;     ///< of the project, "0.1.0"
  std::string commit;      ///< git hash, 40 digits; "unknown" when built outside a git work tree
  bool modified = false;   ///< tracked files differed from that commit when the program was built
  std::string compiler;    ///< "GNU 12.2.0"
  std::string build_type;  ///< "Release"
  std::string flags;       ///< of the compiler, in its order
  std::vector<std::pair<std::string, std::string>> libraries;  ///< name, version
};

const BuildInfo& build_info();

/// One line: "ballast 0.1.0 (0123456789ab, modified), GNU 12.2.0, Release".
std::string build_line();

}  // namespace ballast

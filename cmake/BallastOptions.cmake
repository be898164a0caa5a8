# Compile options shared by every target: one interface library, one place.
include(GNUInstallDirs)
add_library(ballast_options INTERFACE)
target_include_directories(ballast_options INTERFACE
  $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/ballast>)
target_compile_features(ballast_options INTERFACE cxx_std_20)
# Same bits on every machine: no fused multiply-add chosen by the compiler, no reassociation.
# Nobody reads errno after std::sqrt; without this each root is a branch and no loop with one is
# vectorised.
target_compile_options(ballast_options INTERFACE
  -ffp-contract=off -fno-math-errno
  $<BUILD_INTERFACE:-Wall> $<BUILD_INTERFACE:-Wextra> $<BUILD_INTERFACE:-Wshadow>
  $<BUILD_INTERFACE:-Wnon-virtual-dtor>)
# GCC 12 warns of std::string's own copying wherever texts are joined (its bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(ballast_options INTERFACE
    -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds -Wno-restrict)
endif()
if(BALLAST_WARNINGS_AS_ERRORS)
  target_compile_options(ballast_options INTERFACE $<BUILD_INTERFACE:-Werror>)
endif()
if(BALLAST_SANITIZE)
  target_compile_options(ballast_options INTERFACE -fsanitize=${BALLAST_SANITIZE}
    -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(ballast_options INTERFACE -fsanitize=${BALLAST_SANITIZE})
  # With sanitizers GCC 12 takes std::regex's own variables for uninitialised (its bug 105562).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(ballast_options INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()

# ballast_room(NAME FOLDER [COLD] [DOORS rooms...] [LIBRARIES targets...] [EXCEPT files...])
#
# The library ballast_NAME of one room of the house: all .cpp files of FOLDER, except those named.
# (They need an optional library: the caller adds them where it is found.)
#   DOORS      the rooms whose headers it may include; what is not named here does not link
#   LIBRARIES  third-party libraries that only its sources see
#   COLD       its code says and draws: it runs once in a while, so it is compiled fast (-Og) and
#              in larger batches
# Sources are compiled in batches (unity build), and the headers that nearly all of them need are
# read once (precompiled).
# An inline function that two rooms use is kept once, and the linker takes the first that it sees:
# programs link the other rooms' objects before the cold ones (ballast_hot_first).
function(ballast_room name folder)
  cmake_parse_arguments(ROOM "COLD" "" "DOORS;LIBRARIES;EXCEPT" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
  list(TRANSFORM ROOM_EXCEPT PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/)
  list(REMOVE_ITEM sources ${ROOM_EXCEPT})
  add_library(ballast_${name} STATIC ${sources})
  list(TRANSFORM ROOM_DOORS PREPEND ballast_)
  target_link_libraries(ballast_${name}
    PUBLIC ballast_options Eigen3::Eigen ${ROOM_DOORS}
    PRIVATE ${ROOM_LIBRARIES})
  if(ROOM_COLD)
    target_compile_options(ballast_${name} PRIVATE ${ballast_cold_options})
    ballast_compile_in_batches(ballast_${name} 24)
    target_precompile_headers(ballast_${name} REUSE_FROM ballast_cold_headers)
  else()
    set_property(GLOBAL APPEND PROPERTY BALLAST_HOT_ROOMS ballast_${name})
    ballast_compile_in_batches(ballast_${name} 8)
    target_precompile_headers(ballast_${name} REUSE_FROM ballast_headers)
  endif()
endfunction()

# Links the objects of all rooms but the cold ones into `target` by themselves, before the cold
# rooms' archives.
function(ballast_hot_first target)
  get_property(rooms GLOBAL PROPERTY BALLAST_HOT_ROOMS)
  foreach(room IN LISTS rooms)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${room}>)
  endforeach()
endfunction()

# The batches of a target: so many sources are one translation unit. Large batches compile fast as a
# whole, small ones after an edit.
function(ballast_compile_in_batches target size)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${size})
endfunction()

# The headers that nearly all rooms need, for both kinds of rooms.
set(ballast_cold_options $<$<CONFIG:Release>:-Og>)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled/headers.cpp
  CONTENT "// For the precompiled headers of this target.\n")
foreach(headers ballast_headers ballast_cold_headers)
  add_library(${headers} OBJECT ${CMAKE_BINARY_DIR}/precompiled/headers.cpp)
  target_link_libraries(${headers} PUBLIC ballast_options Eigen3::Eigen)
  target_precompile_headers(${headers} PRIVATE
    <Eigen/Dense> <Eigen/Sparse> <algorithm> <chrono> <cmath> <filesystem> <fstream> <functional>
    <iostream> <map> <memory> <optional> <set> <span> <sstream> <string> <variant> <vector>)
endforeach()
target_compile_options(ballast_cold_headers PRIVATE ${ballast_cold_options})

# ballast_files(NAME FOLDER FUNCTION): builds the files of FOLDER into the room ballast_NAME, as
#   std::string ballast::FUNCTION(const std::string& name);
# which returns what stands in the file of that name; empty where there is none.
function(ballast_files name folder function)
  file(GLOB files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${files})
  set(code "#include <map>\n#include <string>\n\nnamespace ballast {\n\n")
  string(APPEND code "std::string ${function}(const std::string& name) {\n")
  string(APPEND code "  static const std::map<std::string, std::string> files{\n")
  foreach(path IN LISTS files)
    get_filename_component(file ${path} NAME)
    file(READ ${path} text)
    string(APPEND code "{\"${file}\", R\"file(${text})file\"},\n")
  endforeach()
  string(APPEND code "  };\n  const auto found = files.find(name);\n")
  string(APPEND code "  return found == files.end() ? \"\" : found->second;\n}\n\n}\n")
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp CONTENT "${code}" @ONLY)
  target_sources(ballast_${name} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
endfunction()

# ballast_file(NAME FUNCTION FILES...): builds files, which may be anywhere, into the room
# ballast_NAME, as std::string ballast::FUNCTION(): one after the other, without those that are not
# found.
function(ballast_file name function)
  set(code "#include <string>\n\nnamespace ballast {\n\nstd::string ${function}() {\n  return \"\"")
  foreach(file IN LISTS ARGN)
    if(EXISTS "${file}")
      file(READ "${file}" text)
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
      string(APPEND code "\nR\"file(${text})file\"")
    endif()
  endforeach()
  string(APPEND code ";\n}\n\n}  // namespace ballast\n")
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "${code}" @ONLY)
  target_sources(ballast_${name} PRIVATE ${source})
endfunction()

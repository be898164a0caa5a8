# ballast_room(NAME FOLDER [DOORS rooms...] [LIBRARIES targets...] [EXCEPT files...])
#
# The library ballast_NAME of one room of the house: all .cpp files of FOLDER, except those named (the
# ones that need an optional library: the caller adds them where the library is found).
#   DOORS      the rooms whose headers it may include; what is not named here does not link
#   LIBRARIES  third-party libraries that only its sources see
# Sources are compiled in batches (unity build): headers that they share are read once for each batch.
function(ballast_room name folder)
  cmake_parse_arguments(ROOM "" "" "DOORS;LIBRARIES;EXCEPT" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
  foreach(file IN LISTS ROOM_EXCEPT)
    list(REMOVE_ITEM sources ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/${file})
  endforeach()
  add_library(ballast_${name} STATIC ${sources})
  list(TRANSFORM ROOM_DOORS PREPEND ballast_)
  target_link_libraries(ballast_${name}
    PUBLIC ballast_options Eigen3::Eigen ${ROOM_DOORS}
    PRIVATE ${ROOM_LIBRARIES})
  set_target_properties(ballast_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)
endfunction()

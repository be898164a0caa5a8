# ballast_room(NAME SOURCES ... DOORS ... LIBRARIES ...): the library ballast_NAME of one room of the house.
# DOORS: the rooms it may include. LIBRARIES: third-party libraries that only its sources see.
# Sources are compiled in batches (unity build): the headers that they share are read once for each batch.
function(ballast_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;DOORS;LIBRARIES" ${ARGN})
  add_library(ballast_${name} STATIC ${ROOM_SOURCES})
  list(TRANSFORM ROOM_DOORS PREPEND ballast_)
  target_link_libraries(ballast_${name}
    PUBLIC ballast_options Eigen3::Eigen ${ROOM_DOORS}
    PRIVATE ${ROOM_LIBRARIES})
  set_target_properties(ballast_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)
endfunction()

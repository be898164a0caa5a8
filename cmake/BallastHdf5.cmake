# ballast_hdf5: HDF5 as what links it needs it. Debian's shared one brings 31 more libraries, which take
# longer to load than all else that the program loads: programs take the static one into themselves.
# It is not made for modules and shared libraries.
cmake_path(REPLACE_EXTENSION HDF5_C_LIBRARY_hdf5 LAST_ONLY a OUTPUT_VARIABLE static_hdf5)
find_library(BALLAST_SZIP sz)
find_package(ZLIB)
add_library(ballast_hdf5 INTERFACE)
target_include_directories(ballast_hdf5 SYSTEM INTERFACE ${HDF5_C_INCLUDE_DIRS})
if(EXISTS "${static_hdf5}" AND BALLAST_SZIP AND ZLIB_FOUND)
  set(is_program $<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>)
  target_link_libraries(ballast_hdf5 INTERFACE
    $<IF:${is_program},${static_hdf5},hdf5::hdf5>
    $<${is_program}:${BALLAST_SZIP}> $<${is_program}:ZLIB::ZLIB>)
else()
  target_link_libraries(ballast_hdf5 INTERFACE hdf5::hdf5)
endif()

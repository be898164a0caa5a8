# ballast_hdf5: the HDF5 library. Debian's shared one brings 31 other libraries, whose loading takes
# half of a program's start, so programs hold the static one. That cannot be in a shared library:
# the Python module has the shared one.
string(REGEX REPLACE "[.]so$" ".a" static_hdf5 "${HDF5_C_LIBRARY_hdf5}")
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

# Debian's siconos-config.cmake asks for the whole platform; only the numerics library is used.
# Defines Siconos_FOUND and the target Siconos::numerics.
find_path(Siconos_INCLUDE_DIR siconos/numerics/FrictionContactProblem.h)
find_library(Siconos_NUMERICS siconos_numerics)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Siconos REQUIRED_VARS Siconos_NUMERICS Siconos_INCLUDE_DIR)

if(Siconos_FOUND AND NOT TARGET Siconos::numerics)
  add_library(Siconos::numerics INTERFACE IMPORTED)
  target_include_directories(Siconos::numerics SYSTEM INTERFACE ${Siconos_INCLUDE_DIR}
    ${Siconos_INCLUDE_DIR}/siconos ${Siconos_INCLUDE_DIR}/siconos/numerics)
  target_link_libraries(Siconos::numerics INTERFACE ${Siconos_NUMERICS})
endif()
mark_as_advanced(Siconos_INCLUDE_DIR Siconos_NUMERICS)

# Defines NLopt_FOUND and the target NLopt::NLopt (the C interface).
find_path(NLopt_INCLUDE_DIR nlopt.h)
find_library(NLopt_LIBRARY nlopt)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(NLopt
  REQUIRED_VARS NLopt_LIBRARY NLopt_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "install libnlopt-dev, or configure with -DBALLAST_NLOPT=OFF")

if(NLopt_FOUND AND NOT TARGET NLopt::NLopt)
  add_library(NLopt::NLopt INTERFACE IMPORTED)
  target_include_directories(NLopt::NLopt INTERFACE ${NLopt_INCLUDE_DIR})
  target_link_libraries(NLopt::NLopt INTERFACE ${NLopt_LIBRARY})
endif()
mark_as_advanced(NLopt_INCLUDE_DIR NLopt_LIBRARY)

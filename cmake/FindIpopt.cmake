# Ipopt 3.11 (Debian 12) has no CMake config. Defines Ipopt_FOUND and the target Ipopt::Ipopt.
find_path(Ipopt_INCLUDE_DIR IpTNLP.hpp PATH_SUFFIXES coin coin-or)
find_library(Ipopt_LIBRARY ipopt)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Ipopt
  REQUIRED_VARS Ipopt_LIBRARY Ipopt_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "install coinor-libipopt-dev, or configure with -DBALLAST_IPOPT=OFF")

if(Ipopt_FOUND AND NOT TARGET Ipopt::Ipopt)
  add_library(Ipopt::Ipopt INTERFACE IMPORTED)
  target_include_directories(Ipopt::Ipopt SYSTEM INTERFACE ${Ipopt_INCLUDE_DIR})
  # Its headers ask which of <cstddef> and <stddef.h> there is.
  target_compile_definitions(Ipopt::Ipopt INTERFACE HAVE_CSTDDEF)
  target_link_libraries(Ipopt::Ipopt INTERFACE ${Ipopt_LIBRARY})
endif()
mark_as_advanced(Ipopt_INCLUDE_DIR Ipopt_LIBRARY)

# SuiteSparse 5.12 (Debian 12) has no CMake config. Defines SuiteSparse_FOUND and the target
# SuiteSparse::SuiteSparse (CHOLMOD, UMFPACK, and the BLAS that both stand on: libsuitesparse-dev
# depends on a BLAS for development).
find_path(SuiteSparse_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse)
find_library(SuiteSparse_CHOLMOD cholmod)
find_library(SuiteSparse_UMFPACK umfpack)
find_library(SuiteSparse_BLAS NAMES blas openblas)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SuiteSparse
  REQUIRED_VARS SuiteSparse_CHOLMOD SuiteSparse_UMFPACK SuiteSparse_BLAS SuiteSparse_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "install libsuitesparse-dev, or configure with -DBALLAST_SUITESPARSE=OFF")

if(SuiteSparse_FOUND AND NOT TARGET SuiteSparse::SuiteSparse)
  add_library(SuiteSparse::SuiteSparse INTERFACE IMPORTED)
  target_include_directories(SuiteSparse::SuiteSparse INTERFACE ${SuiteSparse_INCLUDE_DIR})
  target_link_libraries(SuiteSparse::SuiteSparse INTERFACE
    ${SuiteSparse_UMFPACK} ${SuiteSparse_CHOLMOD} ${SuiteSparse_BLAS})
endif()
mark_as_advanced(SuiteSparse_INCLUDE_DIR SuiteSparse_CHOLMOD SuiteSparse_UMFPACK)

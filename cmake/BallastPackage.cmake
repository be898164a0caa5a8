# What `cmake --install` and `cpack` leave: the program with its scenes, and the rooms that another
# project may build on, as the CMake package Ballast (docs/manual/library.md). What other folders
# install is of the component `program`.
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Ballast)

# Rooms of the library, from the ground up; where a component has the name of a room, it is that
# one.
set(library_rooms platform algebra solver_seam solver_parts gauss_seidel solver_backends solvers)
set(header_folders platform problems/algebra solvers)
if(BALLAST_HDF5)
  list(APPEND library_rooms problem_files)
  list(APPEND header_folders problems/files)
endif()
if(BALLAST_GEOMETRY)
  list(APPEND library_rooms geometry_shape geometry_contact scene mechanics step)
  list(APPEND header_folders geometry problems/scene problems/mechanics experiments/step)
endif()

# What was found is known where it was looked for.
get_directory_property(Siconos_FOUND DIRECTORY ${CMAKE_SOURCE_DIR}/solvers DEFINITION Siconos_FOUND)
if(NOT Siconos_FOUND)
  set(Siconos_FOUND OFF)
endif()

set(library_targets ballast_options)
set_target_properties(ballast_options PROPERTIES EXPORT_NAME options)
foreach(room IN LISTS library_rooms)
  list(APPEND library_targets ballast_${room})
  set_target_properties(ballast_${room} PROPERTIES EXPORT_NAME ${room})
endforeach()
install(TARGETS ${library_targets} EXPORT BallastTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/ballast COMPONENT library)
foreach(folder IN LISTS header_folders)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${folder}/
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ballast/${folder} COMPONENT library
    FILES_MATCHING PATTERN "*.hpp")
endforeach()
install(EXPORT BallastTargets NAMESPACE Ballast:: DESTINATION ${package_folder} COMPONENT library)
configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/package/BallastConfig.cmake.in
  ${CMAKE_BINARY_DIR}/BallastConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/BallastConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/BallastConfig.cmake
    ${CMAKE_BINARY_DIR}/BallastConfigVersion.cmake
    cmake/FindIpopt.cmake cmake/FindSiconos.cmake cmake/FindSuiteSparse.cmake
  DESTINATION ${package_folder} COMPONENT library)

# Two Debian packages, whose dependencies on shared libraries dpkg-shlibdeps finds, and the sources.
set(CPACK_GENERATOR DEB)
set(CPACK_SOURCE_GENERATOR TGZ)
set(CPACK_SOURCE_IGNORE_FILES /build/ /results/ "/\\.git")
set(CPACK_PACKAGE_NAME ballast)
set(CPACK_PACKAGE_CONTACT "the maintainers of Ballast")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Nonsmooth contact dynamics and its solvers")
set(CPACK_COMPONENTS_ALL program library)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME ballast)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS gnuplot-nox)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libballast-dev)
set(development_packages zlib1g-dev libeigen3-dev libhdf5-dev libqhull-dev libtomlplusplus-dev)
set(options SUITESPARSE IPOPT NLOPT)
set(packages libsuitesparse-dev coinor-libipopt-dev libnlopt-dev)
foreach(option package IN ZIP_LISTS options packages)
  if(BALLAST_${option})
    list(APPEND development_packages ${package})
  endif()
endforeach()
if(Siconos_FOUND)
  list(APPEND development_packages libsiconos-numerics-dev)
endif()
list(JOIN development_packages ", " CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS)
include(CPack)

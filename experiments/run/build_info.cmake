# Run at every build (cmake -P): asks git which commit this is and writes OUTPUT from build_info.cpp.in if that changed.
# Takes SOURCE, OUTPUT, VERSION, COMPILER, BUILD_TYPE, FLAGS, LIBRARIES (name=version;...).
set(COMMIT unknown)
set(MODIFIED false)
string(STRIP "${FLAGS}" FLAGS)
string(REGEX REPLACE "([\\\"])" "\\\\\\1" FLAGS "${FLAGS}")  # as a text of JSON
find_program(GIT git)
# Only our own repository counts, not one that happens to lie around an unpacked archive.
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} rev-parse HEAD WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE head OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(COMMIT ${head})
    execute_process(COMMAND ${GIT} --no-optional-locks status --porcelain --untracked-files=no WORKING_DIRECTORY ${SOURCE}
      OUTPUT_VARIABLE changes ERROR_QUIET)
    if(NOT changes STREQUAL "")
      set(MODIFIED true)
    endif()
  endif()
endif()
list(TRANSFORM LIBRARIES REPLACE "(.*)=(.*)" "\"\\1\": \"\\2\"")
list(JOIN LIBRARIES ", " LIBRARIES)
configure_file(${SOURCE}/experiments/run/build_info.cpp.in ${OUTPUT} @ONLY)

# Completions of shells: made by the program itself, installed where shells look for them.
include(GNUInstallDirs)
set(shell_folder ${CMAKE_BINARY_DIR}/shell)
set(shell_files)
foreach(pair bash:ballast zsh:_ballast fish:ballast.fish)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 what)
  list(GET pair 1 file)
  add_custom_command(OUTPUT ${shell_folder}/${what}/${file}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${shell_folder}/${what}
    COMMAND ballast completions ${what} > ${shell_folder}/${what}/${file}
    DEPENDS ballast
    VERBATIM)
  list(APPEND shell_files ${shell_folder}/${what}/${file})
endforeach()
add_custom_target(ballast_shell ALL DEPENDS ${shell_files})
install(FILES ${shell_folder}/bash/ballast
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${shell_folder}/zsh/_ballast DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES ${shell_folder}/fish/ballast.fish
  DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

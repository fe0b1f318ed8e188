# SPDX-License-Identifier: Apache-2.0
find_program(VITRINE_NPM npm)

# vitrine_npm_packages(stamp "Web client"): installs the packages of the current folder's
# package-lock.json into its node_modules. Sets the variable named `stamp` to the file that the
# installation writes last.
function(vitrine_npm_packages stamp what)
  if(NOT VITRINE_NPM)
    message(FATAL_ERROR "npm is missing: ./deploy/setup installs it")
  endif()
  set(here ${CMAKE_CURRENT_SOURCE_DIR})
  set(installed ${here}/node_modules/.package-lock.json)
  add_custom_command(
    OUTPUT ${installed}
    COMMAND ${VITRINE_NPM} ci --no-audit --no-fund --loglevel=error
    COMMAND ${CMAKE_COMMAND} -E touch ${installed}
    DEPENDS ${here}/package.json ${here}/package-lock.json ${here}/.npmrc
    WORKING_DIRECTORY ${here}
    COMMENT "${what}: packages"
    VERBATIM)
  set(${stamp} ${installed} PARENT_SCOPE)
endfunction()

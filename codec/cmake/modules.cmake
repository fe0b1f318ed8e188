# SPDX-License-Identifier: Apache-2.0
# One folder is one target. codec/ARCHITECTURE.md lists the folders with the modules and libraries that
# each uses. The headers of a folder are reached only through a symlink that belongs to its target, so an
# include that the table does not permit does not compile.
include(${CMAKE_CURRENT_LIST_DIR}/libraries.cmake)
set(VITRINE_ARCHITECTURE ${CMAKE_CURRENT_LIST_DIR}/../ARCHITECTURE.md)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${VITRINE_ARCHITECTURE})

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

# In builds with tests, archives of link-time optimised code also hold machine code. If gcc's plugin writes
# the index of such an archive, the index names functions that were inlined away. A linker that looks for
# such a function loads the same member twice. Writing the index without the plugin avoids that.
if(VITRINE_TESTS AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(CMAKE_CXX_ARCHIVE_CREATE_IPO "<CMAKE_AR> --plugin=/dev/null cr <TARGET> <LINK_FLAGS> <OBJECTS>")
  set(CMAKE_CXX_ARCHIVE_FINISH_IPO "<CMAKE_RANLIB> --plugin=/dev/null <TARGET>")
endif()

add_library(vitrine_flags INTERFACE)
# -ffp-contract=off: a fused multiply-add would make the decoder differ between machines.
# -fno-tree-slp-vectorize: g++ 12.2 drops the rounding of paired double -> float -> double
# conversions when it vectorises straight-line code. -fno-math-errno: lets the compiler emit a
# square root as one instruction, without a call that sets errno.
target_compile_options(vitrine_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                                               -Wno-sign-conversion -Wno-missing-field-initializers -Werror -ffp-contract=off
                                               -fno-math-errno -fno-tree-slp-vectorize)
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
  target_compile_definitions(vitrine_flags INTERFACE VITRINE_SANITISED)
endif()
target_link_options(vitrine_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Werror=odr>)

# Shipped modules and programs abort on a memory fault instead of continuing with damaged data: on a
# write past an array on the stack, a copy past a buffer or an index past the end of a container.
# They load at random addresses, and their relocation tables are read-only. Modules that ARCHITECTURE.md
# marks (hot) do not check indices.
# Tests are compiled without optimisation, which _FORTIFY_SOURCE needs, and sanitizers have checks
# of their own. Tests and sanitised builds therefore get none of these options.
# tests/bench/hardening measures the cost.
option(VITRINE_HARDENED "Compile with protections against memory faults; turn off only to measure their cost" ON)
add_library(vitrine_hardened INTERFACE)
add_library(vitrine_hardened_with_indices INTERFACE)
target_link_libraries(vitrine_hardened_with_indices INTERFACE vitrine_hardened)
if(VITRINE_HARDENED AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize=" AND CMAKE_BUILD_TYPE MATCHES "Rel")
  target_compile_options(vitrine_hardened INTERFACE -fstack-protector-strong -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
  target_compile_definitions(vitrine_hardened_with_indices INTERFACE _GLIBCXX_ASSERTIONS)
  target_link_options(vitrine_hardened INTERFACE -pie -Wl,-z,relro -Wl,-z,now)
endif()

# Compiles all files of a target as one if VITRINE_UNITY is on.
function(vitrine_unity target)
  if(VITRINE_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
    # The compiler takes included source files for headers, and warns about the coroutines in them.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# vitrine_rows(codec out): sets `out` to the table rows of the modules below the folder `codec`.
function(vitrine_rows top out)
  file(STRINGS ${VITRINE_ARCHITECTURE} rows REGEX "^\\| `${top}/")
  set(${out} "${rows}" PARENT_SCOPE)
endfunction()

# vitrine_folders(codec out): sets `out` to the folders of the modules below `codec`, such as codec/core.
function(vitrine_folders top out)
  vitrine_rows(${top} rows)
  list(TRANSFORM rows REPLACE "^\\| `([^`]+)`.*$" "\\1")
  set(${out} ${rows} PARENT_SCOPE)
endfunction()

# vitrine_reach(codec/wasm out): sets `out` to the module and all modules that it uses, directly or not.
function(vitrine_reach folder out)
  set(waiting ${folder})
  set(reach)
  while(waiting)
    list(POP_FRONT waiting module)
    list(APPEND reach ${module})
    file(STRINGS ${VITRINE_ARCHITECTURE} row REGEX "^\\| `${module}`")
    string(REGEX REPLACE "^.*\\|([^|]*)\\|[^|]*\\|$" "\\1" used "${row}")
    separate_arguments(used)
    list(APPEND waiting ${used})
    list(REMOVE_DUPLICATES waiting)
    list(REMOVE_ITEM waiting ${reach})
  endwhile()
  set(${out} ${reach} PARENT_SCOPE)
endfunction()

# vitrine_libraries_of(codec out): sets `out` to the libraries that the modules below `codec` use.
function(vitrine_libraries_of top out)
  vitrine_rows(${top} rows)
  foreach(row IN LISTS rows)
    string(REGEX REPLACE "^.*\\|([^|]*)\\|$" "\\1" row "${row}")
    separate_arguments(row)
    list(APPEND libraries ${row})
  endforeach()
  list(REMOVE_DUPLICATES libraries)
  set(${out} ${libraries} PARENT_SCOPE)
endfunction()

# vitrine_modules(codec): creates a target for each module that ARCHITECTURE.md lists below this folder.
function(vitrine_modules top)
  vitrine_rows(${top} rows)
  foreach(row IN LISTS rows)
    string(REGEX MATCH "^\\| `([^`]+)`( \\(hot\\))? \\|[^|]*\\|([^|]*)\\|([^|]*)\\|$" matched "${row}")
    if(NOT matched)
      message(FATAL_ERROR "codec/ARCHITECTURE.md: this row has other than four columns: ${row}")
    endif()
    set(folder ${CMAKE_MATCH_1})
    set(hardened vitrine_hardened_with_indices)
    if(CMAKE_MATCH_2)
      set(hardened vitrine_hardened)
    endif()
    string(STRIP "${CMAKE_MATCH_3}" modules)
    string(STRIP "${CMAKE_MATCH_4}" libraries)
    separate_arguments(modules)
    separate_arguments(libraries)
    vitrine_module(${folder} HARDENED ${hardened} MODULES ${modules} LIBRARIES ${libraries})
  endforeach()
endfunction()

# Creates a static library from the folder's sources, without its programs (main.cpp, *_main.cpp).
function(vitrine_module folder)
  cmake_parse_arguments(module "" "HARDENED" "MODULES;LIBRARIES" ${ARGN})
  vitrine_module_target(${folder} target)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "main\\.cpp$")
  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE vitrine_flags ${module_HARDENED})
    vitrine_unity(${target})
    # Compiles the server's modules without optimisation: they spend more time waiting than
    # computing, and a sanitised build spends most of its time compiling.
    if(folder MATCHES "^server/" AND CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
      target_compile_options(${target} PRIVATE -O0)
    endif()
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  vitrine_give_headers(${folder} ${target} ${scope})
  foreach(name IN LISTS module_MODULES)
    vitrine_module_target(${name} used)
    target_link_libraries(${target} ${scope} ${used})
  endforeach()
  foreach(name IN LISTS module_LIBRARIES)
    vitrine_find_library(${name} found)
    target_link_libraries(${target} ${scope} ${found})
  endforeach()
  # The codec's hot loops span several files: link-time optimisation makes building a model 5 %
  # faster.
  if(sources AND folder MATCHES "^codec/" AND CMAKE_BUILD_TYPE STREQUAL "Release")
    set_target_properties(${target} PROPERTIES INTERPROCEDURAL_OPTIMIZATION ON)
    if(VITRINE_TESTS)  # otherwise the link of each test would optimise the codec again
      target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-ffat-lto-objects>)
    endif()
  endif()
endfunction()

function(vitrine_give_headers folder target scope)
  set(root ${CMAKE_BINARY_DIR}/modules/${target})
  get_filename_component(parent ${folder} DIRECTORY)
  file(MAKE_DIRECTORY ${root}/${parent})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${folder} ${root}/${folder} SYMBOLIC)
  target_include_directories(${target} ${scope} ${root})
endfunction()

function(vitrine_module_target folder out)
  string(REPLACE "/" "_" name "vitrine_${folder}")
  set(${out} ${name} PARENT_SCOPE)
endfunction()

# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Compile options and install locations of all native targets.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "Build type" FORCE)
endif()

# A wheel has two roots: site-packages, and the prefix (its "data" scheme).
if(SKBUILD)
  set(MANYCORE_PREFIX ${SKBUILD_DATA_DIR})
  set(MANYCORE_SITE_PACKAGES ${SKBUILD_PLATLIB_DIR})
else()
  find_package(Python 3.10 REQUIRED COMPONENTS Interpreter)
  set(MANYCORE_PREFIX ${CMAKE_INSTALL_PREFIX})
  set(MANYCORE_SITE_PACKAGES
    ${CMAKE_INSTALL_PREFIX}/lib/python${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}/site-packages)
  install(DIRECTORY rmw_manycore_py bridge/rmw_manycore_bridge DESTINATION ${MANYCORE_SITE_PACKAGES}
    FILES_MATCHING REGEX "\\.(py|pyi|json)$")
endif()

# The build tree has the layout of the installed prefix, so that everything runs from either.
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
# Nothing may refer to the build machine; a library that needs a path sets its own $ORIGIN.
set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)

# Makes paths in messages and debug information relative to the checkout. ccache may pass relative
# paths to the compiler.
file(RELATIVE_PATH source_from_build ${CMAKE_BINARY_DIR} ${CMAKE_SOURCE_DIR})
string(REGEX REPLACE "/+$" "" source_from_build "${source_from_build}")
add_compile_options(
  -ffile-prefix-map=${CMAKE_BINARY_DIR}=build -ffile-prefix-map=${CMAKE_SOURCE_DIR}/=
  -ffile-prefix-map=${source_from_build}/=)

add_library(manycore_options INTERFACE)
target_compile_features(manycore_options INTERFACE cxx_std_17)
target_include_directories(manycore_options INTERFACE
  ${CMAKE_CURRENT_SOURCE_DIR}/rmw_manycore)
target_compile_options(manycore_options INTERFACE
  -Wall -Wextra -fvisibility=hidden $<$<COMPILE_LANGUAGE:CXX>:-fvisibility-inlines-hidden>
  $<$<BOOL:${MANYCORE_WERROR}>:-Werror>)
if(MANYCORE_SANITIZE)
  # The check of virtual tables reads an object through a pipe: in a process without descriptors
  # left, it reports valid ones.
  target_compile_options(manycore_options INTERFACE
    -fsanitize=${MANYCORE_SANITIZE} -fno-sanitize=vptr -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  target_link_options(manycore_options INTERFACE -fsanitize=${MANYCORE_SANITIZE})
endif()

# manycore_library(NAME STATIC|SHARED DIRECTORY [EXCLUDE FILE...]): all *.cpp below DIRECTORY.
function(manycore_library name kind directory)
  cmake_parse_arguments(PARSE_ARGV 3 arg "" "" "EXCLUDE")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${directory}/*.cpp)
  foreach(excluded IN LISTS arg_EXCLUDE)
    list(REMOVE_ITEM sources ${directory}/${excluded})
  endforeach()
  add_library(${name} ${kind} ${sources})
  target_link_libraries(${name} PUBLIC manycore_options)
  # Precompiled, these save g++ a fifth of its time, and clang more. clang-tidy, which precompiles
  # nothing, finds files that do not include what they use.
  target_precompile_headers(${name} PRIVATE
    <algorithm> <atomic> <functional> <memory> <mutex> <optional> <string> <thread> <vector>)
endfunction()

function(manycore_executable name)
  add_executable(${name} ${ARGN})
  target_link_libraries(${name} PRIVATE manycore_options)
endfunction()

# Installs a target under <prefix>/lib/rmw_manycore, where linkers and PATH do not find it.
function(manycore_install_private name subdirectory)
  set(private lib/rmw_manycore/${subdirectory})
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/${private}
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/${private})
  install(TARGETS ${name} DESTINATION ${MANYCORE_PREFIX}/${private})
endfunction()

# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Finds nanobind and, if it is installed, defines `manycore_binding`.

find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module)
execute_process(COMMAND ${Python_EXECUTABLE} -m nanobind --cmake_dir
  OUTPUT_VARIABLE nanobind_ROOT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
find_package(nanobind CONFIG)
if(NOT nanobind_FOUND)
  if(SKBUILD)
    message(FATAL_ERROR "nanobind is a build requirement of the wheel, but was not found")
  endif()
  message(STATUS "No nanobind for ${Python_EXECUTABLE}: the Python bindings are not built")
  return()
endif()

# The library that all bindings link. As one file it compiles in less than half of the time.
nanobind_build_library(nanobind-static)
set_target_properties(nanobind-static PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)

# manycore_binding(NAME DIRECTORY LIBRARY [OPTION...]): module rmw_manycore_py.native.NAME over
# LIBRARY.
function(manycore_binding name directory library)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${directory}/*.cpp)
  nanobind_add_module(${name} NB_STATIC ${ARGN} ${sources})
  target_link_libraries(${name} PRIVATE ${library})
  set_target_properties(${name} PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/rmw_manycore_py/native)
  install(TARGETS ${name} DESTINATION ${MANYCORE_SITE_PACKAGES}/rmw_manycore_py/native)
endfunction()

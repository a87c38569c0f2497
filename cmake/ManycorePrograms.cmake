# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Python programs: short scripts that call `main` of a module.

# manycore_program(NAME MODULE DIRECTORY): <prefix>/DIRECTORY/NAME
function(manycore_program name module directory)
  set(script ${CMAKE_CURRENT_BINARY_DIR}/programs/${name})
  configure_file(${CMAKE_CURRENT_SOURCE_DIR}/cmake/program.py.in ${script} @ONLY)
  install(PROGRAMS ${script} DESTINATION ${MANYCORE_PREFIX}/${directory})
endfunction()

# Examples for `ros2 run`, launch files and mapfiles: package rmw_manycore, executable talker.
file(GLOB example_files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/rmw_manycore_py/examples/*.py)
foreach(file IN LISTS example_files)
  file(STRINGS ${file} has_main REGEX "^def main\\(")
  if(has_main)
    get_filename_component(example ${file} NAME_WE)
    manycore_program(${example} rmw_manycore_py.examples.${example} lib/rmw_manycore)
  endif()
endforeach()

# pip generates the command line tool itself, for its own interpreter.
if(NOT SKBUILD)
  manycore_program(manycore rmw_manycore_py.cli bin)
endif()

# pip also generates the entry points by which `ros2` and `ros2 launch` find extensions.
if(NOT SKBUILD)
  file(READ ${CMAKE_CURRENT_SOURCE_DIR}/pyproject.toml settings)
  string(REGEX MATCHALL "\\[project\\.entry-points[^[]*" groups "${settings}")
  string(REGEX REPLACE "\\[project\\.entry-points\\.\"([^\"]*)\"\\]" "[\\1]" groups "${groups}")
  string(REGEX REPLACE "= \"([^\"]*)\"" "= \\1" groups "${groups}")
  string(REPLACE ";" "" groups "${groups}")
  set(metadata ${CMAKE_CURRENT_BINARY_DIR}/rmw_manycore-${PROJECT_VERSION}.dist-info)
  file(WRITE ${metadata}/entry_points.txt "${groups}")
  file(WRITE ${metadata}/METADATA
    "Metadata-Version: 2.1\nName: rmw-manycore\nVersion: ${PROJECT_VERSION}\n")
  install(DIRECTORY ${metadata} DESTINATION ${MANYCORE_SITE_PACKAGES})
endif()

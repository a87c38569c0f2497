# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Defines `manycore_ros`: headers and libraries of the user's ROS 2; and `ros_share`, the directory
# of its packages' files.
#
# In a sourced ROS 2 install (including colcon builds) packages are found by their ament exports.
# The wheels lack ament_cmake and other dependencies of their exports, so plain paths are used
# there.
add_library(manycore_ros INTERFACE)

set(ros_packages rmw rcutils rcpputils rosidl_runtime_c rosidl_runtime_cpp
  rosidl_typesupport_interface rosidl_typesupport_fastrtps_c rosidl_typesupport_fastrtps_cpp
  rosidl_typesupport_introspection_c rosidl_typesupport_introspection_cpp
  rosidl_dynamic_typesupport tracetools)
set(ros_libraries rmw rcutils rosidl_runtime_c rosidl_typesupport_fastrtps_c
  rosidl_typesupport_fastrtps_cpp rosidl_dynamic_typesupport fastcdr)

if(DEFINED ENV{AMENT_PREFIX_PATH} AND NOT SKBUILD)
  find_package(ament_cmake REQUIRED)
  find_package(fastcdr REQUIRED)
  target_link_libraries(manycore_ros INTERFACE fastcdr)
  foreach(package rmw rcutils rcpputils rosidl_runtime_c rosidl_dynamic_typesupport
      rosidl_typesupport_fastrtps_c rosidl_typesupport_fastrtps_cpp
      rosidl_typesupport_introspection_c rosidl_typesupport_introspection_cpp)
    find_package(${package} REQUIRED)
    target_link_libraries(manycore_ros INTERFACE ${package}::${package})
  endforeach()
  get_filename_component(ros_share ${rmw_DIR}/../.. ABSOLUTE)
  return()
endif()

# A prefix is the directory with lib/pythonX.Y/site-packages. Build front ends pass only
# site-packages: that of the isolated build environment, after that of the python that started the
# build.
set(ros_prefixes ${CMAKE_PREFIX_PATH} $ENV{VIRTUAL_ENV})
if(SKBUILD)
  set(site_packages ${CMAKE_PREFIX_PATH})
  list(REVERSE site_packages)
  list(TRANSFORM site_packages APPEND /../../.. OUTPUT_VARIABLE ros_prefixes)
endif()
find_path(MANYCORE_ROS_INCLUDE rmw/rmw/rmw.h
  PATHS ${ros_prefixes} PATH_SUFFIXES include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH)
if(NOT MANYCORE_ROS_INCLUDE)
  message(FATAL_ERROR "No ROS 2 found: expected include/rmw/rmw/rmw.h under one of "
    "'${ros_prefixes}'. Pass -DCMAKE_PREFIX_PATH=<venv with ros-rclpy[fastrtps]>, source the "
    "setup file of a ROS 2 install, or build without the RMW (-DMANYCORE_BUILD_RMW=OFF).")
endif()
get_filename_component(ros_prefix ${MANYCORE_ROS_INCLUDE} DIRECTORY)
set(ros_share ${ros_prefix}/share)
message(STATUS "ROS 2: ${ros_prefix}")

target_include_directories(manycore_ros SYSTEM INTERFACE ${ros_prefix}/include)
foreach(package IN LISTS ros_packages)
  target_include_directories(manycore_ros SYSTEM INTERFACE ${ros_prefix}/include/${package})
endforeach()
foreach(library IN LISTS ros_libraries)
  target_link_libraries(manycore_ros INTERFACE ${ros_prefix}/lib/lib${library}.so)
endforeach()
# The ROS libraries depend on further libraries of the prefix, which only the final program loads.
target_link_options(manycore_ros INTERFACE
  -Wl,--allow-shlib-undefined -Wl,-rpath-link,${ros_prefix}/lib)

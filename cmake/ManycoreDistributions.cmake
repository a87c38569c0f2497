# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# The distributions of ROS 2 for which this source builds, and the one that it builds for: that of
# the rmw package found, whose directory with `share` is `ros_share` (empty without ROS 2).

# name, version of rmw, version of the rclpy wheel, library of Fast DDS in the wheels
set(distributions
  "jazzy 7.3 7.1.6 libfastrtps.so.2.14"
  "kilted 7.8 9.1.2 libfastdds.so.3.2")

list(GET distributions 0 distribution)
if(ros_share)
  file(STRINGS ${ros_share}/rmw/package.xml found REGEX "<version>[0-9.]+</version>" LIMIT_COUNT 1)
  string(REGEX MATCH "[0-9]+\\.[0-9]+" rmw_version "${found}")
  set(known ${distributions})
  list(FILTER known INCLUDE REGEX "^[a-z]+ ${rmw_version} ")
  if(known)
    set(distribution ${known})
  elseif(DEFINED ENV{ROS_DISTRO})  # sourced: nothing of the wheels is needed
    set(distribution "$ENV{ROS_DISTRO} ${rmw_version} none none")
  else()
    message(FATAL_ERROR "rmw ${rmw_version} in ${ros_share} is of no distribution in "
      "cmake/ManycoreDistributions.cmake")
  endif()
endif()
string(REPLACE " " ";" distribution "${distribution}")
list(GET distribution 0 MANYCORE_ROS_DISTRIBUTION)
list(GET distribution 1 MANYCORE_RMW_VERSION)
list(GET distribution 2 MANYCORE_RCLPY_VERSION)
list(GET distribution 3 MANYCORE_FAST_DDS_LIBRARY)
message(STATUS "ROS 2 distribution: ${MANYCORE_ROS_DISTRIBUTION}")

# For Python: the module rmw_manycore_distribution.
set(distribution_module ${CMAKE_CURRENT_BINARY_DIR}/rmw_manycore_distribution.py)
configure_file(${CMAKE_CURRENT_SOURCE_DIR}/cmake/distribution.py.in ${distribution_module} @ONLY)
install(FILES ${distribution_module} DESTINATION ${MANYCORE_SITE_PACKAGES})

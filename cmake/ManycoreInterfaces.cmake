# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Messages, services and actions for which PyPI has no wheels, built from their published
# definitions in interfaces/: one Python package each, with its libraries.
#
# A sourced ROS 2 install provides them as packages of its own.
if(DEFINED ENV{AMENT_PREFIX_PATH} AND NOT SKBUILD)
  return()
endif()
find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module)
set(generator ${CMAKE_CURRENT_SOURCE_DIR}/cmake/generate_interfaces.py)
set(generators ${CMAKE_CURRENT_SOURCE_DIR}/rmw_manycore_py/interfaces/generator.py)
execute_process(
  COMMAND ${Python_EXECUTABLE} -c
    "import em, lark, numpy, rosidl_generator_py; print(numpy.get_include())"
  OUTPUT_VARIABLE numpy_include OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
  RESULT_VARIABLE generators_missing)
if(generators_missing)
  if(SKBUILD)
    message(FATAL_ERROR
      "The generators of rosidl are build requirements of the wheel, but were not found")
  endif()
  message(STATUS "No rosidl generators for ${Python_EXECUTABLE}: the interfaces are not built")
  return()
endif()

# manycore_interfaces(PACKAGE): builds everything in interfaces/PACKAGE. rosidl_typesupport_c loads
# the libraries by name.
function(manycore_interfaces package)
  set(source ${CMAKE_CURRENT_SOURCE_DIR}/interfaces/${package})
  set(root ${CMAKE_CURRENT_BINARY_DIR}/interfaces)
  file(GLOB_RECURSE definitions CONFIGURE_DEPENDS
    ${source}/*.msg ${source}/*.srv ${source}/*.action)
  # At configure time, because the generated file names are known only afterwards.
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
    ${definitions} ${generator} ${generators})
  execute_process(COMMAND ${Python_EXECUTABLE} ${generator} ${source} ${root} ${ros_prefix}
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

  set(libraries "")
  foreach(kind generator_c typesupport_fastrtps_c typesupport_introspection_c typesupport_c)
    set(library ${package}__rosidl_${kind})
    manycore_generated_sources(sources rosidl_${kind})
    add_library(${library} SHARED ${sources})
    manycore_interface_target(${library} ${kind})
    install(TARGETS ${library} LIBRARY DESTINATION ${MANYCORE_PREFIX}/lib)
    list(APPEND libraries ${library})
  endforeach()

  set(module ${package}_s__rosidl_typesupport_c)
  manycore_generated_sources(sources rosidl_generator_py)
  python_add_library(${module} MODULE WITH_SOABI ${sources})
  manycore_interface_target(${module} generator_py)
  set_target_properties(${module} PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/interface_modules/${package})
  install(TARGETS ${module} DESTINATION ${MANYCORE_SITE_PACKAGES}/${package})
  install(DIRECTORY ${root}/rosidl_generator_py/${package} DESTINATION ${MANYCORE_SITE_PACKAGES}
    FILES_MATCHING PATTERN "*.py")

  # Entries of the ament index: the package, its definitions and their hashes.
  set(share ${MANYCORE_PREFIX}/share)
  set(index ${share}/ament_index/resource_index)
  set(names "")
  foreach(definition IN LISTS definitions)
    file(RELATIVE_PATH name ${source} ${definition})
    string(APPEND names "${name}\n")
  endforeach()
  file(WRITE ${root}/rosidl_interfaces/${package} "${names}")
  file(WRITE ${root}/packages/${package} "")
  install(FILES ${root}/packages/${package} DESTINATION ${index}/packages)
  install(FILES ${root}/rosidl_interfaces/${package} DESTINATION ${index}/rosidl_interfaces)
  foreach(directory ${source} ${root}/idl/${package}
      ${root}/rosidl_generator_type_description/${package})
    install(DIRECTORY ${directory} DESTINATION ${share}
      FILES_MATCHING REGEX "\\.(msg|srv|action|idl|json)$")
  endforeach()
endfunction()

# Called by manycore_interfaces, in its scope.
macro(manycore_generated_sources variable generator)
  set(generated ${root}/${generator}/${package})
  file(GLOB_RECURSE ${variable} ${generated}/*.c ${generated}/*.cpp)
endmacro()

macro(manycore_interface_target target kind)
  target_compile_features(${target} PRIVATE cxx_std_17)
  # Many small files that include the same headers. The description files define the same names in
  # each, so they are excluded.
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
  set(descriptions ${sources})
  list(FILTER descriptions INCLUDE REGEX "__description\\.c$")
  set_source_files_properties(${descriptions} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_include_directories(${target} SYSTEM PRIVATE
    ${numpy_include} ${ros_prefix}/include/rosidl_typesupport_c
    ${ros_prefix}/include/rosidl_typesupport_introspection_c)
  foreach(generator
      rosidl_generator_c rosidl_typesupport_fastrtps_c rosidl_typesupport_introspection_c)
    target_include_directories(${target} SYSTEM PRIVATE ${root}/${generator})
  endforeach()
  target_link_libraries(${target} PRIVATE ${libraries} manycore_ros
    ${ros_prefix}/lib/librosidl_typesupport_c.so
    ${ros_prefix}/lib/librosidl_typesupport_introspection_c.so)
  foreach(dependency action_msgs builtin_interfaces geometry_msgs rcl_interfaces sensor_msgs
      service_msgs std_msgs unique_identifier_msgs)
    target_include_directories(${target} SYSTEM PRIVATE ${ros_prefix}/include/${dependency})
    target_link_libraries(${target} PRIVATE ${ros_prefix}/lib/lib${dependency}__rosidl_${kind}.so)
  endforeach()
endmacro()

foreach(package
    autoware_adapi_v1_msgs autoware_control_msgs autoware_internal_debug_msgs
    autoware_internal_localization_msgs autoware_map_msgs autoware_msgs autoware_planning_msgs
    autoware_vehicle_msgs composition_interfaces manycore_reference_msgs manycore_ros_lite_msgs
    tf2_msgs tier4_control_msgs tier4_external_api_msgs tier4_localization_msgs tier4_vehicle_msgs
    whill_msgs)
  manycore_interfaces(${package})
endforeach()

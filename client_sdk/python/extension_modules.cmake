# Extension modules of the Python package `cohort`, which is assembled in build/…/python.
find_package(Python 3.9 REQUIRED COMPONENTS Interpreter Development.Module)
execute_process(COMMAND ${Python_EXECUTABLE} -m nanobind --cmake_dir
  OUTPUT_VARIABLE nanobind_ROOT OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
find_package(nanobind CONFIG REQUIRED)

set(package ${PROJECT_BINARY_DIR}/python/cohort)

# cohort_extension_module(NAME FOLDER LIBRARY...): builds the module NAME from the sources of FOLDER and those that call
# controllers. Only the module's entry point is exported, so calls inside the module stay inside, including those of
# sin, cos … (client_sdk/math/library_calls.hpp).
function(cohort_extension_module name folder)
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp ${PROJECT_SOURCE_DIR}/client_sdk/python/hosting/*.cpp)
  set(target cohort_python${name})
  nanobind_add_module(${target} STABLE_ABI NB_STATIC NB_SUPPRESS_WARNINGS ${sources})
  target_link_libraries(${target} PRIVATE cohort_flags ${ARGN})
  set(symbols ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/exports.map)
  target_link_options(${target} PRIVATE LINKER:--version-script=${symbols})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${name} LIBRARY_OUTPUT_DIRECTORY ${package} LINK_DEPENDS ${symbols})
endfunction()

# cohort_add_controller(NAME SOURCE...)
#
# Builds one controller twice: as the program NAME (target NAME) and as the plugin NAME.so (target NAME_plugin). CMake
# puts them in its folders of programs and libraries: the current binary directory, unless
# CMAKE_RUNTIME_OUTPUT_DIRECTORY or CMAKE_LIBRARY_OUTPUT_DIRECTORY is set. Add further sources, libraries and options to
# both targets. Sources may also be in C; a project without C++ still needs the C++ library that the SDK was built with.
function(cohort_add_controller name)
  add_executable(${name} ${ARGN})
  add_library(${name}_plugin MODULE ${ARGN})
  foreach(target ${name} ${name}_plugin)
    target_link_libraries(${target} PRIVATE Cohort::sdk)
    # These override CMAKE_CXX_FLAGS, which could give a controller other bits on another CPU. At link time, -ffast-math
    # would make any program that loads the plugin flush subnormal numbers to zero.
    target_compile_options(${target} PRIVATE -ffp-contract=off -fno-fast-math)
    target_link_options(${target} PRIVATE -fno-fast-math)
  endforeach()

  target_compile_definitions(${name}_plugin PRIVATE COHORT_BUILDS_PLUGIN)
  # Only cohort_plugin is exported, and the plugin binds its own symbols: the loading program or another plugin may
  # define the same names in another build.
  set(symbols ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/plugin_symbols.map)
  target_link_options(${name}_plugin PRIVATE LINKER:--version-script=${symbols})
  set_target_properties(${name}_plugin PROPERTIES PREFIX "" OUTPUT_NAME ${name} LINK_DEPENDS ${symbols})
endfunction()

# cohort_add_controller(NAME SOURCE...)
#
# Builds one controller twice: as the program NAME (target NAME) and as the plugin NAME.so (target NAME_plugin). They are
# put where CMake puts programs and libraries: in the current binary directory, unless CMAKE_RUNTIME_OUTPUT_DIRECTORY or
# CMAKE_LIBRARY_OUTPUT_DIRECTORY say otherwise. More sources, libraries and options go to both targets by hand.
# Sources may be in C too; a project without C++ needs its library all the same, which the SDK is made with.
function(cohort_add_controller name)
  add_executable(${name} ${ARGN})
  add_library(${name}_plugin MODULE ${ARGN})
  foreach(target ${name} ${name}_plugin)
    target_link_libraries(${target} PRIVATE Cohort::sdk)
    # Whatever CMAKE_CXX_FLAGS say: with them a controller would answer with other bits on another CPU. To the linker,
    # -ffast-math means that whoever loads the plugin rounds small numbers to zero from then on.
    target_compile_options(${target} PRIVATE -ffp-contract=off -fno-fast-math)
    target_link_options(${target} PRIVATE -fno-fast-math)
  endforeach()

  target_compile_definitions(${name}_plugin PRIVATE COHORT_BUILDS_PLUGIN)
  # Only cohort_plugin is seen from outside, and everything that the plugin has itself is its own: whatever the program
  # that loads it, or another plugin, has under the same name may come from another build.
  set(symbols ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/plugin_symbols.map)
  target_link_options(${name}_plugin PRIVATE LINKER:--version-script=${symbols})
  set_target_properties(${name}_plugin PROPERTIES PREFIX "" OUTPUT_NAME ${name} LINK_DEPENDS ${symbols})
endfunction()

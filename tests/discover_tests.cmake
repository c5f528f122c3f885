# Adds the tests of a GoogleTest program to ctest's. ctest includes this script before it runs tests. Variables:
# - program: the path of the program
# - suites: true for one test of ctest's for each suite, false for one for each test
# - suffix: appended to the names
# - filter: GoogleTest's filter for the tests, or nothing for all
# - properties: of the tests
# - labels: of the tests; those of long_tests.txt also get the label `long`
# - folder: for the result, which is used until the program changes
#
# costs.txt and long_tests.txt, in the folder of this script, say which tests take long. Each of these is a test of
# ctest's by itself, also if `suites` is true.
cmake_path(GET program FILENAME name)
set(result ${folder}/${name}${suffix}_tests.cmake)
set(is_current true)
foreach(source ${program} ${CMAKE_CURRENT_LIST_FILE} ${CMAKE_PARENT_LIST_FILE} ${CMAKE_CURRENT_LIST_DIR}/costs.txt
    ${CMAKE_CURRENT_LIST_DIR}/long_tests.txt)
  if(${source} IS_NEWER_THAN ${result})
    set(is_current false)
  endif()
endforeach()
if(is_current)
  include(${result})
  return()
elseif(NOT EXISTS ${program})
  add_test(${name}_IS_NOT_BUILT ${program})
  return()
endif()

if(NOT filter)
  set(filter *)
endif()
execute_process(COMMAND ${program} --gtest_list_tests --gtest_filter=${filter} OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "  # [^\n]*" "" listed "${listed}")  # the values of parameters
string(REPLACE "\n" ";" listed "${listed}")

# costs.txt: lines "SECONDS TEST".
file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/costs.txt costs REGEX "^[0-9]")
foreach(line ${costs})
  string(REGEX MATCH "^([0-9]+) (.*)$" line "${line}")
  set("seconds_of_${CMAKE_MATCH_2}" ${CMAKE_MATCH_1})
endforeach()

# long_tests.txt: lines "PATTERN REASON".
file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/long_tests.txt long_tests REGEX "^[^# ]")
list(TRANSFORM long_tests REPLACE " .*$" "")
function(find_long test variable)
  set(${variable} false PARENT_SCOPE)
  foreach(pattern ${long_tests})
    if("${test}${suffix}" MATCHES "^${pattern}$")
      set(${variable} true PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

set(text "")
# Adds a test of ctest's that runs the tests of `filter`. It is skipped if one of these is and none fails.
function(write_test test filter)
  set(values ${properties})
  if(DEFINED "seconds_of_${test}${suffix}")
    list(APPEND values COST ${seconds_of_${test}${suffix}})
  endif()
  set(its_labels ${labels})
  find_long(${test} is_long)
  if(is_long)
    list(APPEND its_labels long)
  endif()
  if(test MATCHES "DISABLED_")
    list(APPEND values DISABLED true)
  endif()
  list(APPEND values SKIP_REGULAR_EXPRESSION
    "SKIPPED . [0-9]+ tests?, listed below:\n(.  SKIPPED . [^\n]*\n)+$")
  set(quoted "")
  foreach(value IN LISTS values)
    string(APPEND quoted " [==[${value}]==]")
  endforeach()
  if(its_labels)
    string(APPEND quoted " LABELS [==[${its_labels}]==]")
  endif()
  string(APPEND text "add_test([==[${test}${suffix}]==] [==[${program}]==] [==[--gtest_filter=${filter}]==])\n"
    "set_tests_properties([==[${test}${suffix}]==] PROPERTIES${quoted})\n")
  set(text "${text}" PARENT_SCOPE)
endfunction()

# Adds the tests of `suite` that are not tests of ctest's by themselves.
macro(write_suite)
  if(has_more)
    write_test(${suite} "${suite}.*${apart}")
  endif()
  set(has_more false)
  set(apart "")
  set(sign "-")
endmacro()
set(has_more false)
set(apart "")
set(sign "-")
foreach(line ${listed})
  if(line MATCHES "^  (.+)$")
    set(test ${suite}.${CMAKE_MATCH_1})
    find_long(${test} is_long)
    if(suites AND NOT is_long AND NOT test MATCHES "DISABLED_" AND NOT DEFINED "seconds_of_${test}${suffix}")
      set(has_more true)
    else()
      string(APPEND apart "${sign}${test}")
      set(sign ":")
      write_test(${test} ${test})
    endif()
  elseif(line MATCHES "^([^ ].*)\\.$")
    write_suite()
    set(suite ${CMAKE_MATCH_1})
  endif()
endforeach()
write_suite()
file(WRITE ${result} "${text}")
include(${result})

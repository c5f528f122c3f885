# Writes OUTPUT, with COMMIT or else the commit that SOURCE_DIR is at. Leaves it alone if that is what it says.
if(NOT COMMIT)
  # Sources without git may stand in a repository of something else.
  execute_process(COMMAND git -C ${SOURCE_DIR} rev-parse --show-cdup
    OUTPUT_VARIABLE WAY_UP RESULT_VARIABLE NO_GIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT COMMIT AND NOT NO_GIT AND NOT WAY_UP)
  execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12 --exclude=*
    OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT COMMIT)
  set(COMMIT unknown)
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/commit.hpp.in ${OUTPUT} @ONLY)

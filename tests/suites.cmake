# SPDX-License-Identifier: Apache-2.0
# Makes one test of CTest for each suite of an executable: run after it was linked, as
#   cmake -DEXECUTABLE=FILE -DOUTPUT=FILE -P suites.cmake
# A process for each single test would take a sixth of the fast set's time to start.
execute_process(COMMAND ${EXECUTABLE} --gtest_list_tests
  OUTPUT_VARIABLE listed RESULT_VARIABLE result TIMEOUT 60)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${EXECUTABLE} --gtest_list_tests: ${result}")
endif()
# A suite's line begins with its name, a test's with blanks.
string(REGEX MATCHALL "(^|\n)[^ \n]+\\." suites "${listed}")
set(script)
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "[\n.]" "" suite "${suite}")
  set(label fast)
  if(suite MATCHES "Slow(/|$)")
    set(label slow)
  endif()
  string(APPEND script
    "add_test([=[${suite}]=] [=[${EXECUTABLE}]=] [=[--gtest_filter=${suite}.*]=] --gtest_brief=1)\n"
    "set_tests_properties([=[${suite}]=] PROPERTIES LABELS ${label})\n")
endforeach()
file(WRITE ${OUTPUT} "${script}")

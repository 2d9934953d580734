# Runs after a test program is linked: writes an add_test() for each of its suites to OUTPUT. A suite
# is one process, so that what its tests share (context, shaders, scenes) is made once.
#   cmake -DPROGRAM=... -DNAME=... -DLABEL=... -DCOST=... -DTIMEOUT=... -DRESULTS=... -DOUTPUT=...
#       -P this
execute_process(COMMAND "${PROGRAM}" --gtest_list_tests
    OUTPUT_VARIABLE listed RESULT_VARIABLE failed TIMEOUT 60)
if(failed)
    message(FATAL_ERROR "${PROGRAM} --gtest_list_tests: ${failed}\n${listed}")
endif()
# "Suite." or "Instance/Suite.  # TypeParam = ..." begin a line; tests are indented below.
string(REGEX MATCHALL "(^|\n)[A-Za-z0-9_/]+\\." suites "${listed}")
set(text "")
foreach(suite IN LISTS suites)
    string(REGEX REPLACE "[\n.]" "" suite "${suite}")
    set(test "${NAME}.${suite}")
    string(REPLACE "/" "." file "${test}")
    string(APPEND text
        "add_test([==[${test}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${suite}.*]==]"
        " [==[--gtest_output=xml:${RESULTS}/${file}.xml]==])\n"
        "set_tests_properties([==[${test}]==] PROPERTIES LABELS ${LABEL} COST ${COST} TIMEOUT ${TIMEOUT})\n")
endforeach()
file(WRITE "${OUTPUT}" "${text}")

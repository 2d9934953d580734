# Checks one library against the arrows of docs/architecture.md: headers of folders that it may not
# include are not found from its include roots, and none of its sources names a system header that is
# not for it.
#   cmake -DCOMPILER=... -DINCLUDES=a|b -DROOT=... -DFOLDER=... -DFORBIDDEN=folder|folder
#         -DSYSTEM=header|header -P this
string(REPLACE "|" ";-I" includes "-I${INCLUDES}")
string(REPLACE "|" ";" forbidden "${FORBIDDEN}")

# Is a header of `folder` found?
function(finds folder result)
    file(GLOB headers RELATIVE "${ROOT}" "${ROOT}/${folder}/*.h" "${ROOT}/${folder}/*.glsl")
    if(NOT headers)  # all in folders below
        file(GLOB_RECURSE headers RELATIVE "${ROOT}" "${ROOT}/${folder}/*.h" "${ROOT}/${folder}/*.glsl")
    endif()
    if(NOT headers)
        message(FATAL_ERROR "${folder} holds no header: name another folder")
    endif()
    list(GET headers 0 header)
    # -include looks in the working directory first: there must be nothing in it.
    execute_process(COMMAND ${COMPILER} -std=c++20 -E -x c++ ${includes} -include ${header} /dev/null
        WORKING_DIRECTORY /
        RESULT_VARIABLE failed ERROR_VARIABLE errors OUTPUT_QUIET)
    if(failed AND NOT errors MATCHES "fatal error: '?${header}'?:? (No such file|file not found)")
        message(FATAL_ERROR "${errors}")
    endif()
    set(${result} "${failed}" PARENT_SCOPE)
endfunction()

finds("${FOLDER}" failed)
if(failed)
    message(SEND_ERROR "${FOLDER} does not find its own headers: this check would notice nothing")
endif()
foreach(folder IN LISTS forbidden)
    finds("${folder}" failed)
    if(NOT failed)
        message(SEND_ERROR "${FOLDER} can include headers of ${folder}")
    endif()
endforeach()

file(GLOB_RECURSE sources "${ROOT}/${FOLDER}/*.h" "${ROOT}/${FOLDER}/*.cpp")
foreach(source IN LISTS sources)
    file(STRINGS "${source}" lines REGEX "^#include <(${SYSTEM})")
    if(lines)
        message(SEND_ERROR "${source}: ${lines}")
    endif()
endforeach()

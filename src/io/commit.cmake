# Writes the commit of ROOT as a C string to OUTPUT, and only if it changed.
# GIT: the git program, may be empty. ARCHIVED: a file that `git archive` has filled with the commit.
cmake_minimum_required(VERSION 3.25)

# A repository further up (this library unpacked inside another project) is not ours.
set(commit "unknown")
foreach(variable GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE)
  unset(ENV{${variable}})
endforeach()
set(outer "not ours")
if(GIT)
  execute_process(COMMAND "${GIT}" rev-parse --show-toplevel WORKING_DIRECTORY "${ROOT}"
                  OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE outer ERROR_QUIET)
endif()
if(outer EQUAL 0)
  file(REAL_PATH "${top}" top)
  file(REAL_PATH "${ROOT}" root)
  if(top STREQUAL root)
    execute_process(COMMAND "${GIT}" --no-optional-locks describe --always --dirty --abbrev=40 --exclude=*
                    WORKING_DIRECTORY "${ROOT}" OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE
                    RESULT_VARIABLE failed ERROR_QUIET)
    if(failed EQUAL 0 AND described)
      set(commit "${described}")
    endif()
  endif()
endif()
if(commit STREQUAL "unknown" AND EXISTS "${ARCHIVED}")
  file(STRINGS "${ARCHIVED}" archived LIMIT_COUNT 1)
  if(archived MATCHES "^[0-9a-f]+$")
    set(commit "${archived}")
  endif()
endif()

set(text "\"${commit}\"\n")
set(before "")
if(EXISTS "${OUTPUT}")
  file(READ "${OUTPUT}" before)
endif()
if(NOT text STREQUAL before)
  file(WRITE "${OUTPUT}" "${text}")
endif()

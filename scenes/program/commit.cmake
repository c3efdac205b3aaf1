# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=FOLDER -DOUTPUT=FILE -P commit.cmake: writes the source that defines kCommit. It is
# left alone where it says the same already, so that nothing is compiled again.
set(id "")
set(has_changes false)
# Without optional locks, so that git at work beside the build is not disturbed.
set(git git --no-optional-locks -C ${SOURCE})
# Sources that lie in a repository of something else are not of its commit.
execute_process(COMMAND ${git} rev-parse --show-toplevel OUTPUT_VARIABLE top RESULT_VARIABLE failed
  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
file(REAL_PATH ${SOURCE} source)
if("${failed}" STREQUAL "0" AND "${top}" STREQUAL "${source}")
  execute_process(COMMAND ${git} rev-parse --short=12 HEAD OUTPUT_VARIABLE id
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  execute_process(COMMAND ${git} status --porcelain --untracked-files=no OUTPUT_VARIABLE changes
    ERROR_QUIET)
  if(id AND changes)
    set(has_changes true)
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "scenes/program/commit.hpp"

const tesserae::scenes::Commit tesserae::scenes::kCommit{"@id@", @has_changes@};
]])

# Writes OUTPUT, a C++ source with the git revision of SOURCE ("" without git), only when it changed: -DSOURCE=... -DOUTPUT=...
execute_process(COMMAND git describe --always --dirty --abbrev=12 --exclude=* WORKING_DIRECTORY ${SOURCE}
                OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  set(revision "")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
// Generated.
#include "app/revision.h"
namespace isolux { const char* sourceRevision() { return "@revision@"; } }
]] @ONLY)

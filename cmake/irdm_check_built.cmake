# Before anything is installed: what is not built is named in one message, with the command that builds it.
function(irdm_check_built component)
  set(check "")
  foreach(target ${ARGN})
    string(APPEND check "if(NOT EXISTS \"$<TARGET_FILE:${target}>\")\n  list(APPEND irdm_missing ${target})\nendif()\n")
  endforeach()
  install(CODE "set(irdm_missing)\n${check}if(irdm_missing)
  list(JOIN irdm_missing \", \" irdm_missing)
  message(FATAL_ERROR \"irdm: not built: \${irdm_missing}; build everything first: cmake --build ${PROJECT_BINARY_DIR}\")
endif()" COMPONENT ${component})
endfunction()

irdm_check_built(runtime irdm-precompute irdm-server irdm-bridge irdm-replay)
irdm_check_built(development irdm_common irdm_simulation irdm_scene irdm_trace irdm_c)

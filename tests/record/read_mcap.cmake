# Records the same run in both formats and lets read_mcap.py compare them.
if(NOT EXISTS ${PYTHON})
  set(PYTHON python3)
endif()
foreach(format csv mcap)
  execute_process(COMMAND ${TEGOTAE} run ${SCENE} --fast --seconds 4 --record ${OUT}/run.${format} OUTPUT_QUIET
                  COMMAND_ERROR_IS_FATAL ANY)
endforeach()
execute_process(COMMAND ${PYTHON} ${CHECK} ${OUT}/run.mcap ${OUT}/run.csv RESULT_VARIABLE result)
if(NOT result EQUAL 0 AND NOT result EQUAL 77)
  message(FATAL_ERROR "read_mcap.py: ${result}")
endif()

# Ten seconds of fuzz_reader, from seeds of its own and small real series where they are:
#   cmake -D fuzzer=FUZZ_READER -D testdata=PALPATE_TESTDATA -D shared=SHARED_SERIES -D folder=TO_MAKE_ANEW -P TestFuzz.cmake
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder}/found)
execute_process(COMMAND ${testdata} phantom sphere --size 12,10,3 -o ${folder}/phantom OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${testdata} flow --size 10,10,2 --times 1 -o ${folder}/flow OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(GLOB seeds LIST_DIRECTORIES true ${shared}/mr_tx_* ${shared}/mr_dwi_mosaic_3 ${folder}/flow/*)
execute_process(
  COMMAND ${fuzzer} -seed=1 -max_total_time=10 -max_len=200000 -timeout=60 -rss_limit_mb=2000 -malloc_limit_mb=5000 -print_final_stats=1
    -verbosity=0 -artifact_prefix=${folder}/ ${folder}/found ${folder}/phantom ${seeds}
  COMMAND_ERROR_IS_FATAL ANY)

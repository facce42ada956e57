# Builds the contact library alone, installs it into an empty prefix, and builds and runs a host code on it.
# With MPIEXEC the exchange library too, and its host on three processes.
#   cmake -D SOURCE=... -D WORK=... -D GENERATOR=... -D COMPILER=... [-D LAUNCHER=...] [-D MPIEXEC=...]
#         -P package_test.cmake
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${result}): ${command}")
  endif()
endfunction()

set(options -G ${GENERATOR} -D CMAKE_BUILD_TYPE=Release -D CMAKE_CXX_COMPILER=${COMPILER}
            -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})
file(REMOVE_RECURSE ${WORK}/prefix ${WORK}/consumer ${WORK}/host)

run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/core ${options} -D AMONTONS_CORE_ONLY=ON -D AMONTONS_TESTS=OFF
    -D AMONTONS_EXCHANGE=OFF)
run(${CMAKE_COMMAND} --build ${WORK}/core -j 2)
run(${CMAKE_COMMAND} --install ${WORK}/core --prefix ${WORK}/prefix)
# Headers of the core only, so that nothing else can slip into the interface unseen.
foreach(room bulk algebra solution parallel exchange input output)
  if(EXISTS ${WORK}/prefix/include/amontons/${room})
    message(FATAL_ERROR "the core's package installs headers of ${room}")
  endif()
endforeach()

run(${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer -B ${WORK}/consumer ${options} -D CMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/consumer)
run(${WORK}/consumer/consumer)

if(MPIEXEC)
  run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/core ${options} -D AMONTONS_EXCHANGE=ON)
  run(${CMAKE_COMMAND} --build ${WORK}/core -j 2)
  run(${CMAKE_COMMAND} --install ${WORK}/core --prefix ${WORK}/prefix)
  run(${CMAKE_COMMAND} -S ${SOURCE}/examples/host-exchange -B ${WORK}/host ${options} -D CMAKE_PREFIX_PATH=${WORK}/prefix)
  run(${CMAKE_COMMAND} --build ${WORK}/host)
  run(${MPIEXEC} --oversubscribe -n 3 ${WORK}/host/host)
endif()

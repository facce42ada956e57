# To be sourced: what every run of the program and of its tests should find set.
export OMP_NUM_THREADS=1                      # one thread per process: processes are how it runs in parallel
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
cd "$(dirname "${BASH_SOURCE[0]}")/.."        # the root of the repository

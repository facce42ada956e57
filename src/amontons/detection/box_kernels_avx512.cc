#define AMONTONS_INSTRUCTION_SET avx512
#include "amontons/detection/box_kernels.inc"

#define AMONTONS_INSTRUCTION_SET avx2
#include "amontons/detection/box_kernels.inc"

#define AMONTONS_INSTRUCTION_SET baseline
#include "amontons/detection/box_kernels.inc"

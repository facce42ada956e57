#define AMONTONS_INSTRUCTION_SET avx2
#include "amontons/surface/face_batch_kernel.inc"

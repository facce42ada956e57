#define AMONTONS_INSTRUCTION_SET avx512
#include "amontons/surface/face_batch_kernel.inc"
